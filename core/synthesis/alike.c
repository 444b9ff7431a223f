#include "synthesis/alike.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "kernels/kernels.h"
#include "synthesis/looks.h"

/* A pixel's looks are those of the square around it: half a hole wide, unless the hole is thin. */
#define HALF_PX 4
/* What is beside the hole: so far from it, and every n-th pixel of that. */
#define BESIDE_PX 9
#define LEAST_SAMPLES 32
#define MOST_SAMPLES 512
/* Unlike: its distance to every sample is more than twice what the samples have, 90 of 100, to the
 * nearest other that shares no pixel with them; and more than this part of the sources' deviation.
 * Textures that fill the picture reach .25, roofs and a wall between them .5. */
#define TIMES_OWN 2.
#define OWN_PERCENTILE 90
#define LEAST_UNLIKE .3
/* Of larger levels only every n-th pixel is compared: thin holes have no coarse one. */
#define MOST_COMPARED (1 << 16)

typedef struct comparison {
  const rc_image *image;
  const rc_mask *flags;
  int width, height;
  rc_looks *sample;
  int32_t *sample_at; /* pixels */
  int sample_count;
  float most;        /* square of the distance from which on looks are unlike */
  int step;          /* px of the level from one that is compared to the next */
  int columns, rows; /* how many are */
  uint8_t *unlike;   /* columns * rows */
} comparison;

static bool look_at(const comparison *c, int x, int y, rc_looks *out) {
  return rc_look(c->image, c->flags, x, y, HALF_PX, out);
}

static float distance_of(const rc_looks *p, const rc_looks *q) {
  float sum = 0;
  for (int k = 0; k < RC_LOOKS; k++)
    sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
  return sum;
}

/* Marks sources beside the hole. */
static recede_status mark_beside(rc_context *context, const comparison *c, uint8_t *beside) {
  size_t pixels = (size_t)c->width * (size_t)c->height;
  uint8_t *outside;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &outside));
  for (size_t i = 0; i < pixels; i++) outside[i] = !(c->flags->data[i] & RC_TARGET);
  rc_distance_inside(outside, 1, c->width, c->height, false, beside);
  for (size_t i = 0; i < pixels; i++)
    beside[i] = beside[i] && beside[i] <= BESIDE_PX && c->flags->data[i] & RC_SOURCE;
  rc_release(context, mark);
  return RECEDE_OK;
}

static void take_samples(comparison *c, const uint8_t *beside) {
  size_t pixels = (size_t)c->width * (size_t)c->height;
  int found = 0;
  for (size_t i = 0; i < pixels; i++) found += beside[i];
  int step = found / MOST_SAMPLES + 1;
  found = 0;
  for (size_t i = 0; i < pixels; i++) {
    int x = (int)(i % (size_t)c->width), y = (int)(i / (size_t)c->width);
    if (!beside[i] || found++ % step || !look_at(c, x, y, &c->sample[c->sample_count])) continue;
    c->sample_at[c->sample_count++] = (int32_t)i;
  }
}

static int by_value(const void *a, const void *b) {
  float p = *(const float *)a, q = *(const float *)b;
  return (p > q) - (p < q);
}

/* How much samples differ from those that share none of their pixels: the percentile of the
 * squares. Infinite where there are no such. */
static float own_spread(const comparison *c, float *nearest) {
  int width = c->width, count = 0;
  for (int i = 0; i < c->sample_count; i++) {
    float least = INFINITY;
    for (int k = 0; k < c->sample_count; k++) {
      int dx = c->sample_at[i] % width - c->sample_at[k] % width;
      int dy = c->sample_at[i] / width - c->sample_at[k] / width;
      if (abs(dx) <= 2 * HALF_PX && abs(dy) <= 2 * HALF_PX) continue;
      least = fminf(least, distance_of(&c->sample[i], &c->sample[k]));
    }
    if (isfinite(least)) nearest[count++] = least;
  }
  if (count < LEAST_SAMPLES) return INFINITY;
  qsort(nearest, (size_t)count, sizeof *nearest, by_value);
  return nearest[count * OWN_PERCENTILE / 100];
}

/* The sources' variance, mean over the channels. */
static double variance_of(const comparison *c) {
  double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0}, count = 0, total = 0;
  int channels = c->image->channels;
  for (int y = 0; y < c->height; y++)
    for (int x = 0; x < c->width; x++) {
      if (!(*rc_flag(c->flags, x, y) & RC_SOURCE)) continue;
      const float *v = rc_pixel(c->image, x, y);
      for (int k = 0; k < channels; k++) sum[k] += v[k], square[k] += (double)v[k] * v[k];
      count++;
    }
  for (int k = 0; k < channels && count > 0; k++)
    total += square[k] / count - sum[k] / count * (sum[k] / count);
  return fmax(total, 0) / channels;
}

