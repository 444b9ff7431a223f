#include "synthesis/alike.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/distance.h"

/* A pixel's looks are those of the square around it, about half a hole wide. */
#define HALF_PX 4
/* So much of the square must be known. */
#define LEAST_KNOWN .4
/* What is beside the hole: so far from it, and every n-th pixel of that. */
#define BESIDE_PX 9
#define LEAST_SAMPLES 32
#define MOST_SAMPLES 512
/* Unlike is what differs from all samples by more than they do from one another, at a distance,
 * twice the 90th percentile; and by more than this part of the sources' deviation. Textures that
 * fill the picture reach .25, roofs and a wall between them .5. */
#define TIMES_OWN 2.
#define OWN_PERCENTILE 90
#define LEAST_UNLIKE .3
/* The hole's pixels in sources that must be left. */
#define ENOUGH_SOURCE 3

/* Mean colour and the deviation of brightness. */
#define LOOKS 4

typedef struct looks {
  float value[LOOKS];
} looks;

/* Sums over all pixels above and to the left: known ones, colours, brightness and its square. */
typedef struct sums {
  double known, colour[3], bright, square;
} sums;

typedef struct comparison {
  const rc_image *image;
  const rc_mask *flags;
  sums *integral; /* (width + 1) * (height + 1) */
  looks *sample;
  int32_t *sample_at; /* pixels */
  int sample_count;
  float most; /* square of the distance from which on looks are unlike */
  uint8_t *unlike;
} comparison;

static void integrate(const comparison *c) {
  size_t stride = (size_t)c->image->width + 1;
  for (int y = 0; y < c->image->height; y++) {
    sums row = {0, {0, 0, 0}, 0, 0};
    for (int x = 0; x < c->image->width; x++) {
      const sums *above = &c->integral[(size_t)y * stride + (size_t)x + 1];
      sums *here = &c->integral[(size_t)(y + 1) * stride + (size_t)x + 1];
      if (*rc_flag(c->flags, x, y) & RC_KNOWN) {
        const float *v = rc_pixel(c->image, x, y);
        bool grey = c->image->channels == 1;
        double bright = grey ? v[0] : .3 * v[0] + .59 * v[1] + .11 * v[2];
        row.known++, row.bright += bright, row.square += bright * bright;
        for (int k = 0; k < 3; k++) row.colour[k] += v[grey ? 0 : k];
      }
      here->known = above->known + row.known;
      for (int k = 0; k < 3; k++) here->colour[k] = above->colour[k] + row.colour[k];
      here->bright = above->bright + row.bright;
      here->square = above->square + row.square;
    }
  }
}

/* False where too little is known. */
static bool look(const comparison *c, int x, int y, looks *out) {
  int width = c->image->width, height = c->image->height;
  int x0 = x - HALF_PX < 0 ? 0 : x - HALF_PX, x1 = x + HALF_PX + 1;
  int y0 = y - HALF_PX < 0 ? 0 : y - HALF_PX, y1 = y + HALF_PX + 1;
  if (x1 > width) x1 = width;
  if (y1 > height) y1 = height;
  size_t stride = (size_t)width + 1, top = (size_t)y0 * stride, bottom = (size_t)y1 * stride;
  const sums *a = &c->integral[top + (size_t)x0], *b = &c->integral[top + (size_t)x1];
  const sums *d = &c->integral[bottom + (size_t)x0], *e = &c->integral[bottom + (size_t)x1];
  double n = e->known - d->known - b->known + a->known;
  if (n < LEAST_KNOWN * (x1 - x0) * (y1 - y0)) return false;
  for (int k = 0; k < 3; k++) {
    double mean = (e->colour[k] - d->colour[k] - b->colour[k] + a->colour[k]) / n;
    out->value[k] = (float)(mean * .57735026918962576); /* three channels weigh as one */
  }
  double bright = (e->bright - d->bright - b->bright + a->bright) / n;
  double square = (e->square - d->square - b->square + a->square) / n;
  out->value[3] = (float)sqrt(fmax(square - bright * bright, 0));
  return true;
}

static float distance_of(const looks *p, const looks *q) {
  float sum = 0;
  for (int k = 0; k < LOOKS; k++) sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
  return sum;
}

