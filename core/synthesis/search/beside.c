#include "synthesis/search/beside.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "synthesis/search/evaluate.h"

/* Sources so many times finer than the target show what is nearer. What is filled in steps copies
 * from up to 1.7 times. */
#define FINER 1.8f
/* Of so many moves along the horizon, up to so many times the hole's width away, the best is taken.
 * It is asked at so many places to each side, over a width each. */
#define MOVES 32
#define REACH_OF_WIDTH 3.f
#define PROBES 16
/* Where nothing is found for so many pixels of a row in succession every second is asked, then
 * every third: of pictures that end there are millions. */
#define SKIPPED_AFTER 64

typedef struct beside {
  rc_level *level;
  uint64_t key;
  bool whole;
  float along_x, along_y; /* the horizon's direction, of length 1 */
  float width;            /* of the hole along it */
  int32_t *queue;         /* pixels whose copy their neighbours may take */
  int begin, end;
} beside;

static rc_place place_of(const rc_level *level, rc_copy copy, int x, int y) {
  return rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
}

/* False where a copy leads to no source, or to one that is much nearer; else what its place costs.
 */
static bool goes_on(const beside *b, rc_copy copy, int x, int y, float *price) {
  const rc_level *level = b->level;
  rc_place place = place_of(level, copy, x, y);
  rc_query query;
  size_t at;
  *price = 0.f;
  if (!rc_place_at(level, &place, &at) || !level->room[at]) return false;
  if (!(place.ratio <= FINER)) return false;
  if (!b->whole) return true;
  rc_query_set(level, x, y, &query);
  *price = rc_query_price(level, &query, copy, &place);
  return *price < RC_NO_COST;
}

/* By what a copy misses a known pixel; false: that is none, or it has nothing there. */
static bool misses(const rc_level *level, rc_copy copy, int x, int y, float *miss) {
  size_t at = (size_t)y * (size_t)level->width + (size_t)x;
  rc_place place = place_of(level, copy, x, y);
  uint32_t pixel;
  if (!(level->flags[at] & RC_KNOWN) || !rc_place_pixel(level, &place, &pixel)) return false;
  *miss = rc_pixels_square(pixel, level->pixels[at]);
  return true;
}

/* What a move of (x, y) costs: to both sides of it targets where it ends, and what it misses known
 * pixels by. */
static float cost_of(const beside *b, rc_copy copy, int x, int y) {
  const rc_level *level = b->level;
  float targets = 0.f, target_cost = 0.f, known = 0.f, known_cost = 0.f, cost;
  float end = fmaxf(level->variance, 1.f);
  for (int k = -PROBES; k <= PROBES; k++) {
    float off = b->width * (float)k / PROBES;
    int px = x + (int)rc_round(off * b->along_x), py = y + (int)rc_round(off * b->along_y);
    if (!rc_inside(level->width, level->height, px, py)) continue;
    if (rc_level_is_target(level, px, py)) {
      target_cost += goes_on(b, copy, px, py, &cost) ? fminf(cost, end) : end;
      targets++;
    } else if (b->whole && misses(level, copy, px, py, &cost)) {
      known_cost += cost;
      known++;
    }
  }
  return target_cost / targets + known_cost / fmaxf(known, 1.f);
}

/* The best of some moves of (x, y) along the horizon. NAN: none goes on. */
static rc_copy draw(const beside *b, int x, int y) {
  const rc_level *level = b->level;
  rc_copy best = {NAN, NAN, NAN};
  float from_x = rc_level_x(level, x), from_y = rc_level_y(level, y), least = INFINITY, price;
  int side = rc_level_side(level, from_x, from_y);
  for (int n = 0; n < MOVES; n++) {
    double chance = rc_unit(rc_level_random(level, b->key, x, y, (uint32_t)n));
    float px = REACH_OF_WIDTH * b->width * (2.f * (float)chance - 1.f);
    float to_x = from_x + rc_round(px * b->along_x), to_y = from_y + rc_round(px * b->along_y);
    if (!(rc_level_w(level, to_x, to_y) > 0.f) || rc_level_side(level, to_x, to_y) != side)
      continue;
    rc_copy tried = rc_copy_between(&level->chart, from_x, from_y, to_x, to_y);
    if (!goes_on(b, tried, x, y, &price)) continue;
    float cost = cost_of(b, tried, x, y);
    if (cost < least) best = tried, least = cost;
  }
  return best;
}

