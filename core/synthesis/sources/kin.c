#include "synthesis/sources/kin.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"
#include "image/distance.h"
#include "synthesis/sources/places.h"

/* What is beside the hole, so near to it as RC_TOUCHING_PX, is every n-th pixel of that; of fewer
 * than the least nothing is told. */
#define LEAST_SAMPLES 32
#define MOST_SAMPLES 256
#define PARTS 32
/* The square that is looked at: a hen's head is 3 px at the coarsest level. */
#define HALF_PX 1
/* Near a target pixel is what lies as far away as the border of the hole, and this. */
#define MARGIN_PX 9
/* Looks are alike up to so many times what samples differ by from the most similar other at most so
 * far away, that shares no pixel with them, 90 of 100; or up to this part of the sources'
 * deviation. Pebbles of many colours differ by .4 of it, grass by .1. */
#define TIMES_OWN 1.5f
#define OWN_PERCENTILE 90
#define OWN_PX 12
#define LEAST_UNLIKE .4f
/* There are several things where no more than this part of all pairs of a source and a target pixel
 * are kin: one texture has .75 to 1, hens, paths and walls .45 to .71. */
#define MOST_KIN .72
/* Of so many sources and target pixels each, at the most. */
#define MOST_EACH 1024

typedef struct sample {
  int x, y;
  rc_looks looks;
  rc_kin part;
} sample;

typedef struct finder {
  const rc_image *image;
  const rc_mask *flags;
  uint8_t *from_hole, *depth; /* px; of the hole's pixels the other way round */
  sample *samples;
  int count;
  float most; /* square of the distance up to which looks are alike */
  rc_kin *kin;
} finder;

static int64_t square_px(const sample *p, int x, int y) {
  int64_t dx = p->x - x, dy = p->y - y;
  return dx * dx + dy * dy;
}

static recede_status measure_distances(rc_context *context, finder *f) {
  int width = f->flags->width, height = f->flags->height;
  size_t pixels = (size_t)width * (size_t)height;
  uint8_t *outside;
  RC_TRY(RC_NEW(context, pixels, &f->from_hole));
  RC_TRY(RC_NEW(context, pixels, &f->depth));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &outside));
  for (size_t i = 0; i < pixels; i++) outside[i] = !(f->flags->data[i] & RC_TARGET);
  rc_distance_inside(outside, 1, width, height, false, f->from_hole);
  rc_distance_inside(f->flags->data, RC_TARGET, width, height, false, f->depth);
  rc_release(context, mark);
  return rc_poll(context);
}

static bool is_beside(const finder *f, size_t at) {
  return f->flags->data[at] & RC_SOURCE && f->from_hole[at] && f->from_hole[at] <= RC_TOUCHING_PX;
}

static void take_samples(finder *f) {
  int width = f->flags->width, found = 0;
  size_t pixels = (size_t)width * (size_t)f->flags->height;
  for (size_t i = 0; i < pixels; i++) found += is_beside(f, i);
  int step = found / MOST_SAMPLES + 1;
  found = 0;
  for (size_t i = 0; i < pixels; i++) {
    if (!is_beside(f, i) || found++ % step) continue;
    sample *s = &f->samples[f->count];
    *s = (sample){.x = (int)(i % (size_t)width), .y = (int)(i / (size_t)width)};
    f->count += rc_look(f->image, f->flags, s->x, s->y, HALF_PX, &s->looks);
  }
}

/* Each part has a sample far from all others' for its middle, and what is nearest to that. */
static void divide(const finder *f) {
  int64_t nearest[MOST_SAMPLES];
  int middle = 0;
  for (int i = 0; i < f->count; i++) nearest[i] = INT64_MAX;
  for (int part = 0; part < PARTS; part++) {
    int next = 0;
    for (int i = 0; i < f->count; i++) {
      int64_t here = square_px(&f->samples[middle], f->samples[i].x, f->samples[i].y);
      if (here < nearest[i]) nearest[i] = here, f->samples[i].part = (rc_kin)1 << part;
      if (nearest[i] > nearest[next]) next = i;
    }
    middle = next;
  }
}

