#include "synthesis/paper/search.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

/* Price of another scale: an octave costs this part of the exemplar's variance per value. */
#define SCALE_PRICE 2.f
/* Floor of ||x_p - z_p||^2 per value in eq. 7, in parts of the variance: exact copies of the
 * exemplar must not weigh infinitely more than all others. */
#define LEAST_DISTANCE 1e-3f
/* With coherence, the tree's answer must be that much nearer than the match so far and the
 * neighbours': whole pieces of the exemplar look better than the nearest of averages. */
#define TREE_MUST_BEAT .9f

/* Mean variance of the exemplar's channels, S not included. */
static double variance(const rc_paper_level *level) {
  const rc_side *side = &level->exemplar;
  double sum[3] = {0}, square[3] = {0}, count = 0, all = 0;
  for (int y = 0; y < side->image.height; y++)
    for (int x = 0; x < side->image.width; x++) {
      if (!(*rc_flag(&side->flags, x, y) & RC_SOURCE)) continue;
      const float *pixel = rc_pixel(&side->image, x, y);
      for (int k = 0; k < level->colours; k++) {
        sum[k] += (double)pixel[k];
        square[k] += (double)pixel[k] * (double)pixel[k];
      }
      count++;
    }
  for (int k = 0; k < level->colours && count > 0; k++)
    all += square[k] / count - sum[k] / count * (sum[k] / count);
  return all > 1e-12 ? all / level->colours : 1e-12;
}

static const float *read_vector(const void *user, int index, float *scratch) {
  const rc_paper_search *search = user;
  if (search->vectors) return search->vectors + (size_t)index * (size_t)search->space.dims;
  rc_space_gather(&search->space, &search->level->exemplar.image, search->members[index], scratch);
  return scratch;
}

static void describe_chunk(void *user, int chunk, int thread) {
  rc_paper_search *search = user;
  float *scratch = search->scratch + (size_t)thread * search->scratch_size;
  for (int i = chunk * 64; i < chunk * 64 + 64 && i < search->tree.points.count; i++)
    rc_space_describe(&search->space, &search->level->exemplar, search->members[i], scratch,
                      search->vectors + (size_t)i * (size_t)search->space.dims);
}

static recede_status build_tree(rc_context *context, rc_paper_search *search, uint64_t key) {
  const rc_paper_settings *settings = search->settings;
  int count;
  RC_TRY(rc_windows_sample(context, &search->windows,
                           settings->pca ? RC_MOST_MEMBERS : RC_MOST_RAW_MEMBERS, key + 1,
                           &search->members, &count));
  rc_points points = {search, read_vector, count, search->space.dims};
  search->tree.points = points;
  if (settings->pca) {
    RC_TRY(RC_NEW(context, (size_t)count * (size_t)search->space.dims, &search->vectors));
    RC_TRY(rc_parallel(context, (count + 63) / 64, describe_chunk, search));
  }
  int stop = (int)(settings->tree_stop * count);
  if (stop < settings->tree_leaf) stop = settings->tree_leaf;
  return rc_tree_build(context, &points, stop, key + 2, &search->tree);
}

recede_status rc_paper_search_prepare(rc_context *context, const rc_paper_settings *settings,
                                      const rc_paper_level *level, int width, uint64_t key,
                                      rc_paper_search *search) {
  const rc_image *image = &level->exemplar.image;
  *search = (rc_paper_search){.settings = settings, .level = level};
  RC_TRY(rc_windows_find(context, image, &level->exemplar.flags, width, &search->windows));
  if (!search->windows.count) return RECEDE_OK;
  double values = (double)width * width * level->colours, of_variance = variance(level) * values;
  search->least_distance = (float)(LEAST_DISTANCE * of_variance);
  rc_space_raw(&search->space, width, image->channels);
  if (settings->scale_apart)
    search->space.scale_gain = (float)sqrt((double)SCALE_PRICE * of_variance);
  if (settings->pca) RC_TRY(rc_space_reduce(context, &search->windows, key, &search->space));
  search->scratch_size = (size_t)(search->space.stride + 2 * search->space.dims);
  RC_TRY(RC_NEW(context, search->scratch_size * (size_t)context->threads, &search->scratch));
  return build_tree(context, search, key);
}

/* ------------------------------------------------------------------------- one neighbourhood -- */

typedef struct seeker {
  const rc_paper_search *search;
  rc_corner at;    /* x_p */
  float log_scale; /* its log2 S */
  rc_corner best;  /* z_p */
  float distance;
} seeker;

