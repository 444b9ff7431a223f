#include "synthesis/sources/places.h"

#include <math.h>

#include "base/memory.h"
#include "image/distance.h"
#include "kernels/kernels.h"

static recede_status measure_beside(rc_context *context, rc_places *p) {
  const rc_mask *flags = p->flags;
  size_t pixels = (size_t)flags->width * (size_t)flags->height;
  uint8_t *outside;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &outside));
  for (size_t i = 0; i < pixels; i++) outside[i] = !(flags->data[i] & RC_TARGET);
  rc_distance_inside(outside, 1, flags->width, flags->height, false, p->beside);
  for (size_t i = 0; i < pixels; i++)
    if (p->beside[i] > RC_BESIDE_PX || !(flags->data[i] & RC_SOURCE)) p->beside[i] = 0;
  rc_release(context, mark);
  return rc_poll(context);
}

recede_status rc_places_new(rc_context *context, const rc_image *images, const rc_mask *flags,
                            int levels, int most, rc_places *places) {
  const rc_mask *coarsest = &flags[levels - 1];
  size_t pixels = (size_t)coarsest->width * (size_t)coarsest->height;
  *places =
      (rc_places){.image = &images[levels - 1], .flags = coarsest, .levels = levels, .step = 1};
  while (pixels / (size_t)(places->step * places->step) > (size_t)most) places->step++;
  places->columns = (coarsest->width + places->step - 1) / places->step;
  places->rows = (coarsest->height + places->step - 1) / places->step;
  RC_TRY(RC_NEW_ZERO(context, places->columns * places->rows, &places->unlike));
  RC_TRY(RC_NEW(context, pixels, &places->beside));
  return measure_beside(context, places);
}

double rc_source_variance(const rc_image *image, const rc_mask *flags) {
  double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0}, count = 0, total = 0;
  int channels = image->channels;
  for (int y = 0; y < image->height; y++)
    for (int x = 0; x < image->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_SOURCE)) continue;
      const float *v = rc_pixel(image, x, y);
      for (int k = 0; k < channels; k++) sum[k] += v[k], square[k] += (double)v[k] * v[k];
      count++;
    }
  for (int k = 0; k < channels && count > 0; k++)
    total += square[k] / count - sum[k] / count * (sum[k] / count);
  return fmax(total, 0) / channels;
}

bool rc_look_at(const rc_places *places, int x, int y, rc_looks *looks) {
  return rc_look(places->image, places->flags, x, y, RC_LOOKS_PX, looks);
}

bool rc_look_at_place(const rc_places *p, int column, int row, rc_looks *looks) {
  int x = column * p->step + p->step / 2, y = row * p->step + p->step / 2;
  if (x >= p->flags->width) x = p->flags->width - 1;
  if (y >= p->flags->height) y = p->flags->height - 1;
  return *rc_flag(p->flags, x, y) & RC_KNOWN && rc_look_at(p, x, y, looks);
}

bool rc_is_beside(const rc_places *p, int column, int row) {
  int x0 = column * p->step, y0 = row * p->step;
  for (int y = y0; y < y0 + p->step && y < p->flags->height; y++)
    for (int x = x0; x < x0 + p->step && x < p->flags->width; x++)
      if (p->beside[(size_t)y * (size_t)p->flags->width + (size_t)x]) return true;
  return false;
}

void rc_places_mark_around(const rc_places *p, int column, int row) {
  for (int y = row - 1; y <= row + 1; y++)
    for (int x = column - 1; x <= column + 1; x++)
      if (rc_inside(p->columns, p->rows, x, y) && !p->unlike[y * p->columns + x])
        p->unlike[y * p->columns + x] = 1;
}

static int unlike_at(const rc_places *p, int x, int y) {
  return p->unlike[(size_t)(y / p->step) * (size_t)p->columns + (size_t)(x / p->step)];
}

/* Sources of the hole's own scales that have room for a patch and are no more unlike than most. */
static recede_status count_places(rc_context *context, const rc_places *p, const rc_band *band,
                                  int most, uint64_t *places) {
  size_t pixels = (size_t)p->flags->width * (size_t)p->flags->height;
  uint8_t *left, *room;
  rc_block *mark = rc_mark(context);
  *places = 0;
  RC_TRY(RC_NEW(context, pixels, &left));
  RC_TRY(RC_NEW(context, pixels, &room));
  for (size_t i = 0; i < pixels; i++) {
    int x = (int)(i % (size_t)p->flags->width), y = (int)(i / (size_t)p->flags->width);
    left[i] = p->flags->data[i] & RC_SOURCE && unlike_at(p, x, y) <= most;
  }
  rc_distance_inside(left, 1, p->flags->width, p->flags->height, true, room);
  for (size_t i = 0; i < pixels; i++)
    *places +=
        room[i] > RC_PATCH_RADIUS + 1 && rc_band_holds(band, (double)(i % (size_t)p->flags->width),
                                                       (double)(i / (size_t)p->flags->width));
  rc_release(context, mark);
  return rc_poll(context);
}

/* As many as this part of the hole's pixels, or half of what there is: a hole as wide as its
 * texture never has many. Grass beside an animal had .9, and got its hide; a dune's other slope .7,
 * and is needed. */
#define ENOUGH .8

/* How unlike places may at most be, the less the more are left. */
static recede_status most_unlike(rc_context *context, const rc_places *p, const rc_band *band,
                                 int *most) {
  uint64_t target = 0, before, after;
  int too_few = -1;
  for (size_t i = 0; i < (size_t)p->flags->width * (size_t)p->flags->height; i++)
    target += p->flags->data[i] & RC_TARGET ? 1 : 0;
  RC_TRY(count_places(context, p, band, UINT8_MAX, &before));
  *most = UINT8_MAX;
  /* Mostly all that is unlike may go: that is tried first. */
  for (int tried = 0; *most - too_few > 1; tried = (too_few + *most) / 2) {
    RC_TRY(count_places(context, p, band, tried, &after));
    if ((double)after >= ENOUGH * (double)target || (before && 2 * after >= before))
      *most = tried;
    else
      too_few = tried;
  }
  return RECEDE_OK;
}

/* One place stands for a square of pixels. The part of the sources that is taken. */
static double take_source(const rc_places *p, int most, const rc_mask *flags, int shift) {
  int side = p->step << shift;
  double all = 0, taken = 0;
  for (int y = 0; y < flags->height; y++)
    for (int x0 = 0; x0 < flags->width; x0 += side) {
      bool unlike = unlike_at(p, x0 >> shift, y >> shift) > most;
      int x1 = x0 + side < flags->width ? x0 + side : flags->width;
      for (int x = x0; x < x1; x++) {
        uint8_t *flag = rc_flag(flags, x, y);
        if (!(*flag & RC_SOURCE)) continue;
        all++, taken += unlike;
        if (unlike) *flag &= (uint8_t)~RC_SOURCE;
      }
    }
  return all > 0 ? taken / all : 0;
}

recede_status rc_places_take(rc_context *context, const rc_places *places, const rc_band *band,
                             const rc_mask *flags, double *taken) {
  rc_band here = *band;
  int most;
  *taken = 0;
  for (int i = 1; i < places->levels; i++) here.w = rc_line_halved(&here.w);
  RC_TRY(most_unlike(context, places, &here, &most));
  for (int exponent = places->levels - 1; exponent >= 0; exponent--)
    *taken = take_source(places, most, &flags[exponent], places->levels - 1 - exponent);
  return RECEDE_OK;
}
