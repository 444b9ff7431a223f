#include "synthesis/sources/spots.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/sources/places.h"

/* A spot differs from the mean of its square by more than so many times what anything so near to
 * the hole does: people on a dune 6 and 15, markings on a road 5 and 24. Of what fills the picture
 * at most one pixel of 200 does, and in most of it none. */
#define TIMES_BESIDE 2.f
/* Where nothing there differs by so much of white, as beside a plain wall, this counts: else any
 * grain would stand out. */
#define LEAST_CONTRAST .03f
/* What a spot's place is marked by; those around it by 1. */
#define SPOT 2

typedef struct finder {
  rc_places places;
  float most; /* square of how far a pixel may stand out */
} finder;

/* How far a pixel is from the mean of its looks: the square, over the channels' number. */
static float stands_out(const rc_places *p, int x, int y, const rc_looks *looks) {
  const float *v = rc_pixel(p->image, x, y);
  float sum = 0;
  for (int k = 0; k < 3; k++) {
    float off = .57735027f * v[p->image->channels == 1 ? 0 : k] - looks->value[k];
    sum += off * off;
  }
  return sum;
}

/* INFINITY: there is nothing near the hole. */
static float most_near_hole(const rc_places *p) {
  float most = -1;
  for (int y = 0; y < p->flags->height; y++)
    for (int x = 0; x < p->flags->width; x++) {
      uint8_t away = p->beside[y * p->flags->width + x];
      rc_looks here;
      if (away && away <= RC_TOUCHING_PX && rc_look_at(p, x, y, &here))
        most = fmaxf(most, stands_out(p, x, y, &here));
    }
  if (most < 0) return INFINITY;
  return TIMES_BESIDE * TIMES_BESIDE * fmaxf(most, LEAST_CONTRAST * LEAST_CONTRAST);
}

static void find_row(void *user, int row, int thread) {
  const finder *f = user;
  (void)thread;
  for (int column = 0; column < f->places.columns; column++) {
    rc_looks here;
    if (rc_look_at_place(&f->places, column, row, &here) &&
        stands_out(&f->places, column, row, &here) > f->most)
      f->places.unlike[row * f->places.columns + column] = SPOT;
  }
}

/* False: there are none. */
static bool grow(const rc_places *p) {
  bool any = false;
  for (int y = 0; y < p->rows; y++)
    for (int x = 0; x < p->columns; x++) {
      if (p->unlike[y * p->columns + x] != SPOT) continue;
      any = true;
      rc_places_mark_around(p, x, y);
    }
  /* All goes, or nothing: a spot without its edge would leave that. */
  for (int i = 0; i < p->rows * p->columns; i++) p->unlike[i] = p->unlike[i] > 0;
  return any;
}

recede_status rc_drop_spots(rc_context *context, const rc_band *band, const rc_image *images,
                            const rc_mask *flags, int levels) {
  finder f;
  double taken;
  if (!rc_is_looked_at(&flags[levels - 1])) return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_places_new(context, images, flags, levels, RC_MOST_LOOKED_AT, &f.places));
  f.most = most_near_hole(&f.places);
  RC_TRY(rc_poll(context));
  RC_TRY(rc_parallel(context, f.places.rows, find_row, &f));
  if (grow(&f.places)) RC_TRY(rc_places_take(context, &f.places, band, flags, &taken));
  rc_release(context, mark);
  return RECEDE_OK;
}
