#include "synthesis/sources/strangers.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/sources/places.h"

/* Colours are compared so many levels finer than the coarsest, where sand has not yet run into what
 * a person wears. */
#define FINER 2
/* A colour is strange so far from all near the hole, in differences of red, green and blue, white
 * being 1 each. By .22 fills of 62 pictures of one texture are what they were without, but pebbles
 * lose stones; by this people on dunes are still found. */
#define STRANGE .25f
/* Of -1 .. 1 in each channel, for the tone is taken away. */
#define BINS 64
/* A place is a spot where so much of its sources is strange, for a foot covers little of one, and
 * in the mean over the square around it less than half: people, not the sky. */
#define OF_PLACE .1f
#define MOST_OF_SQUARE .5f

typedef struct strangers {
  rc_places places;
  const rc_image *image; /* the finer level */
  const rc_mask *flags;
  int shift;      /* from the coarsest level's px to its */
  uint8_t *usual; /* of each bin: it is no farther than that from one near the hole */
  float *strange; /* of each place: the part of its sources */
} strangers;

static int bin_of(float value) {
  return (int)fminf(fmaxf((value + 1.f) * (BINS / 2), 0.f), BINS - 1);
}

static void bins_at(const strangers *s, int x, int y, int bin[3]) {
  const float *v = rc_pixel(s->image, x, y);
  for (int k = 0; k < 3; k++) bin[k] = bin_of(v[s->image->channels == 1 ? 0 : k]);
}

static size_t index_of(const int bin[3]) {
  return (size_t)((bin[0] * BINS + bin[1]) * BINS + bin[2]);
}

static bool is_near(const strangers *s, int x, int y) {
  const rc_places *p = &s->places;
  uint8_t away = p->beside[(y >> s->shift) * p->flags->width + (x >> s->shift)];
  return away && away <= RC_TOUCHING_PX;
}

/* Marks all bins that are near one. */
static void mark_usual(strangers *s, const int bin[3]) {
  const int reach = (int)(STRANGE * (BINS / 2));
  for (int r = -reach; r <= reach; r++)
    for (int g = -reach; g <= reach; g++)
      for (int b = -reach; b <= reach; b++) {
        int at[3] = {bin[0] + r, bin[1] + g, bin[2] + b};
        if (r * r + g * g + b * b > reach * reach) continue;
        bool in =
            at[0] >= 0 && at[0] < BINS && at[1] >= 0 && at[1] < BINS && at[2] >= 0 && at[2] < BINS;
        if (in) s->usual[index_of(at)] = 1;
      }
}

static recede_status find_usual(rc_context *context, strangers *s, bool *any) {
  uint8_t *seen;
  int bin[3];
  rc_block *before = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, BINS * BINS * BINS, &seen));
  for (int y = 0; y < s->flags->height; y++)
    for (int x = 0; x < s->flags->width; x++) {
      if (!is_near(s, x, y)) continue;
      bins_at(s, x, y, bin);
      if (!seen[index_of(bin)]) mark_usual(s, bin);
      seen[index_of(bin)] = 1, *any = true;
    }
  rc_release(context, before);
  return rc_poll(context);
}

static void compare_row(void *user, int row, int thread) {
  const strangers *s = user;
  int side = 1 << s->shift, bin[3];
  (void)thread;
  for (int column = 0; column < s->places.columns; column++) {
    int sources = 0, strange = 0;
    for (int y = row * side; y < (row + 1) * side && y < s->flags->height; y++)
      for (int x = column * side; x < (column + 1) * side && x < s->flags->width; x++) {
        if (!(*rc_flag(s->flags, x, y) & RC_SOURCE)) continue;
        bins_at(s, x, y, bin);
        sources++, strange += !s->usual[index_of(bin)];
      }
    s->strange[row * s->places.columns + column] = sources ? (float)strange / (float)sources : 0.f;
  }
}

static float strange_around(const strangers *s, int column, int row) {
  const rc_places *p = &s->places;
  float sum = 0, count = 0;
  for (int j = row - RC_LOOKS_PX; j <= row + RC_LOOKS_PX; j++)
    for (int i = column - RC_LOOKS_PX; i <= column + RC_LOOKS_PX; i++)
      if (rc_inside(p->columns, p->rows, i, j)) sum += s->strange[j * p->columns + i], count++;
  return sum / count;
}

static void mark_spots(const strangers *s) {
  const rc_places *p = &s->places;
  for (int y = 0; y < p->rows; y++)
    for (int x = 0; x < p->columns; x++) {
      bool is_spot =
          s->strange[y * p->columns + x] >= OF_PLACE && strange_around(s, x, y) < MOST_OF_SQUARE;
      if (is_spot) rc_places_mark_around(p, x, y);
    }
}

recede_status rc_drop_strangers(rc_context *context, const rc_band *band, const rc_image *images,
                                const rc_mask *flags, int levels) {
  strangers s = {.shift = levels - 1 < FINER ? levels - 1 : FINER};
  double taken;
  bool any = false;
  if (!rc_is_looked_at(&flags[levels - 1])) return RECEDE_OK;
  rc_block *before = rc_mark(context);
  s.image = &images[levels - 1 - s.shift], s.flags = &flags[levels - 1 - s.shift];
  RC_TRY(rc_places_new(context, images, flags, levels, RC_MOST_LOOKED_AT, &s.places));
  RC_TRY(RC_NEW_ZERO(context, BINS * BINS * BINS, &s.usual));
  RC_TRY(RC_NEW(context, s.places.columns * s.places.rows, &s.strange));
  RC_TRY(find_usual(context, &s, &any));
  if (any) {
    RC_TRY(rc_parallel(context, s.places.rows, compare_row, &s));
    mark_spots(&s);
    RC_TRY(rc_places_take(context, &s.places, band, flags, &taken));
  }
  rc_release(context, before);
  return RECEDE_OK;
}
