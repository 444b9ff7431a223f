#include "synthesis/search/rest.h"

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/search/evaluate.h"

#define TRIES 8
/* Sources are drawn from this part of them that is nearest to the target's size. */
#define NEAREST_PART 8
/* A cancel is looked for after so many pixels. */
#define POLLED_PX 4096

typedef struct rest {
  rc_level *level;
  uint64_t key;
  int32_t *queue; /* pixels that have a copy and may lack neighbours that do */
  int begin, end;
} rest;

static bool leads_to_source(const rc_level *level, rc_copy copy, int x, int y) {
  size_t at;
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
  return rc_place_at(level, &place, &at) && level->room[at];
}

static float w_at(const rc_level *level, int x, int y) {
  return rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
}

/* A side's sources stand in order of w: targets farther than most of them take from the first,
 * nearer ones from the last. */
static bool draw(const rest *r, int x, int y, rc_copy *copy) {
  const rc_level *level = r->level;
  rc_sources own = rc_level_side_sources(
      level, rc_level_side(level, rc_level_x(level, x), rc_level_y(level, y)));
  int sources = own.end - own.begin, part = sources / NEAREST_PART + 1;
  float w = w_at(level, x, y);
  if (!sources || !(w > 0.f)) return false;
  int32_t middle = level->order[own.begin + sources / 2];
  bool farther = w < w_at(level, middle % level->width, middle / level->width);
  for (int n = 0; n < TRIES; n++) {
    uint64_t bits = rc_random(r->key, (uint32_t)x, (uint32_t)y, (uint32_t)n);
    int i = (int)rc_below((uint32_t)bits, (uint32_t)(part < sources ? part : sources));
    int32_t source = level->order[farther ? own.begin + i : own.end - 1 - i];
    *copy = rc_copy_between(&level->chart, rc_level_x(level, x), rc_level_y(level, y),
                            rc_level_x(level, source % level->width),
                            rc_level_y(level, source / level->width));
    if (leads_to_source(level, *copy, x, y)) return true;
  }
  return false;
}

static void give(rest *r, int x, int y, rc_copy copy) {
  r->level->field[rc_level_at(r->level, x, y)] = copy;
  r->queue[r->end++] = y * r->level->width + x;
}

static bool lacks(const rc_level *level, int x, int y) {
  return rc_inside(level->width, level->height, x, y) && rc_level_is_target(level, x, y) &&
         isnan(level->field[rc_level_at(level, x, y)].a);
}

static recede_status spread(rc_context *context, rest *r) {
  static const int dx[4] = {-1, 1, 0, 0}, dy[4] = {0, 0, -1, 1};
  rc_level *level = r->level;
  while (r->begin < r->end) {
    if (r->begin % POLLED_PX == 0) RC_TRY(rc_poll(context));
    int32_t pixel = r->queue[r->begin++];
    int x = pixel % level->width, y = pixel / level->width;
    rc_copy copy = level->field[rc_level_at(level, x, y)];
    for (int i = 0; i < 4; i++) {
      int nx = x + dx[i], ny = y + dy[i];
      rc_copy drawn;
      if (!lacks(level, nx, ny)) continue;
      if (leads_to_source(level, copy, nx, ny))
        give(r, nx, ny, copy);
      else if (draw(r, nx, ny, &drawn))
        give(r, nx, ny, drawn);
    }
  }
  return RECEDE_OK;
}

recede_status rc_continue_rest(rc_context *context, rc_level *level, uint64_t key, uint8_t *marked,
                               uint64_t *count) {
  rest r = {.level = level, .key = key};
  rc_block *mark = rc_mark(context);
  *count = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!lacks(level, x, y)) continue;
      if (marked) marked[(size_t)y * (size_t)level->width + (size_t)x] = 1;
      ++*count;
    }
  if (!*count) return RECEDE_OK;
  bool sorted = level->order != NULL;
  if (!sorted) RC_TRY(rc_level_sort_sources(context, level));
  RC_TRY(RC_NEW(context, (size_t)level->box_w * (size_t)level->box_h, &r.queue));
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++)
      if (rc_level_is_target(level, x, y) && !lacks(level, x, y))
        r.queue[r.end++] = y * level->width + x;
  RC_TRY(spread(context, &r));
  for (int y = level->box.y0; y < level->box.y1; y++) {
    RC_TRY(rc_poll(context));
    for (int x = level->box.x0; x < level->box.x1; x++) {
      rc_copy drawn;
      if (!lacks(level, x, y) || !draw(&r, x, y, &drawn)) continue;
      give(&r, x, y, drawn);
      RC_TRY(spread(context, &r));
    }
  }
  rc_release(context, mark);
  if (!sorted) level->order = NULL;
  return RECEDE_OK;
}
