#include "synthesis/paper/update.h"

#include <math.h>

#include "base/parallel.h"
#include "base/real.h"

double rc_energy_weights(const rc_paper_settings *settings, float least_distance,
                         rc_matches *matches) {
  double energy = 0;
  size_t count = (size_t)matches->grid.columns * (size_t)matches->grid.rows;
  float half = (float)(settings->exponent / 2);
  for (size_t i = 0; i < count; i++) {
    matches->weight[i] = 0;
    if (!matches->active[i] || matches->corner[i].x < 0) continue;
    float square = matches->distance[i];
    float log_square = rc_log2(square > least_distance ? square : least_distance);
    matches->weight[i] = rc_exp2((half - 1) * log_square); /* eq. 7: ||x_p - z_p||^(r - 2) */
    energy += (double)(matches->weight[i] * square);       /* eq. 8 */
    matches->weight[i] *= 1 + (float)settings->border_trust * matches->known[i];
  }
  return energy;
}

typedef struct update {
  const rc_paper_settings *settings;
  const rc_matches *matches;
  const rc_histogram_weight *histogram;
  rc_paper_level *level;
} update;

typedef struct span {
  int first, end;
} span;

/* The lines of the grid whose windows wholly hold the pixels from..to (the patch's, Figure 6). The
 * last line does not keep the step, so it is looked at apart. */
static span holding(int from, int to, const rc_grid *grid, int lines, int last) {
  int low = to - grid->width + 1;
  span s = {low > 0 ? (low + grid->step - 1) / grid->step : 0, from / grid->step + 1};
  if (s.end > lines - 1) s.end = lines - 1;
  if (last <= from && last + grid->width > to) {
    if (s.first > lines - 1 || s.first >= s.end) s.first = lines - 1;
    s.end = lines;
  }
  return s;
}

/* The minimum of eq. 8 in one pixel: the mean of what the windows say, weighted by eqs 7 and 9. */
static void update_pixel(const update *u, span columns, span rows, int x, int y) {
  const rc_matches *m = u->matches;
  const rc_image *exemplar = &u->level->exemplar.image;
  int colours = u->level->colours;
  float sum[3] = {0, 0, 0}, total = 0;
  for (int row = rows.first; row < rows.end; row++)
    for (int column = columns.first; column < columns.end; column++) {
      size_t i = (size_t)row * (size_t)m->grid.columns + (size_t)column;
      float weight = m->weight[i];
      if (!(weight > 0)) continue;
      const float *z = rc_pixel(exemplar, m->corner[i].x + x - rc_grid_x(&m->grid, column),
                                m->corner[i].y + y - rc_grid_y(&m->grid, row));
      if (u->histogram->on) weight *= rc_histogram_of(u->histogram, z, colours);
      for (int k = 0; k < colours; k++) sum[k] += weight * z[k];
      total += weight;
    }
  if (!(total > 0)) return;
  float *pixel = rc_pixel(&u->level->output.image, x, y);
  for (int k = 0; k < colours; k++) pixel[k] = sum[k] / total;
}

static span patch_of(int index, int patch, int size) {
  int from = index * patch - (patch - 1), to = from + patch;
  return (span){from > 0 ? from : 0, to < size ? to : size};
}

/* Patches lie between the grid's lines (from its pixel 1 on), so that an 8 x 8 neighbourhood's grid
 * has 9 windows that wholly hold a 2 x 2 patch, as in the paper's Figure 6. */
static void update_patches(void *user, int index, int thread) {
  const update *u = user;
  const rc_side *output = &u->level->output;
  const rc_grid *grid = &u->matches->grid;
  int patch = u->settings->patch <= grid->width / 4 ? u->settings->patch : 1;
  int width = output->image.width, height = output->image.height;
  span rows = patch_of(index, patch, height);
  (void)thread;
  if (rows.first >= rows.end) return;
  span windows_y = holding(rows.first, rows.end - 1, grid, grid->rows, grid->last_y);
  for (int i = 0; patch_of(i, patch, width).first < width; i++) {
    span columns = patch_of(i, patch, width);
    span windows_x = holding(columns.first, columns.end - 1, grid, grid->columns, grid->last_x);
    for (int y = rows.first; y < rows.end; y++)
      for (int x = columns.first; x < columns.end; x++)
        if (rc_unknown(output, x, y)) update_pixel(u, windows_x, windows_y, x, y);
  }
}

recede_status rc_paper_update(rc_context *context, const rc_paper_settings *settings,
                              const rc_matches *matches, const rc_histogram_weight *histogram,
                              rc_paper_level *level) {
  update u = {settings, matches, histogram, level};
  return rc_parallel(context, level->output.image.height + 1, update_patches, &u);
}
