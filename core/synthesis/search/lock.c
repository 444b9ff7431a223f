#include "synthesis/search/lock.h"

#include <math.h>

#include "base/memory.h"
#include "synthesis/search/evaluate.h"

/* How far to each side the texture moves in with a line, px of the finest level: the join needs its
 * whole width and a little more, and a coarse level a pixel. More of it breaks the bricks beside a
 * boundary. */
#define LOCKED_PX 5.f
#define LOCKED_BESIDE_PX 2.f
#define LEAST_LOCKED_PX 1.f

/* Nearly all that a sample counts lies so near, in px of the size that is wanted. */
#define SAMPLED_PX 1

/* Whether what a sample there counts may be copied. */
static bool may_be_laid(const rc_level *level, const rc_place *place) {
  int sx, sy, reach = SAMPLED_PX;
  if (!rc_place_px(level, place, &sx, &sy)) return false;
  if (place->ratio > 1.f) reach = (int)(SAMPLED_PX * place->ratio);
  if (sx < reach || sy < reach || sx + reach >= level->width || sy + reach >= level->height)
    return false;
  for (int y = sy - reach; y <= sy + reach; y++)
    for (int x = sx - reach; x <= sx + reach; x++)
      if ((level->flags[(size_t)y * (size_t)level->width + (size_t)x] & (RC_TARGET | RC_ALLOWED)) !=
          RC_ALLOWED)
        return false;
  return true;
}

static void lock_line(const rc_crossing *line, int exponent, rc_level *level) {
  const rc_chart *chart = &level->chart;
  float unit = (float)(1 << exponent);
  float from = line->ends_inside ? 0 : -.1f;
  bool sure = rc_crossing_is_sure(line);
  uint8_t wanted = sure ? RC_ALLOWED : RC_SOURCE;
  rc_crossing c = rc_crossing_coarser(*line, exponent);
  rc_copy copies[RC_MOST_PIECES];
  float dx = c.bx - c.ax, dy = c.by - c.ay, square = dx * dx + dy * dy;
  for (int k = 0; k < c.pieces; k++) {
    float t = ((float)k + .5f) / (float)c.pieces;
    copies[k] = rc_copy_exact(chart, c.ax + t * dx - chart->x0, c.ay + t * dy - chart->y0,
                              c.from_x[k] - chart->x0, c.from_y[k] - chart->y0);
  }
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      float t = (((float)x - c.ax) * dx + ((float)y - c.ay) * dy) / square;
      float px = (float)x, py = (float)y;
      float reach = c.reach_px[rc_crossing_is_right(&c, px, py)] * rc_chart_w(chart, px, py);
      reach = fmaxf(fmaxf(LOCKED_PX / unit, LEAST_LOCKED_PX), reach + LOCKED_BESIDE_PX / unit);
      if (!rc_level_is_target(level, x, y) || t < from || t > 1.1f ||
          rc_crossing_distance(&c, px, py) > reach)
        continue;
      int piece = (int)(fminf(fmaxf(t, 0), .999f) * (float)c.pieces);
      rc_place place =
          rc_copy_place(chart, copies[piece], rc_level_x(level, x), rc_level_y(level, y));
      size_t at = rc_level_at(level, x, y), source;
      if (!rc_place_at(level, &place, &source) || !(level->flags[source] & wanted) ||
          (sure && exponent == 0 && !may_be_laid(level, &place)))
        continue;
      level->field[at] = copies[piece];
      level->cost[at] = 0;
      level->locked[at] = sure ? RC_LOCKED_SURELY : RC_LOCKED;
    }
}

recede_status rc_lines_lock(rc_context *context, const rc_crossing *lines, int count, int exponent,
                            rc_level *level) {
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  RC_TRY(RC_NEW_ZERO(context, box, &level->locked));
  /* The first of all last: it stays whole. */
  for (int i = count - 1; i >= 0; i--) lock_line(&lines[i], exponent, level);
  return RECEDE_OK;
}

static void lay(const rc_ground *ground, const rc_dash_row *row, const rc_dash_laid *laid,
                uint8_t number, rc_level *finest) {
  rc_copy copy;
  rc_box box = rc_dash_laid_box(ground, row, laid, finest->box);
  for (int y = box.y0; y < box.y1; y++)
    for (int x = box.x0; x < box.x1; x++) {
      float at_x = rc_level_x(finest, x), at_y = rc_level_y(finest, y);
      size_t at = rc_level_at(finest, x, y);
      if (!rc_level_is_target(finest, x, y) || finest->laid[at] ||
          !rc_dash_laid_copy(ground, row, laid, &finest->chart, at_x, at_y, &copy))
        continue;
      rc_place place = rc_copy_place(&finest->chart, copy, at_x, at_y);
      if (!may_be_laid(finest, &place)) continue;
      finest->field[at] = copy;
      finest->laid[at] = number;
    }
}

recede_status rc_dash_rows_lay(rc_context *context, const rc_dash_rows *rows, rc_level *finest) {
  uint8_t number = 0; /* 8 rows of 24 at the most */
  if (!rows->count) return RECEDE_OK;
  RC_TRY(RC_NEW_ZERO(context, (size_t)finest->box_w * (size_t)finest->box_h, &finest->laid));
  for (int i = 0; i < rows->count; i++)
    for (int k = 0; k < rows->rows[i].laid_count; k++) {
      lay(&rows->ground, &rows->rows[i], &rows->rows[i].laid[k], ++number, finest);
      RC_TRY(rc_poll(context));
    }
  return RECEDE_OK;
}