/* The percentile of the squares; infinite where there are no such samples. */
static float own_spread(const finder *f) {
  float nearest[MOST_SAMPLES];
  int count = 0;
  for (int i = 0; i < f->count; i++) {
    const sample *p = &f->samples[i];
    float least = INFINITY;
    for (int k = 0; k < f->count; k++) {
      const sample *q = &f->samples[k];
      bool shares = abs(p->x - q->x) <= 2 * HALF_PX && abs(p->y - q->y) <= 2 * HALF_PX;
      if (!shares && square_px(p, q->x, q->y) <= OWN_PX * OWN_PX)
        least = fminf(least, rc_looks_square(&p->looks, &q->looks));
    }
    if (isfinite(least)) nearest[count++] = least;
  }
  if (count < LEAST_SAMPLES) return INFINITY;
  qsort(nearest, (size_t)count, sizeof *nearest, rc_by_value);
  return nearest[count * OWN_PERCENTILE / 100];
}

static rc_kin kin_of_source(const finder *f, int x, int y) {
  rc_looks looks;
  rc_kin kin = 0;
  if (!rc_look(f->image, f->flags, x, y, HALF_PX, &looks)) return RC_ALL_KIN;
  for (int i = 0; i < f->count; i++)
    if (!(kin & f->samples[i].part) && rc_looks_square(&looks, &f->samples[i].looks) <= f->most)
      kin |= f->samples[i].part;
  return kin;
}

static rc_kin kin_of_target(const finder *f, int x, int y, int depth) {
  rc_kin kin = 0;
  int near = depth + MARGIN_PX;
  for (int i = 0; i < f->count; i++)
    if (square_px(&f->samples[i], x, y) <= near * near) kin |= f->samples[i].part;
  return kin ? kin : RC_ALL_KIN;
}

static void find_row(void *user, int y, int thread) {
  const finder *f = user;
  (void)thread;
  for (int x = 0; x < f->flags->width; x++) {
    size_t at = (size_t)y * (size_t)f->flags->width + (size_t)x;
    uint8_t flags = f->flags->data[at];
    f->kin[at] = flags & RC_TARGET   ? kin_of_target(f, x, y, f->depth[at])
                 : flags & RC_SOURCE ? kin_of_source(f, x, y)
                                     : RC_ALL_KIN;
  }
}

/* Of one grid of the pixels with a flag. */
static int take_kin(const finder *f, uint8_t flag, rc_kin taken[MOST_EACH]) {
  size_t pixels = (size_t)f->flags->width * (size_t)f->flags->height, all = 0, seen = 0;
  int count = 0;
  for (size_t i = 0; i < pixels; i++) all += f->flags->data[i] & flag ? 1 : 0;
  size_t step = all / MOST_EACH + 1;
  for (size_t i = 0; i < pixels; i++)
    if (f->flags->data[i] & flag && seen++ % step == 0) taken[count++] = f->kin[i];
  return count;
}

static bool are_several(const finder *f) {
  rc_kin source[MOST_EACH], target[MOST_EACH];
  int sources = take_kin(f, RC_SOURCE, source), targets = take_kin(f, RC_TARGET, target), kin = 0;
  for (int i = 0; i < sources; i++)
    for (int k = 0; k < targets; k++) kin += (source[i] & target[k]) != 0;
  return kin <= MOST_KIN * sources * targets;
}

recede_status rc_kin_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                          rc_kin *kin, bool *told) {
  finder f = {.image = image, .flags = flags, .kin = kin};
  rc_block *mark = rc_mark(context);
  *told = false;
  RC_TRY(measure_distances(context, &f));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &f.samples));
  take_samples(&f);
  float own = TIMES_OWN * TIMES_OWN * own_spread(&f);
  if (isfinite(own)) {
    divide(&f);
    f.most = fmaxf(own, LEAST_UNLIKE * LEAST_UNLIKE * (float)rc_source_variance(image, flags));
    RC_TRY(rc_parallel(context, flags->height, find_row, &f));
    *told = are_several(&f);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
