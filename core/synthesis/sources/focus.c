#include "synthesis/sources/focus.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"

/* Blur is told by how much weaker the steps from pixel to pixel are at the finest level than at
 * one this much coarser: at an edge in focus they are as high, whatever its contrast. By the mean
 * of their fourth powers, for edges lie farther apart in a finer level's pixels. That of sharp
 * edges some px apart is an eighth to half an octave less. */
#define COARSER 2
#define SHARP_OCTAVES -.5f
/* So much blurred and more is the same: coarser levels would have to tell. */
#define MOST_OCTAVES 1.5f
/* Steps of so much of white are grain and rounding, which have no focus. Of floats that mean less
 * light than white's little is told, and all is taken as sharp. */
#define GRAIN (1.5f / 255)
/* Cells are seen so many to each side, weighted by a Gaussian. */
#define AROUND 4
#define SIGMA 2.f
/* What sees less than so many cells' pixels says nothing. */
#define LEAST_SEEN 1.
/* Over-relaxation: holes of 60 cells across are even after so many sweeps. */
#define SWEEPS 100
#define RELAXATION 1.85f
/* Depth of field differs where the sources' blur does by so much, but for so many of 100 at either
 * end: photos focussed on a part of the plane .85 to 1.3; others, and planes drawn at any slant, up
 * to .55, for not every texture has edges. */
#define LEAST_DIFFERENCE .7f
#define PERCENTILE 2

/* Sums of the fourth powers of steps, and how many steps, at two levels. */
typedef struct steps {
  double fine, coarse, fine_count, coarse_count;
} steps;

typedef struct survey {
  const rc_image *images;
  const rc_mask *flags, *cells;
  int exponent;
  rc_box box; /* of the cells that tell anything */
  float weight[AROUND + 1];
  steps *own;
  float *blur;
} survey;

/* Both steps from (x, y), to the right and down, as one. */
static void add_step(const rc_image *image, const rc_mask *flags, int x, int y, double *sum,
                     double *count) {
  if (x + 1 >= image->width || y + 1 >= image->height ||
      !(*rc_flag(flags, x, y) & *rc_flag(flags, x + 1, y) & *rc_flag(flags, x, y + 1) & RC_KNOWN))
    return;
  float here = rc_brightness_at(image, x, y);
  float right = rc_brightness_at(image, x + 1, y) - here;
  float down = rc_brightness_at(image, x, y + 1) - here, square = right * right + down * down;
  *sum += (double)square * square, *count += 1;
}

static void sum_row(void *user, int item, int thread) {
  const survey *s = user;
  int row = s->box.y0 + item;
  (void)thread;
  for (int n = 0; n <= COARSER; n += COARSER) {
    const rc_image *image = &s->images[n];
    int shift = s->exponent - n, end_y = (row + 1) << shift, end_x = s->box.x1 << shift;
    for (int y = row << shift; y < end_y && y < image->height; y++)
      for (int x = s->box.x0 << shift; x < end_x && x < image->width; x++) {
        steps *own = &s->own[row * s->cells->width + (x >> shift)];
        add_step(image, &s->flags[n], x, y, n ? &own->coarse : &own->fine,
                 n ? &own->coarse_count : &own->fine_count);
      }
  }
}

static float blur_of(const steps *seen) {
  double grain = (double)(GRAIN * GRAIN) * (double)(GRAIN * GRAIN);
  double fine = seen->fine / seen->fine_count + grain;
  double coarse = seen->coarse / seen->coarse_count + grain;
  float octaves = .25f * rc_log2((float)(coarse / fine)) + SHARP_OCTAVES;
  return fminf(fmaxf(octaves, 0.f), MOST_OCTAVES);
}

