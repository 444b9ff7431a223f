#include "synthesis/near.h"

#include "base/memory.h"

/* The window is this many times the hole, in pixels inside the picture. Thirty holes in photos and
 * 62 in textures that fill their pictures, by window: docs/measured.md. */
#define TIMES_HOLE 12
/* So many times the hole are sources of its own scales in it: a source mask may be far away. */
#define TIMES_HOLE_SOURCE 3
/* Thin and small holes need several texels, too. */
#define LEAST_MARGIN_PX 64

/* What lies so many px outside the target's box, 0: inside. */
typedef struct ring {
  uint32_t pixels, sources;
} ring;

/* Chebyshev distance to the box, in px. */
static int distance_to(const rc_box *box, int x, int y) {
  int dx = x < box->x0 ? box->x0 - x : x >= box->x1 ? x - box->x1 + 1 : 0;
  int dy = y < box->y0 ? box->y0 - y : y >= box->y1 ? y - box->y1 + 1 : 0;
  return dx > dy ? dx : dy;
}

static uint64_t count_rings(const rc_mask *flags, const rc_box *target, const rc_band *band,
                            ring *rings) {
  uint64_t hole = 0;
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      ring *at = &rings[distance_to(target, x, y)];
      uint8_t flag = *rc_flag(flags, x, y);
      if (flag & RC_TARGET) {
        hole++;
        continue;
      }
      at->pixels++;
      at->sources += flag & RC_SOURCE && rc_band_holds(band, x, y);
    }
  return hole;
}

static int margin_of(const ring *rings, int most, uint64_t hole) {
  uint64_t pixels = 0, sources = 0;
  for (int margin = 0; margin < most; margin++) {
    pixels += rings[margin].pixels, sources += rings[margin].sources;
    if (margin >= LEAST_MARGIN_PX && pixels >= TIMES_HOLE * hole &&
        sources >= TIMES_HOLE_SOURCE * hole)
      return margin;
  }
  return most;
}

recede_status rc_keep_near(rc_context *context, const rc_mask *flags, const rc_box *target,
                           const rc_band *band) {
  int most = flags->width > flags->height ? flags->width : flags->height;
  ring *rings;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, most + 1, &rings));
  uint64_t hole = count_rings(flags, target, band, rings);
  RC_TRY(rc_poll(context));
  int margin = margin_of(rings, most, hole);
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++)
      if (distance_to(target, x, y) > margin) *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
  rc_release(context, mark);
  return rc_poll(context);
}
