#include "synthesis/sources/near.h"

#include <math.h>

#include "base/memory.h"
#include "image/distance.h"
#include "kernels/kernels.h"

/* The window is this many times the hole, in pixels inside the picture. Thirty holes in photos and
 * 62 in textures that fill their pictures, by window: docs/measured.md. */
#define TIMES_HOLE 12
/* Thin and small holes need several texels, too. */
#define LEAST_MARGIN_PX 64
/* So many places for a patch are in it, beside as many as the hole has pixels. */
#define LEAST_PLACES (LEAST_MARGIN_PX * LEAST_MARGIN_PX)
/* Also of the hole's nearest third of scales, and its nearest two thirds: a tall hole's upper end
 * has sources that are too coarse for its lower. */
#define SLICES 3
/* A place at the coarsest level, whose hole is 18 px across or more, is that much of the hole's
 * width at the finest. */
#define ROOM_OF_WIDTH (1. / 3)

typedef struct window {
  const rc_mask *flags;
  const rc_box *target;
  const rc_band *band;
  double least_w[SLICES]; /* a slice holds what has at least this w */
  uint64_t hole[SLICES];  /* target pixels; the first: all */
  int room;               /* px from a place to the nearest that is no source */
} window;

/* What lies so many px outside the target's box, 0: inside. */
typedef struct ring {
  uint32_t pixels, places[SLICES];
} ring;

/* Chebyshev distance to the box, in px. */
static int distance_to(const rc_box *box, int x, int y) {
  int dx = x < box->x0 ? box->x0 - x : x >= box->x1 ? x - box->x1 + 1 : 0;
  int dy = y < box->y0 ? box->y0 - y : y >= box->y1 ? y - box->y1 + 1 : 0;
  return dx > dy ? dx : dy;
}

static bool all_is_near(const rc_mask *flags, const rc_box *target) {
  uint64_t pixels = (uint64_t)flags->width * (uint64_t)flags->height, hole = 0;
  for (int y = target->y0; y < target->y1; y++)
    for (int x = target->x0; x < target->x1; x++) hole += *rc_flag(flags, x, y) & RC_TARGET ? 1 : 0;
  return pixels < (TIMES_HOLE + 1) * hole;
}

static void count_rings(window *v, const uint8_t *room, ring *rings) {
  int width = v->flags->width;
  for (int y = 0; y < v->flags->height; y++)
    for (int x = 0; x < width; x++) {
      bool inside = *rc_flag(v->flags, x, y) & RC_TARGET;
      bool place = room[(size_t)y * (size_t)width + (size_t)x] >= v->room;
      ring *at = &rings[distance_to(v->target, x, y)];
      double w = rc_w(&v->band->w, x, y);
      at->pixels += !inside;
      for (int i = 0; i < SLICES && w >= v->least_w[i]; i++) {
        v->hole[i] += inside;
        at->places[i] += place && w <= v->band->most;
      }
    }
}

/* Beyond all that is counted the window needs room for the patches there. */
static int margin_of(const window *v, const ring *rings, int most) {
  uint64_t pixels = 0, places[SLICES] = {0};
  int wide = -1;
  for (int margin = 0; margin < most; margin++) {
    bool enough = true;
    pixels += rings[margin].pixels;
    for (int i = 0; i < SLICES; i++) {
      places[i] += rings[margin].places[i];
      enough = enough && places[i] >= v->hole[i] + (i ? 0 : LEAST_PLACES);
    }
    if (enough && wide < 0) wide = margin + v->room;
    if (wide >= 0 && margin >= wide && margin >= LEAST_MARGIN_PX &&
        pixels >= TIMES_HOLE * v->hole[0])
      return margin;
  }
  return most;
}

/* Twice the largest distance of a target pixel from one that is none, which is known up to 255. */
static recede_status widest(rc_context *context, const rc_mask *flags, int *width) {
  uint8_t *depth;
  int most = 0;
  size_t count = (size_t)flags->width * (size_t)flags->height;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &depth));
  rc_distance_inside(flags->data, RC_TARGET, flags->width, flags->height, false, depth);
  for (size_t i = 0; i < count; i++) most = depth[i] > most ? depth[i] : most;
  *width = 2 * most;
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_keep_near(rc_context *context, const rc_mask *flags, const rc_box *target,
                           const rc_band *band) {
  int most = flags->width > flags->height ? flags->width : flags->height, hole_width;
  if (all_is_near(flags, target)) return RECEDE_OK;
  RC_TRY(widest(context, flags, &hole_width));
  double room = fmax(ROOM_OF_WIDTH * hole_width, RC_PATCH_RADIUS + 2);
  window v = {.flags = flags, .target = target, .band = band};
  uint8_t *distance;
  ring *rings;
  rc_block *mark = rc_mark(context);
  v.room = (int)room;
  for (int i = 0; i < SLICES; i++)
    v.least_w[i] = band->least * pow(band->most / band->least, (double)i / SLICES);
  RC_TRY(RC_NEW(context, (size_t)flags->width * (size_t)flags->height, &distance));
  RC_TRY(RC_NEW_ZERO(context, most + 1, &rings));
  rc_distance_inside(flags->data, RC_SOURCE, flags->width, flags->height, false, distance);
  RC_TRY(rc_poll(context));
  count_rings(&v, distance, rings);
  RC_TRY(rc_poll(context));
  int margin = margin_of(&v, rings, most);
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      uint8_t *flag = rc_flag(flags, x, y);
      if (distance_to(target, x, y) > margin) *flag &= (uint8_t)~RC_SOURCE;
    }
  rc_release(context, mark);
  return rc_poll(context);
}
