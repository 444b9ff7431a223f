#include "synthesis/alike.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

/* Of known pixels: how many, colours, brightness and its square. */
typedef struct sums {
  double known, colour[3], bright, square;
} sums;

typedef struct comparison {
  const rc_image *image;
  const rc_mask *flags;
  int width, height;
  sums *column;       /* of each thread: width of them, of a square's rows */
  looks *sample;      /* in the order of their pixels */
  int32_t *sample_at; /* pixels */
  int sample_count;
  float most; /* square of the distance from which on looks are unlike */
  uint8_t *unlike;
} comparison;

static void add(sums *to, const sums *s) {
  to->known += s->known, to->bright += s->bright, to->square += s->square;
  for (int k = 0; k < 3; k++) to->colour[k] += s->colour[k];
}

static sums pixel_sums(const comparison *c, int x, int y) {
  sums s = {0, {0, 0, 0}, 0, 0};
  if (!(*rc_flag(c->flags, x, y) & RC_KNOWN)) return s;
  const float *v = rc_pixel(c->image, x, y);
  bool grey = c->image->channels == 1;
  s.known = 1;
  for (int k = 0; k < 3; k++) s.colour[k] = v[grey ? 0 : k];
  s.bright = .3 * s.colour[0] + .59 * s.colour[1] + .11 * s.colour[2];
  s.square = s.bright * s.bright;
  return s;
}

/* Of the columns of the squares around a row's pixels. */
static sums *sum_columns(const comparison *c, int y, int thread) {
  sums *column = c->column + (size_t)thread * (size_t)c->width;
  memset(column, 0, (size_t)c->width * sizeof *column);
  for (int row = y - HALF_PX; row <= y + HALF_PX; row++)
    for (int x = 0; row >= 0 && row < c->height && x < c->width; x++) {
      sums s = pixel_sums(c, x, row);
      add(&column[x], &s);
    }
  return column;
}

/* False where too little is known. */
static bool look(const comparison *c, const sums *column, int x, int y, looks *out) {
  int x0 = x < HALF_PX ? 0 : x - HALF_PX, y0 = y < HALF_PX ? 0 : y - HALF_PX;
  int x1 = x + HALF_PX >= c->width ? c->width : x + HALF_PX + 1;
  int y1 = y + HALF_PX >= c->height ? c->height : y + HALF_PX + 1;
  sums s = {0, {0, 0, 0}, 0, 0};
  for (int i = x0; i < x1; i++) add(&s, &column[i]);
  if (s.known < LEAST_KNOWN * (x1 - x0) * (y1 - y0)) return false;
  for (int k = 0; k < 3; k++) /* three channels weigh as one */
    out->value[k] = (float)(s.colour[k] / s.known * .57735026918962576);
  double bright = s.bright / s.known;
  out->value[3] = (float)sqrt(fmax(s.square / s.known - bright * bright, 0));
  return true;
}

static float distance_of(const looks *p, const looks *q) {
  float sum = 0;
  for (int k = 0; k < LOOKS; k++) sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
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

/* Every n-th of them. Their looks are taken in the order of the pixels, so that a row's columns are
 * summed once. */
static void take_samples(comparison *c, const uint8_t *beside) {
  size_t pixels = (size_t)c->width * (size_t)c->height;
  const sums *column = NULL;
  int found = 0, row = -1;
  for (size_t i = 0; i < pixels; i++) found += beside[i];
  int step = found / MOST_SAMPLES + 1;
  found = 0;
  for (size_t i = 0; i < pixels; i++) {
    int x = (int)(i % (size_t)c->width), y = (int)(i / (size_t)c->width);
    if (!beside[i] || found++ % step) continue;
    if (y != row) column = sum_columns(c, row = y, 0);
    if (look(c, column, x, y, &c->sample[c->sample_count]))
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

static void compare_row(void *user, int y, int thread) {
  const comparison *c = user;
  const sums *column = sum_columns(c, y, thread);
  uint8_t *unlike = c->unlike + (size_t)y * (size_t)c->width;
  for (int x = 0; x < c->width; x++) {
    looks here;
    int i = 0;
    unlike[x] = 0;
    if (!(*rc_flag(c->flags, x, y) & RC_KNOWN) || !look(c, column, x, y, &here)) continue;
    while (i < c->sample_count && distance_of(&here, &c->sample[i]) > c->most) i++;
    unlike[x] = i == c->sample_count;
  }
}

static bool enough_left(const comparison *c) {
  uint64_t target = 0, left = 0;
  for (size_t i = 0; i < (size_t)c->width * (size_t)c->height; i++) {
    target += c->flags->data[i] & RC_TARGET ? 1 : 0;
    left += c->flags->data[i] & RC_SOURCE && !c->unlike[i] ? 1 : 0;
  }
  return left >= ENOUGH_SOURCE * target;
}

static void take_source(const comparison *c, const rc_mask *flags, int shift) {
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      size_t at = (size_t)(y >> shift) * (size_t)c->width + (size_t)(x >> shift);
      if (c->unlike[at]) *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
    }
}

recede_status rc_keep_alike(rc_context *context, const rc_image *images, const rc_mask *flags,
                            int levels) {
  const rc_image *image = &images[levels - 1];
  comparison c = {
      .image = image, .flags = &flags[levels - 1], .width = image->width, .height = image->height};
  size_t width = (size_t)c.width, pixels = width * (size_t)c.height;
  float *nearest;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)context->threads * width, &c.column));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample_at));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &nearest));
  RC_TRY(RC_NEW(context, pixels, &c.unlike));
  RC_TRY(mark_beside(context, &c, c.unlike));
  take_samples(&c, c.unlike);
  double own = TIMES_OWN * TIMES_OWN * own_spread(&c, nearest);
  c.most = (float)fmax(own, LEAST_UNLIKE * LEAST_UNLIKE * variance_of(&c));
  RC_TRY(rc_parallel(context, c.height, compare_row, &c));
  for (int exponent = enough_left(&c) ? levels - 1 : -1; exponent >= 0; exponent--)
    take_source(&c, &flags[exponent], levels - 1 - exponent);
  rc_release(context, mark);
  return RECEDE_OK;
}
