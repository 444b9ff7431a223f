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

/* What is taken from the sources is so much wider than a line, and gets wider by so much on its
 * way, for it may bend a little. */
#define TAKEN_BESIDE_PX 3.f
#define TAKEN_WIDENS .02f
/* Of the coarsest level's sources no more than this part: in a narrow source all may lie along it.
 */
#define MOST_TAKEN .25
/* In place of a piece's own source another one's is no larger or smaller than this. */
#define MOST_ENLARGED 3.f
#define MOST_SHRUNK 6.f
#define MOST_SHRUNK_RECEDING 10.f

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

/* A level's view of a line. */
typedef struct track {
  const rc_level *level;
  rc_crossing line; /* px of the level */
  float dx, dy;     /* from a to b */
  bool finest, sure;
} track;

/* Moves one piece to where another, or itself, comes from. */
static rc_copy copy_of_piece(const track *t, int piece, int from) {
  const rc_chart *chart = &t->level->chart;
  const rc_crossing *c = &t->line;
  float part = rc_crossing_part(chart, c, (float)piece + .5f);
  return rc_copy_exact(chart, c->ax + part * t->dx - chart->x0, c->ay + part * t->dy - chart->y0,
                       c->from_x[from] - chart->x0, c->from_y[from] - chart->y0);
}

static bool may_be_taken(const track *t, rc_copy copy, bool own, int x, int y) {
  const rc_level *level = t->level;
  size_t source;
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
  float most_shrunk = t->line.recedes ? MOST_SHRUNK_RECEDING : MOST_SHRUNK;
  if (!own && !(place.ratio > 1 / MOST_ENLARGED && place.ratio < most_shrunk)) return false;
  return rc_place_at(level, &place, &source) &&
         level->flags[source] & (t->sure ? RC_ALLOWED : RC_SOURCE) &&
         !(t->sure && t->finest && !may_be_laid(level, &place));
}

/* What lies to a side of a piece may come from the hole, where those halves of a line meet that are
 * taken from its two ends. Of a sure line it then comes from where the nearest piece does from
 * where it may, so that no gap is left. */
static bool choose_copy(const track *t, int piece, int x, int y, rc_copy *copy) {
  for (int k = 0; k < (t->sure ? 2 * t->line.pieces : 1); k++) {
    int from = piece + (k % 2 ? (k + 1) / 2 : -(k / 2));
    if (from < 0 || from >= t->line.pieces) continue;
    *copy = copy_of_piece(t, piece, from);
    if (may_be_taken(t, *copy, from == piece, x, y)) return true;
  }
  return false;
}

/* How far from a to b: where it is as far away, of what recedes, for beside a slanting line the
 * nearest place is not, and a piece is short. */
static float part_at(const track *t, float x, float y) {
  const rc_crossing *c = &t->line;
  const rc_chart *chart = &t->level->chart;
  if (c->recedes) {
    float a = rc_chart_w(chart, c->ax, c->ay), b = rc_chart_w(chart, c->bx, c->by);
    return (rc_chart_w(chart, x, y) - a) / (b - a);
  }
  return ((x - c->ax) * t->dx + (y - c->ay) * t->dy) / (t->dx * t->dx + t->dy * t->dy);
}

static void lock_line(const rc_crossing *line, int exponent, rc_level *level) {
  float unit = (float)(1 << exponent), from = line->ends_inside ? 0 : -.1f;
  track along = {
      level, rc_crossing_coarser(*line, exponent), 0, 0, exponent == 0, rc_crossing_is_sure(line)};
  const rc_crossing *c = &along.line;
  along.dx = c->bx - c->ax, along.dy = c->by - c->ay;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      float px = (float)x, py = (float)y, t = part_at(&along, px, py);
      float reach =
          c->reach_px[rc_crossing_is_right(c, px, py)] * rc_chart_w(&level->chart, px, py);
      reach = fmaxf(fmaxf(LOCKED_PX / unit, LEAST_LOCKED_PX), reach + LOCKED_BESIDE_PX / unit);
      if (!rc_level_is_target(level, x, y) || t < from || t > 1.1f ||
          rc_crossing_distance(c, px, py) > reach)
        continue;
      int piece = rc_crossing_piece(&level->chart, c, t);
      size_t at = rc_level_at(level, x, y);
      rc_copy copy;
      if (!choose_copy(&along, piece, x, y, &copy)) continue;
      level->field[at] = copy;
      level->cost[at] = 0;
      level->locked[at] = along.sure ? RC_LOCKED_SURELY : RC_LOCKED;
    }
}

/* A marking's run outside the hole, at one level. */
static bool is_in_run(const rc_crossing *c, float unit, const rc_chart *chart, int x, int y) {
  float px = (float)x, py = (float)y, w = rc_chart_w(chart, px, py);
  float length = rc_crossing_length(c);
  float along = ((px - c->ax) * (c->bx - c->ax) + (py - c->ay) * (c->by - c->ay)) / length;
  float beyond = along < 0 ? -along : along - length;
  if (!(w > 0) || beyond < 0) return false;
  float reach_px = c->reach_px[rc_crossing_is_right(c, px, py)] * w;
  return rc_crossing_distance(c, px, py) <=
         reach_px + TAKEN_WIDENS * beyond + TAKEN_BESIDE_PX / unit + .5f;
}

/* taken: of so many sources; may be NULL, and then they are taken. */
static recede_status take_line(rc_context *context, const rc_crossing *line, int exponent,
                               const rc_chart *chart, const rc_mask *flags, size_t *taken,
                               size_t *sources) {
  float unit = (float)(1 << exponent);
  rc_crossing c = rc_crossing_coarser(*line, exponent);
  rc_chart here = rc_chart_coarser(*chart, exponent);
  for (int y = 0; y < flags->height; y++) {
    RC_TRY(rc_poll(context));
    for (int x = 0; x < flags->width; x++) {
      uint8_t *flag = rc_flag(flags, x, y);
      if (!(*flag & RC_SOURCE)) continue;
      bool in = is_in_run(&c, unit, &here, x, y);
      if (taken)
        *taken += in, ++*sources;
      else if (in)
        *flag = (uint8_t)((*flag & ~RC_SOURCE) | RC_TAKEN);
    }
  }
  return RECEDE_OK;
}

recede_status rc_lines_take(rc_context *context, const rc_crossing *lines, int count,
                            const rc_chart *chart, const rc_mask *flags, int levels, bool *any) {
  int last = levels - 1;
  *any = false;
  for (int i = 0; i < count; i++) {
    size_t taken = 0, sources = 0;
    if (!rc_crossing_is_marking(&lines[i]) || !(lines[i].reach_px[0] + lines[i].reach_px[1] > 0))
      continue;
    RC_TRY(take_line(context, &lines[i], last, chart, &flags[last], &taken, &sources));
    if ((double)taken > MOST_TAKEN * (double)sources) continue;
    *any = true;
    for (int n = 0; n < levels; n++)
      RC_TRY(take_line(context, &lines[i], n, chart, &flags[n], NULL, NULL));
  }
  return RECEDE_OK;
}

void rc_lines_give_back(const rc_mask *flags) {
  size_t pixels = (size_t)flags->width * (size_t)flags->height;
  for (size_t i = 0; i < pixels; i++)
    if (flags->data[i] & RC_TAKEN)
      flags->data[i] = (uint8_t)((flags->data[i] & ~RC_TAKEN) | RC_SOURCE);
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