/* ||x_p - z_p||^2, with S apart as one more number. */
static float distance_to(const seeker *s, rc_corner z, float limit) {
  const rc_paper_search *search = s->search;
  float gain = search->space.scale_gain, price = 0;
  if (gain > 0) {
    float step =
        gain * (rc_window_log_scale(&search->level->exemplar.scale, z, search->space.width) -
                s->log_scale);
    price = step * step;
    if (price > limit) return price;
  }
  return price + rc_window_distance(&search->level->output.image, s->at,
                                    &search->level->exemplar.image, z, search->space.width,
                                    limit - price);
}

static void try_match(seeker *s, rc_corner z, float must_beat) {
  if (!rc_window_valid(&s->search->windows, z.x, z.y)) return;
  if (z.x == s->best.x && z.y == s->best.y) return;
  float limit = s->distance * must_beat, distance = distance_to(s, z, limit);
  if (distance < limit) s->distance = distance, s->best = z;
}

static void try_neighbours(seeker *s, const rc_matches *matches, int column, int row) {
  static const int8_t beside[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};
  const rc_grid *grid = &matches->grid;
  for (int i = 0; i < 4; i++) {
    int c = column + beside[i][0], r = row + beside[i][1];
    if (!rc_inside(grid->columns, grid->rows, c, r)) continue;
    rc_corner z = s->search->snapshot[(size_t)r * (size_t)grid->columns + (size_t)c];
    if (z.x < 0) continue;
    z.x += s->at.x - rc_grid_x(grid, c);
    z.y += s->at.y - rc_grid_y(grid, r);
    try_match(s, z, 1);
  }
}

static void ask_tree(seeker *s, float *scratch) {
  const rc_paper_search *search = s->search;
  float *vector = scratch + search->space.stride, *member = vector + search->space.dims, unused;
  rc_space_describe(&search->space, &search->level->output, s->at, scratch, vector);
  int found = rc_tree_search(&search->tree, vector, member, &unused);
  bool must = search->settings->coherence && s->best.x >= 0;
  try_match(s, search->members[found], must ? TREE_MUST_BEAT : 1);
}

static seeker seeker_at(const rc_paper_search *search, const rc_matches *matches, int column,
                        int row) {
  size_t i = (size_t)row * (size_t)matches->grid.columns + (size_t)column;
  seeker s = {.search = search,
              .at = {rc_grid_x(&matches->grid, column), rc_grid_y(&matches->grid, row)},
              .best = matches->corner[i],
              .distance = FLT_MAX};
  if (search->space.scale_gain > 0)
    s.log_scale = rc_window_log_scale(&search->level->output.scale, s.at, search->space.width);
  if (s.best.x >= 0) s.distance = distance_to(&s, s.best, FLT_MAX);
  return s;
}

typedef struct sweep {
  rc_paper_search *search;
  rc_matches *matches;
  int *changed; /* one a row; NULL: measure only */
} sweep;

static void sweep_row(void *user, int row, int thread) {
  const sweep *w = user;
  rc_matches *matches = w->matches;
  float *scratch = w->search->scratch + (size_t)thread * w->search->scratch_size;
  for (int column = 0; column < matches->grid.columns; column++) {
    size_t i = (size_t)row * (size_t)matches->grid.columns + (size_t)column;
    if (!matches->active[i]) continue;
    seeker s = seeker_at(w->search, matches, column, row);
    if (w->changed) {
      rc_corner before = s.best;
      if (w->search->settings->coherence) try_neighbours(&s, matches, column, row);
      ask_tree(&s, scratch);
      w->changed[row] += s.best.x != before.x || s.best.y != before.y;
    }
    matches->corner[i] = s.best;
    matches->distance[i] = s.distance;
  }
}

recede_status rc_paper_search_measure(rc_context *context, rc_paper_search *search,
                                      rc_matches *matches) {
  sweep w = {search, matches, NULL};
  return rc_parallel(context, matches->grid.rows, sweep_row, &w);
}

recede_status rc_paper_search_run(rc_context *context, rc_paper_search *search, rc_matches *matches,
                                  int *changed) {
  size_t count = (size_t)matches->grid.columns * (size_t)matches->grid.rows;
  sweep w = {search, matches, NULL};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, matches->grid.rows, &w.changed));
  RC_TRY(RC_NEW(context, count, &search->snapshot));
  memcpy(search->snapshot, matches->corner, count * sizeof *search->snapshot);
  RC_TRY(rc_parallel(context, matches->grid.rows, sweep_row, &w));
  *changed = 0;
  for (int row = 0; row < matches->grid.rows; row++) *changed += w.changed[row];
  rc_release(context, mark);
  return RECEDE_OK;
}