/* Of sources: what is blurred elsewhere matters to nobody. */
static void pool_row(void *user, int item, int thread) {
  const survey *s = user;
  int row = s->box.y0 + item, width = s->cells->width;
  double full = ldexp(1, 2 * (s->exponent - COARSER));
  (void)thread;
  for (int column = s->box.x0; column < s->box.x1; column++) {
    steps seen = {0, 0, 0, 0};
    if (!(*rc_flag(s->cells, column, row) & RC_SOURCE)) continue;
    for (int j = -AROUND; j <= AROUND; j++)
      for (int i = -AROUND; i <= AROUND; i++) {
        if (!rc_inside(width, s->cells->height, column + i, row + j)) continue;
        const steps *own = &s->own[(row + j) * width + column + i];
        double weight = (double)(s->weight[i < 0 ? -i : i] * s->weight[j < 0 ? -j : j]) / full;
        seen.fine += weight * own->fine, seen.fine_count += weight * own->fine_count;
        seen.coarse += weight * own->coarse, seen.coarse_count += weight * own->coarse_count;
      }
    if (seen.coarse_count > LEAST_SEEN && seen.fine_count > 0)
      s->blur[row * width + column] = blur_of(&seen);
  }
}

/* Of the cell's four neighbours; itself instead of those that are nothing to copy from or to. */
static float around(const survey *s, int x, int y) {
  static const int to_x[] = {-1, 1, 0, 0}, to_y[] = {0, 0, -1, 1};
  int width = s->cells->width;
  float sum = 0;
  for (int n = 0; n < 4; n++) {
    int i = x + to_x[n], j = y + to_y[n];
    bool counts = rc_inside(width, s->cells->height, i, j) && *rc_flag(s->cells, i, j);
    sum += s->blur[counts ? j * width + i : y * width + x];
  }
  return sum / 4;
}

/* Evenly between what lies around it. */
static recede_status fill_target(rc_context *context, const survey *s) {
  rc_box box = rc_box_of(s->cells, RC_TARGET);
  rc_box beside = rc_box_grown(box, 1, s->cells->width, s->cells->height);
  double sum = 0, count = 0;
  for (int y = beside.y0; y < beside.y1; y++)
    for (int x = beside.x0; x < beside.x1; x++) {
      uint8_t cell = *rc_flag(s->cells, x, y);
      if (cell & RC_SOURCE && !(cell & RC_TARGET)) sum += s->blur[y * s->cells->width + x], count++;
    }
  for (int n = -1; n < SWEEPS; n++) {
    for (int y = box.y0; y < box.y1; y++)
      for (int x = box.x0; x < box.x1; x++) {
        float *here = &s->blur[y * s->cells->width + x];
        if (!(*rc_flag(s->cells, x, y) & RC_TARGET)) continue;
        if (n < 0)
          *here = count > 0 ? (float)(sum / count) : 0.f;
        else
          *here += RELAXATION * (around(s, x, y) - *here);
      }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

static recede_status blurs_differ(rc_context *context, const survey *s, bool *differs) {
  size_t count = 0, cells = (size_t)s->cells->width * (size_t)s->cells->height;
  float *found;
  RC_TRY(RC_NEW(context, cells, &found));
  for (size_t i = 0; i < cells; i++)
    if (s->cells->data[i] & RC_SOURCE && !(s->cells->data[i] & RC_TARGET))
      found[count++] = s->blur[i];
  qsort(found, count, sizeof *found, rc_by_value);
  *differs =
      count && found[count - 1 - count * PERCENTILE / 100] - found[count * PERCENTILE / 100] >=
                   LEAST_DIFFERENCE;
  RC_FREE(context, &found);
  return rc_poll(context);
}

recede_status rc_focus_measure(rc_context *context, const rc_image *images, const rc_mask *flags,
                               int levels, const rc_mask *cells, int exponent, float *blur,
                               bool *differs) {
  survey s = {images, flags, cells, exponent, {0, 0, 0, 0}, {0}, NULL, blur};
  size_t count = (size_t)cells->width * (size_t)cells->height;
  *differs = false;
  for (size_t i = 0; i < count; i++) blur[i] = 0;
  if (levels <= COARSER) return RECEDE_OK;
  s.box =
      rc_box_grown(rc_box_of(cells, RC_SOURCE | RC_TARGET), AROUND, cells->width, cells->height);
  for (int i = 0; i <= AROUND; i++) s.weight[i] = rc_exp(-.5f / (SIGMA * SIGMA) * (float)(i * i));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, count, &s.own));
  RC_TRY(rc_parallel(context, s.box.y1 - s.box.y0, sum_row, &s));
  RC_TRY(rc_parallel(context, s.box.y1 - s.box.y0, pool_row, &s));
  RC_TRY(fill_target(context, &s));
  RC_TRY(blurs_differ(context, &s, differs));
  rc_release(context, mark);
  return RECEDE_OK;
}
