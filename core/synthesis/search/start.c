#include "synthesis/search/start.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/distance.h"

#define REFINE_FROM_PX 8
#define PIXELS_PER_ITEM 16

typedef struct ring {
  rc_level *level;
  const rc_search *search;
  const int32_t *pixels; /* of this ring */
  int count;
  const uint8_t *depth; /* of every pixel: its ring's number */
  int number;
} ring;

typedef struct choice {
  rc_query query;
  rc_copy best;
  float cost;
} choice;

static void consider(const ring *r, choice *c, rc_copy copy) {
  copy = rc_query_kind(r->level, &c->query, copy);
  if (isnan(copy.a) || rc_same_copy(copy, c->best)) return;
  rc_place place = rc_query_place(r->level, &c->query, copy);
  float cost = rc_query_cost(r->level, r->search->kernels, &c->query, copy, &place, c->cost);
  if (cost >= c->cost) return;
  c->cost = cost;
  c->best = copy;
}

/* Those of the rings before: the order within a ring must not matter. */
static void consider_neighbours(const ring *r, choice *c, int x, int y) {
  const rc_level *level = r->level;
  for (int ny = y - 1; ny <= y + 1; ny++)
    for (int nx = x - 1; nx <= x + 1; nx++)
      if (rc_inside(level->width, level->height, nx, ny) && rc_level_is_target(level, nx, ny) &&
          r->depth[(size_t)ny * (size_t)level->width + (size_t)nx] < r->number)
        consider(r, c, level->field[rc_level_at(level, nx, ny)]);
}

static void consider_chance(const ring *r, choice *c, int x, int y) {
  const rc_level *level = r->level;
  int sx, sy, class_index = level->classes[rc_level_at(level, x, y)];
  rc_sources sources = rc_level_sources(level, c->query.x, c->query.y, class_index);
  if (sources.begin == sources.end) return;
  for (int n = 0; n < r->search->anywhere; n++) {
    uint64_t bits = rc_level_random(level, r->search->key, x, y, (uint32_t)n);
    rc_level_random_source(level, sources, bits, &sx, &sy);
    consider(r, c,
             rc_search_copy(r->search, level, c->query.x, c->query.y, rc_level_x(level, sx),
                            rc_level_y(level, sy)));
  }
}

static void refine(const ring *r, choice *c, int x, int y) {
  const rc_level *level = r->level;
  for (int radius = REFINE_FROM_PX, n = 0; radius; radius /= 2)
    for (int k = 0; k < 4; k++, n++) {
      if (isnan(c->best.a)) return;
      rc_place place = rc_query_place(level, &c->query, c->best);
      uint64_t bits = rc_level_random(level, r->search->key, x, y, 500u + (uint32_t)n);
      int dx = (int)rc_below((uint32_t)bits, 2u * (uint32_t)radius + 1) - radius;
      int dy = (int)rc_below((uint32_t)(bits >> 32), 2u * (uint32_t)radius + 1) - radius;
      if (!(rc_level_w(level, place.x + (float)dx, place.y + (float)dy) > 0.f)) continue;
      consider(r, c,
               rc_search_copy(r->search, level, c->query.x, c->query.y, place.x + (float)dx,
                              place.y + (float)dy));
    }
}

static void consider_periods(const ring *r, choice *c) {
  if (r->level->chart.raised) return;
  for (int n = 0; n < r->search->period_count; n++) consider(r, c, r->search->periods[n]);
}

static void choose(const ring *r, int32_t pixel) {
  rc_level *level = r->level;
  int x = pixel % level->width, y = pixel / level->width;
  if (level->locked && level->locked[rc_level_at(level, x, y)]) return;
  choice c = {.best = {NAN, NAN, NAN}, .cost = RC_NO_COST};
  rc_query_init(&c.query);
  rc_query_set(level, x, y, &c.query);
  consider_neighbours(r, &c, x, y);
  consider_periods(r, &c);
  consider_chance(r, &c, x, y);
  refine(r, &c, x, y);
  size_t at = rc_level_at(level, x, y);
  level->field[at] = c.best;
  level->cost[at] = c.cost;
}

/* Pixels of one ring read the rings before it only. */
static void choose_some(void *user, int item, int thread) {
  const ring *r = user;
  (void)thread;
  int end = (item + 1) * PIXELS_PER_ITEM < r->count ? (item + 1) * PIXELS_PER_ITEM : r->count;
  for (int i = item * PIXELS_PER_ITEM; i < end; i++) choose(r, r->pixels[i]);
}

static void show(const ring *r, const uint8_t *final_weight) {
  rc_level *level = r->level;
  for (int i = 0; i < r->count; i++) {
    int x = r->pixels[i] % level->width, y = r->pixels[i] / level->width;
    size_t at = rc_level_at(level, x, y);
    rc_copy copy = level->field[at];
    uint32_t pixel;
    if (isnan(copy.a)) continue;
    rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
    if (!rc_place_field_pixel(level, &place, at, &pixel)) continue;
    level->pixels[r->pixels[i]] = pixel;
    level->weight[r->pixels[i]] = final_weight[r->pixels[i]];
  }
}

/* Target pixels by their distance from the border: ring n at pixels[first[n]] .. [first[n + 1]]. */
static void sort_rings(const rc_level *level, const uint8_t *depth, int32_t *pixels,
                       int32_t first[257]) {
  size_t count = (size_t)level->width * (size_t)level->height;
  int32_t next[256];
  memset(first, 0, 257 * sizeof *first);
  for (size_t i = 0; i < count; i++)
    if (depth[i]) first[depth[i] + 1]++;
  for (int n = 0; n < 256; n++) first[n + 1] += first[n];
  memcpy(next, first, sizeof next);
  for (size_t i = 0; i < count; i++)
    if (depth[i]) pixels[next[depth[i]]++] = (int32_t)i;
}

recede_status rc_start(rc_context *context, rc_level *level, const rc_search *search) {
  size_t count = (size_t)level->width * (size_t)level->height;
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  uint8_t *depth, *final_weight;
  int32_t *pixels, first[257];
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &depth));
  RC_TRY(RC_NEW(context, count, &final_weight));
  RC_TRY(RC_NEW(context, box, &pixels));
  memcpy(final_weight, level->weight, count);
  rc_distance_inside(level->flags, RC_TARGET, level->width, level->height, false, depth);
  sort_rings(level, depth, pixels, first);
  for (size_t i = 0; i < count; i++)
    if (depth[i]) level->weight[i] = 0;
  for (size_t i = 0; i < box; i++)
    if (!level->locked || !level->locked[i]) level->field[i] = (rc_copy){NAN, NAN, NAN};
  for (int n = 1; n < 256; n++) {
    ring r = {level, search, pixels + first[n], first[n + 1] - first[n], depth, n};
    if (!r.count) continue;
    RC_TRY(
        rc_parallel(context, (r.count + PIXELS_PER_ITEM - 1) / PIXELS_PER_ITEM, choose_some, &r));
    show(&r, final_weight);
  }
  memcpy(level->weight, final_weight, count);
  rc_release(context, mark);
  return RECEDE_OK;
}