static void compare_row(void *user, int row, int thread) {
  const comparison *c = user;
  (void)thread;
  for (int column = 0; column < c->columns; column++) {
    int x = column * c->step + c->step / 2, y = row * c->step + c->step / 2, i = 0;
    uint8_t *unlike = c->unlike + (size_t)row * (size_t)c->columns + (size_t)column;
    rc_looks here;
    *unlike = 0;
    if (x >= c->width) x = c->width - 1;
    if (y >= c->height) y = c->height - 1;
    if (!(*rc_flag(c->flags, x, y) & RC_KNOWN) || !look_at(c, x, y, &here)) continue;
    while (i < c->sample_count && distance_of(&here, &c->sample[i]) > c->most) i++;
    *unlike = i == c->sample_count;
  }
}

static bool is_unlike(const comparison *c, int x, int y) {
  return c->unlike[(size_t)(y / c->step) * (size_t)c->columns + (size_t)(x / c->step)];
}

/* Sources of the hole's own scales that have room for a patch; all: also those that are unlike. */
static recede_status count_places(rc_context *context, const comparison *c, const rc_band *band,
                                  bool all, uint64_t *places) {
  size_t pixels = (size_t)c->width * (size_t)c->height;
  uint8_t *left, *room;
  rc_block *mark = rc_mark(context);
  *places = 0;
  RC_TRY(RC_NEW(context, pixels, &left));
  RC_TRY(RC_NEW(context, pixels, &room));
  for (size_t i = 0; i < pixels; i++) {
    int x = (int)(i % (size_t)c->width), y = (int)(i / (size_t)c->width);
    left[i] = c->flags->data[i] & RC_SOURCE && (all || !is_unlike(c, x, y));
  }
  rc_distance_inside(left, 1, c->width, c->height, true, room);
  for (size_t i = 0; i < pixels; i++)
    *places += room[i] > RC_PATCH_RADIUS + 1 &&
               rc_band_holds(band, (double)(i % (size_t)c->width), (double)(i / (size_t)c->width));
  rc_release(context, mark);
  return rc_poll(context);
}

/* As many as the hole has pixels, or half of what there is: a hole as wide as its texture never has
 * many. */
static recede_status enough_left(rc_context *context, const comparison *c, const rc_band *band,
                                 bool *enough) {
  uint64_t target = 0, before, after;
  for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++)
    target += c->flags->data[i] & RC_TARGET ? 1 : 0;
  RC_TRY(count_places(context, c, band, true, &before));
  RC_TRY(count_places(context, c, band, false, &after));
  *enough = after >= target || (before && 2 * after >= before);
  return RECEDE_OK;
}

/* One compared place stands for a square of pixels. */
static void take_source(const comparison *c, const rc_mask *flags, int shift) {
  int side = c->step << shift;
  for (int y = 0; y < flags->height; y++)
    for (int x0 = 0; x0 < flags->width; x0 += side) {
      if (!is_unlike(c, x0 >> shift, y >> shift)) continue;
      int x1 = x0 + side < flags->width ? x0 + side : flags->width;
      for (int x = x0; x < x1; x++) *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
    }
}

recede_status rc_keep_alike(rc_context *context, const rc_band *band, const rc_image *images,
                            const rc_mask *flags, int levels) {
  const rc_image *image = &images[levels - 1];
  rc_band here = *band;
  comparison c = {.image = image,
                  .flags = &flags[levels - 1],
                  .width = image->width,
                  .height = image->height,
                  .step = 1};
  size_t pixels = (size_t)c.width * (size_t)c.height;
  uint8_t *beside;
  float *nearest;
  bool enough;
  rc_block *mark = rc_mark(context);
  for (int i = 1; i < levels; i++) here.w = rc_line_halved(&here.w);
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample_at));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &nearest));
  RC_TRY(RC_NEW(context, pixels, &beside));
  RC_TRY(mark_beside(context, &c, beside));
  RC_TRY(rc_poll(context));
  take_samples(&c, beside);
  RC_TRY(rc_poll(context));
  double own = TIMES_OWN * TIMES_OWN * own_spread(&c, nearest);
  if (isfinite(own)) {
    c.most = (float)fmax(own, LEAST_UNLIKE * LEAST_UNLIKE * variance_of(&c));
    while (pixels / (size_t)(c.step * c.step) > MOST_COMPARED) c.step++;
    c.columns = (c.width + c.step - 1) / c.step, c.rows = (c.height + c.step - 1) / c.step;
    RC_TRY(RC_NEW(context, c.columns * c.rows, &c.unlike));
    RC_TRY(rc_parallel(context, c.rows, compare_row, &c));
    RC_TRY(enough_left(context, &c, &here, &enough));
    for (int exponent = enough ? levels - 1 : -1; exponent >= 0; exponent--)
      take_source(&c, &flags[exponent], levels - 1 - exponent);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