static bool wants(const beside *b, int x, int y) {
  const rc_level *level = b->level;
  if (!rc_inside(level->width, level->height, x, y) || !rc_level_is_target(level, x, y))
    return false;
  size_t at = rc_level_at(level, x, y);
  rc_copy copy = level->field[at];
  if (level->locked && level->locked[at]) return false;
  if (!(rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y)) > 0.f)) return false;
  return isnan(copy.a) || place_of(level, copy, x, y).ratio > FINER;
}

typedef struct wanting {
  const beside *b;
  int *rows; /* how many of each */
} wanting;

static void count_row(void *user, int row, int thread) {
  const wanting *w = user;
  const rc_level *level = w->b->level;
  (void)thread;
  w->rows[row] = 0;
  for (int x = level->box.x0; x < level->box.x1; x++)
    w->rows[row] += wants(w->b, x, level->box.y0 + row);
}

static recede_status any_wants(rc_context *context, const beside *b, bool *any) {
  wanting w = {.b = b};
  RC_TRY(RC_NEW(context, b->level->box_h, &w.rows));
  RC_TRY(rc_parallel(context, b->level->box_h, count_row, &w));
  *any = false;
  for (int row = 0; row < b->level->box_h; row++) *any = *any || w.rows[row];
  RC_FREE(context, &w.rows);
  return RECEDE_OK;
}

/* The search asks anew what it costs, but votes count by it before. */
static void give(beside *b, int x, int y, rc_copy copy, float price) {
  b->level->field[rc_level_at(b->level, x, y)] = copy;
  b->level->cost[rc_level_at(b->level, x, y)] = price;
  b->queue[b->end++] = y * b->level->width + x;
}

static recede_status spread(rc_context *context, beside *b) {
  static const int dx[4] = {-1, 1, 0, 0}, dy[4] = {0, 0, -1, 1};
  const rc_level *level = b->level;
  float price;
  while (b->begin < b->end) {
    if (b->begin % RC_POLLED_PX == 0) RC_TRY(rc_poll(context));
    int32_t pixel = b->queue[b->begin++];
    int x = pixel % level->width, y = pixel / level->width;
    rc_copy copy = level->field[rc_level_at(level, x, y)];
    for (int i = 0; i < 4; i++)
      if (wants(b, x + dx[i], y + dy[i]) && goes_on(b, copy, x + dx[i], y + dy[i], &price))
        give(b, x + dx[i], y + dy[i], copy, price);
  }
  return RECEDE_OK;
}

recede_status rc_take_beside(rc_context *context, rc_level *level, uint64_t key, bool whole) {
  const rc_chart *chart = &level->chart;
  float steep = sqrtf(chart->lx * chart->lx + chart->ly * chart->ly);
  beside b = {.level = level, .key = key, .whole = whole};
  bool any;
  if (!(steep > 0.f)) return RECEDE_OK;
  b.along_x = -chart->ly / steep, b.along_y = chart->lx / steep;
  b.width = fabsf(b.along_x) * (float)level->box_w + fabsf(b.along_y) * (float)level->box_h;
  RC_TRY(any_wants(context, &b, &any));
  if (!any) return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)level->box_w * (size_t)level->box_h, &b.queue));
  for (int y = level->box.y0; !whole && y < level->box.y1; y++) {
    RC_TRY(rc_poll(context));
    for (int x = level->box.x0; x < level->box.x1; x++)
      if (rc_level_is_target(level, x, y) && !wants(&b, x, y))
        b.queue[b.end++] = y * level->width + x;
  }
  RC_TRY(spread(context, &b));
  for (int y = level->box.y0; y < level->box.y1; y++) {
    RC_TRY(rc_poll(context));
    int step = 1, failed = 0;
    for (int x = level->box.x0; x < level->box.x1; x += step) {
      float price;
      step = 1;
      if (!wants(&b, x, y)) continue;
      rc_copy copy = draw(&b, x, y);
      failed = isnan(copy.a) ? failed + 1 : 0;
      step = 1 + failed / SKIPPED_AFTER;
      if (failed || !goes_on(&b, copy, x, y, &price)) continue;
      give(&b, x, y, copy, price);
      RC_TRY(spread(context, &b));
    }
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