/* Sources beside the hole, every n-th of them. */
static recede_status take_samples(rc_context *context, comparison *c) {
  int width = c->image->width, found = 0, step = 1;
  size_t pixels = (size_t)width * (size_t)c->image->height;
  uint8_t *outside, *depth;
  RC_TRY(RC_NEW(context, pixels, &outside));
  RC_TRY(RC_NEW(context, pixels, &depth));
  for (size_t i = 0; i < pixels; i++) outside[i] = !(c->flags->data[i] & RC_TARGET);
  rc_distance_inside(outside, 1, width, c->image->height, false, depth);
  for (size_t i = 0; i < pixels; i++) {
    outside[i] = depth[i] && depth[i] <= BESIDE_PX && c->flags->data[i] & RC_SOURCE;
    found += outside[i];
  }
  step = found / MOST_SAMPLES + 1, found = 0;
  for (size_t i = 0; i < pixels; i++) {
    int x = (int)(i % (size_t)width), y = (int)(i / (size_t)width);
    if (!outside[i] || found++ % step || !look(c, x, y, &c->sample[c->sample_count])) continue;
    c->sample_at[c->sample_count++] = (int32_t)i;
  }
  return RECEDE_OK;
}

static int by_value(const void *a, const void *b) {
  float p = *(const float *)a, q = *(const float *)b;
  return (p > q) - (p < q);
}

/* How much samples differ from those that share none of their pixels: the percentile of the
 * squares. Infinite where there are no such. */
static float own_spread(const comparison *c, float *nearest) {
  int width = c->image->width, count = 0;
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
  for (int y = 0; y < c->image->height; y++)
    for (int x = 0; x < c->image->width; x++) {
      if (!(*rc_flag(c->flags, x, y) & RC_SOURCE)) continue;
      const float *v = rc_pixel(c->image, x, y);
      for (int k = 0; k < channels; k++) sum[k] += v[k], square[k] += (double)v[k] * v[k];
      count++;
    }
  for (int k = 0; k < channels && count > 0; k++)
    total += square[k] / count - sum[k] / count * (sum[k] / count);
  return fmax(total, 0) / channels;
}

static void compare_row(void *user, int y, int thread) {
  const comparison *c = user;
  (void)thread;
  for (int x = 0; x < c->image->width; x++) {
    looks here;
    uint8_t *unlike = c->unlike + (size_t)y * (size_t)c->image->width + (size_t)x;
    *unlike = 0;
    if (!(*rc_flag(c->flags, x, y) & RC_KNOWN) || !look(c, x, y, &here)) continue;
    int i = 0;
    while (i < c->sample_count && distance_of(&here, &c->sample[i]) > c->most) i++;
    *unlike = i == c->sample_count;
  }
}

static bool enough_left(const comparison *c) {
  uint64_t target = 0, left = 0;
  for (size_t i = 0; i < (size_t)c->image->width * (size_t)c->image->height; i++) {
    target += c->flags->data[i] & RC_TARGET ? 1 : 0;
    left += c->flags->data[i] & RC_SOURCE && !c->unlike[i] ? 1 : 0;
  }
  return left >= ENOUGH_SOURCE * target;
}

static void take_source(const comparison *c, const rc_mask *flags, int shift) {
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      size_t at = (size_t)(y >> shift) * (size_t)c->image->width + (size_t)(x >> shift);
      if (c->unlike[at]) *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
    }
}

recede_status rc_keep_alike(rc_context *context, const rc_image *images, const rc_mask *flags,
                            int levels) {
  comparison c = {.image = &images[levels - 1], .flags = &flags[levels - 1]};
  size_t width = (size_t)c.image->width, height = (size_t)c.image->height;
  float *nearest;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, (width + 1) * (height + 1), &c.integral));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample_at));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &nearest));
  RC_TRY(RC_NEW(context, width * height, &c.unlike));
  integrate(&c);
  RC_TRY(take_samples(context, &c));
  double own = TIMES_OWN * TIMES_OWN * own_spread(&c, nearest);
  c.most = (float)fmax(own, LEAST_UNLIKE * LEAST_UNLIKE * variance_of(&c));
  RC_TRY(rc_parallel(context, (int)height, compare_row, &c));
  for (int exponent = enough_left(&c) ? levels - 1 : -1; exponent >= 0; exponent--)
    take_source(&c, &flags[exponent], levels - 1 - exponent);
  rc_release(context, mark);
  return RECEDE_OK;
}
