#include "synthesis/sources/alike.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"
#include "synthesis/sources/places.h"

/* What is beside the hole is every n-th pixel of that. */
#define LEAST_SAMPLES 32
#define MOST_SAMPLES 512
/* Unlike: its distance to every sample is more than twice what the samples have, 90 of 100, to the
 * nearest other that shares no pixel with them; and more than this part of the sources' deviation.
 * Textures that fill the picture reach .25, roofs and a wall between them .5. */
#define TIMES_OWN 2.
#define OWN_PERCENTILE 90
#define LEAST_UNLIKE .3
/* Nothing goes unless something is half an octave beyond that: a texture that fills the picture has
 * places a little beyond, too, and needs them. */
#define LEAST_STEPS 4
/* Each is compared with all samples. */
#define MOST_PLACES (1 << 16)

typedef struct comparison {
  rc_places places;
  rc_looks *sample;
  int32_t *sample_at; /* pixels */
  int sample_count;
  float most; /* square of the distance from which on looks are unlike */
} comparison;

static void take_samples(comparison *c) {
  int width = c->places.flags->width, found = 0;
  int32_t pixels = width * c->places.flags->height;
  for (int32_t i = 0; i < pixels; i++) found += c->places.beside[i] > 0;
  int step = found / MOST_SAMPLES + 1;
  found = 0;
  for (int32_t i = 0; i < pixels; i++) {
    if (!c->places.beside[i] || found++ % step ||
        !rc_look_at(&c->places, i % width, i / width, &c->sample[c->sample_count]))
      continue;
    c->sample_at[c->sample_count++] = i;
  }
}

/* How much samples differ from those that share none of their pixels: the percentile of the
 * squares. Infinite where there are no such. */
static float own_spread(const comparison *c, float *nearest) {
  int width = c->places.flags->width, count = 0;
  for (int i = 0; i < c->sample_count; i++) {
    float least = INFINITY;
    for (int k = 0; k < c->sample_count; k++) {
      int dx = c->sample_at[i] % width - c->sample_at[k] % width;
      int dy = c->sample_at[i] / width - c->sample_at[k] / width;
      if (abs(dx) <= 2 * RC_LOOKS_PX && abs(dy) <= 2 * RC_LOOKS_PX) continue;
      least = fminf(least, rc_looks_square(&c->sample[i], &c->sample[k]));
    }
    if (isfinite(least)) nearest[count++] = least;
  }
  if (count < LEAST_SAMPLES) return INFINITY;
  qsort(nearest, (size_t)count, sizeof *nearest, rc_by_value);
  return nearest[count * OWN_PERCENTILE / 100];
}

/* 0: it is alike; else the more the farther off, a step each eighth of an octave. */
static uint8_t how_unlike(float square, float most) {
  const float step = 1.18920712f; /* 2^(1/4), for it is a square */
  uint8_t steps = 0;
  for (; square > most && steps < UINT8_MAX; most *= step) steps++;
  return steps;
}

static void compare_row(void *user, int row, int thread) {
  const comparison *c = user;
  (void)thread;
  for (int column = 0; column < c->places.columns; column++) {
    float least = INFINITY;
    rc_looks here;
    if (rc_is_beside(&c->places, column, row) || !rc_look_at_place(&c->places, column, row, &here))
      continue;
    for (int i = 0; i < c->sample_count && least > c->most; i++)
      least = fminf(least, rc_looks_square(&here, &c->sample[i]));
    c->places.unlike[row * c->places.columns + column] = how_unlike(least, c->most);
  }
}

static bool anything_clear(const rc_places *places) {
  for (int i = 0; i < places->columns * places->rows; i++)
    if (places->unlike[i] >= LEAST_STEPS) return true;
  return false;
}

recede_status rc_keep_alike(rc_context *context, const rc_band *band, const rc_image *images,
                            const rc_mask *flags, int levels, double *taken) {
  comparison c = {.sample_count = 0};
  float *nearest;
  rc_block *mark = rc_mark(context);
  *taken = 0;
  RC_TRY(rc_places_new(context, images, flags, levels, MOST_PLACES, &c.places));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &c.sample_at));
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &nearest));
  take_samples(&c);
  RC_TRY(rc_poll(context));
  double own = TIMES_OWN * TIMES_OWN * own_spread(&c, nearest);
  if (isfinite(own)) {
    c.most = (float)fmax(own, LEAST_UNLIKE * LEAST_UNLIKE *
                                  rc_source_variance(c.places.image, c.places.flags));
    RC_TRY(rc_parallel(context, c.places.rows, compare_row, &c));
    if (anything_clear(&c.places)) RC_TRY(rc_places_take(context, &c.places, band, flags, taken));
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
