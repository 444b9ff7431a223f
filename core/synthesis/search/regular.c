#include "synthesis/search/regular.h"

#include <math.h>

#include "base/memory.h"
#include "image/pyramid.h"
#include "synthesis/search/evaluate.h"

/* So many periods each way, and of a row. */
#define MOST_TIMES 4
#define ROW_TIMES 12
#define SIDE (2 * MOST_TIMES + 1)
/* A range reaches a little beyond what it is to hold, which is no farther than this. */
#define REACH_BY 1.05f
#define WIDEST 2.f

recede_status rc_periods_of_all(rc_context *context, const rc_image *images, const rc_mask *flags,
                                int levels, int shorter_px, const rc_chart *chart, float gain,
                                uint64_t key, rc_periods *periods) {
  rc_chart coarse = rc_chart_coarser(*chart, levels - 1);
  rc_traits none = {0};
  rc_level level;
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_level_new(context, &flags[levels - 1], &coarse, &level));
  level.sides.px = 1;
  RC_TRY(rc_level_see(context, &images[levels - 1], &none, 1.f, gain, true, &level));
  RC_TRY(rc_find_periods(context, &level, rc_halved(shorter_px, levels - 1), key, RC_REGULAR_POINTS,
                         true, false, periods));
  rc_release(context, mark);
  return rc_poll(context);
}

/* The middle one moves nothing. */
static int move_count(const rc_periods *periods) {
  return periods->row ? 2 * ROW_TIMES + 1 : SIDE * SIDE;
}

static rc_copy move_by(const rc_periods *periods, int n) {
  const rc_copy *p = &periods->base[0], *q = &periods->base[1];
  float i = (float)(n % SIDE - MOST_TIMES), j = (float)(n / SIDE - MOST_TIMES);
  if (periods->row) i = (float)(n - ROW_TIMES), j = 0;
  return (rc_copy){i * p->a + j * q->a, i * p->b + j * q->b, 0.f};
}

/* The ratio nearest to 1 by which a patch so moved is source; 1 where there is none. */
static float nearest_ratio(const rc_level *level, const rc_copy *moves, int count, int x, int y) {
  float best = WIDEST;
  size_t at;
  for (int n = 0; n < count; n++) {
    rc_place place =
        rc_copy_place(&level->chart, moves[n], rc_level_x(level, x), rc_level_y(level, y));
    if (!rc_place_at(level, &place, &at) || level->room[at] <= RC_PATCH_RADIUS + 1 ||
        !(place.mismatch < RC_MOST_MISMATCH && place.mismatch > 1 / RC_MOST_MISMATCH))
      continue;
    float off = fmaxf(place.ratio, 1 / place.ratio);
    if (off < fmaxf(best, 1 / best)) best = place.ratio;
  }
  return best == WIDEST ? 1 : best;
}

recede_status rc_reach_moves(rc_context *context, rc_level *level, const rc_copy *moves,
                             int count) {
  for (int y = level->box.y0; y < level->box.y1; y++) {
    RC_TRY(rc_poll(context));
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      int c = level->classes[rc_level_at(level, x, y)];
      float ratio = nearest_ratio(level, moves, count, x, y);
      level->ranges.low[c] = fminf(level->ranges.low[c], ratio / REACH_BY);
      level->ranges.high[c] = fmaxf(level->ranges.high[c], ratio * REACH_BY);
    }
  }
  return RECEDE_OK;
}

recede_status rc_moves_by_periods(rc_context *context, const rc_periods *periods,
                                  const rc_copy **moves, int *count) {
  rc_copy *made;
  *count = 0;
  int all = move_count(periods);
  RC_TRY(RC_NEW(context, all - 1, &made));
  for (int n = 0; n < all; n++)
    if (n != all / 2) made[(*count)++] = move_by(periods, n);
  *moves = made;
  return RECEDE_OK;
}
