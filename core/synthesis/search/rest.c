#include "synthesis/search/rest.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/search/evaluate.h"

#define TRIES 8
/* The last rows below the horizon may have no source at all, for of a coarse pixel that lies partly
 * beyond it nothing is known. Up to so many px from them there may be. */
#define NEAR_PX 16
/* Else sources are drawn from those nearest to the target's size, so many or more. */
#define LEAST_SOURCES 256

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

/* A side's sources stand in order of w. */
static rc_sources nearest_in_size(const rc_level *level, float x, float y) {
  const int32_t *first = level->first[rc_level_side(level, x, y)];
  int own = rc_level_bin(level, rc_level_w(level, x, y)), low = own, high = own + 1;
  while (first[high] - first[low] < LEAST_SOURCES && (low > 0 || high < level->bins)) {
    low -= low > 0;
    high += high < level->bins;
  }
  return (rc_sources){first[low], first[high]};
}

/* A copy of what lies a little nearer, somewhere along the horizon. */
static bool draw_near(const rest *r, int x, int y, rc_copy *copy) {
  const rc_level *level = r->level;
  const rc_chart *chart = &level->chart;
  float steep = sqrtf(chart->lx * chart->lx + chart->ly * chart->ly);
  float from_x = rc_level_x(level, x), from_y = rc_level_y(level, y);
  if (!(steep > 0.f)) return false;
  float down_x = chart->lx / steep, down_y = chart->ly / steep;
  for (int down = 1; down <= NEAR_PX; down *= 2)
    for (int n = 0; n < TRIES; n++) {
      uint64_t bits = rc_level_random(level, r->key, x, y, (uint32_t)(TRIES * down + n));
      float along = (float)((level->width + level->height) * (rc_unit(bits) - .5));
      float to_x = from_x + rc_round((float)down * down_x - along * down_y);
      float to_y = from_y + rc_round((float)down * down_y + along * down_x);
      if (rc_level_side(level, to_x, to_y) != rc_level_side(level, from_x, from_y)) continue;
      *copy = rc_copy_between(chart, from_x, from_y, to_x, to_y);
      if (leads_to_source(level, *copy, x, y)) return true;
    }
  return false;
}

static bool draw(const rest *r, int x, int y, rc_copy *copy) {
  const rc_level *level = r->level;
  float from_x = rc_level_x(level, x), from_y = rc_level_y(level, y);
  if (!(rc_level_w(level, from_x, from_y) > 0.f)) return false;
  if (draw_near(r, x, y, copy)) return true;
  rc_sources sources = nearest_in_size(level, from_x, from_y);
  if (sources.begin == sources.end) return false;
  for (int n = 0; n < TRIES; n++) {
    int to_x, to_y;
    rc_level_random_source(level, sources, rc_level_random(level, r->key, x, y, (uint32_t)n), &to_x,
                           &to_y);
    *copy = rc_copy_between(&level->chart, from_x, from_y, rc_level_x(level, to_x),
                            rc_level_y(level, to_y));
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
    if (r->begin % RC_POLLED_PX == 0) RC_TRY(rc_poll(context));
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

void rc_rest_forget_laid(const rc_level *finest, uint8_t *marked, uint64_t *count) {
  for (int y = finest->box.y0; y < finest->box.y1 && finest->laid; y++)
    for (int x = finest->box.x0; x < finest->box.x1; x++) {
      uint8_t *at = &marked[(size_t)y * (size_t)finest->width + (size_t)x];
      if (!finest->laid[rc_level_at(finest, x, y)] || !*at) continue;
      *at = 0, (*count)--;
    }
}
