/* Tiles are scanned in parallel. Inside its tile a scan sees what it has just written, so that good
 * copies run far; outside it sees the field as it was before the pass, so that the order of the
 * tiles cannot matter. */
#include "synthesis/search/search.h"

#include <string.h>

#include "base/parallel.h"
#include "base/random.h"

#define TILE_PX 32
/* What chance proposes must be clearly better: it comes without neighbours that agree. */
#define CHANCE_MUST_BEAT .9f

typedef struct scan {
  rc_level *level;
  const rc_search *search;
  const rc_copy *old;
  int shift, tiles_x;
} scan;

typedef struct pixel_state {
  rc_query query;
  rc_copy neighbours[4];
  int neighbour_count, x, y;
  rc_copy best;
  float base, total; /* without and with price_of */
  float price;       /* of one neighbour that differs */
} pixel_state;

static int differing(const pixel_state *state, rc_copy copy) {
  int count = 0;
  for (int i = 0; i < state->neighbour_count; i++)
    count += !rc_same_copy(state->neighbours[i], copy);
  return count;
}

static void find_neighbours(const scan *s, rc_box tile, pixel_state *state) {
  static const int dx[4] = {-1, 1, 0, 0}, dy[4] = {0, 0, -1, 1};
  const rc_level *level = s->level;
  state->neighbour_count = 0;
  for (int i = 0; i < 4; i++) {
    int x = state->x + dx[i], y = state->y + dy[i];
    if (!rc_inside(level->width, level->height, x, y) || !rc_level_is_target(level, x, y) ||
        !rc_level_same_board(level, x, y, state->x, state->y))
      continue;
    bool own = x >= tile.x0 && x < tile.x1 && y >= tile.y0 && y < tile.y1;
    state->neighbours[state->neighbour_count++] =
        (own ? level->field : s->old)[rc_level_at(level, x, y)];
  }
}

static float usage_price(const scan *s, const rc_place *place) {
  size_t at;
  return s->search->usage && rc_place_at(s->level, place, &at) ? s->search->usage[at] : 0.f;
}

/* What a copy costs besides its distance. */
static float price_of(const scan *s, const pixel_state *state, rc_copy copy,
                      const rc_place *place) {
  float usage = isnan(copy.a) ? 0.f : usage_price(s, place);
  return state->price * (float)differing(state, copy) + usage;
}

/* Whether the copy is worse than the best: it stays so, for the best only gets better. */
static bool fails(const scan *s, pixel_state *state, rc_copy copy, float must_beat) {
  rc_place place = rc_query_place(s->level, &state->query, copy);
  float price = price_of(s, state, copy, &place);
  float limit = state->total * must_beat - price;
  if (!(limit > 0.f)) return true;
  float base = rc_query_cost(s->level, s->search->kernels, &state->query, copy, &place, limit);
  if (base >= limit) return true;
  state->best = copy;
  state->base = base;
  state->total = base + price;
  return false;
}

static bool try_copy(const scan *s, pixel_state *state, rc_copy copy, float must_beat) {
  return !rc_same_copy(copy, state->best) && !isnan(copy.a) && fails(s, state, copy, must_beat);
}

/* Neighbours mostly have the same copy: one that failed needs no second try. */
static void try_neighbours(const scan *s, pixel_state *state) {
  bool failed[4] = {false};
  for (int i = 0; i < state->neighbour_count; i++) {
    bool known = false;
    for (int k = 0; k < i && !known; k++)
      known = failed[k] && rc_same_copy(state->neighbours[k], state->neighbours[i]);
    failed[i] =
        known ||
        try_copy(s, state, rc_query_kind(s->level, &state->query, state->neighbours[i]), 1.f);
  }
}

static rc_copy copy_from(const scan *s, const pixel_state *state, float x, float y) {
  return rc_search_copy(s->search, s->level, state->query.x, state->query.y, x, y);
}

static void try_nearby(const scan *s, pixel_state *state) {
  const rc_level *level = s->level;
  int n = 0;
  for (int radius = s->search->local_radius; radius >= 2; radius /= 2, n++) {
    rc_place place = rc_query_place(level, &state->query, state->best);
    if (place.beyond) return;
    uint64_t bits = rc_level_random(level, s->search->key, state->x, state->y, (uint32_t)n);
    int dx = (int)rc_below((uint32_t)bits, 2u * (uint32_t)radius + 1) - radius;
    int dy = (int)rc_below((uint32_t)(bits >> 32), 2u * (uint32_t)radius + 1) - radius;
    float x = place.x + (float)dx, y = place.y + (float)dy;
    if (!(rc_level_w(level, x, y) > 0.f)) continue;
    try_copy(s, state, copy_from(s, state, x, y), CHANCE_MUST_BEAT);
  }
}

static void try_anywhere(const scan *s, pixel_state *state) {
  const rc_level *level = s->level;
  int x, y, c = level->classes[rc_level_at(level, state->x, state->y)];
  if (!s->search->anywhere) return;
  rc_sources sources = rc_level_sources(level, state->query.x, state->query.y, c);
  if (sources.begin == sources.end) return;
  for (int n = 0; n < s->search->anywhere; n++) {
    uint64_t bits = rc_level_random(level, s->search->key, state->x, state->y, 100u + (uint32_t)n);
    rc_level_random_source(level, sources, bits, &x, &y);
    try_copy(s, state, copy_from(s, state, rc_level_x(level, x), rc_level_y(level, y)),
             CHANCE_MUST_BEAT);
  }
}

static rc_copy shifted_by_period(const scan *s, const pixel_state *state, rc_copy from,
                                 rc_copy period) {
  const rc_level *level = s->level;
  if (!(from.r > 0.f) && !rc_has_lattice(&level->lattice))
    return (rc_copy){from.a + period.a, from.b + period.b, 0.f};
  rc_chart flat = rc_chart_flat(level->chart);
  rc_place place = rc_query_place(level, &state->query, from);
  rc_place moved = rc_copy_place(&flat, period, place.x, place.y);
  return moved.beyond ? from : copy_from(s, state, moved.x, moved.y);
}

static void try_periods(const scan *s, pixel_state *state) {
  const rc_search *search = s->search;
  bool stands = rc_chart_stands(&s->level->chart, state->query.x, state->query.y);
  rc_copy still = {0.f, 0.f, stands ? 1.f : 0.f};
  for (int n = 0; n < search->period_tries && search->period_count; n++) {
    uint64_t bits = rc_level_random(s->level, search->key, state->x, state->y, 200u + (uint32_t)n);
    rc_copy period = search->periods[rc_below((uint32_t)bits, (uint32_t)search->period_count)];
    rc_copy from = bits >> 63 ? state->best : still;
    try_copy(s, state, shifted_by_period(s, state, from, period), CHANCE_MUST_BEAT);
  }
}

static void improve_pixel(const scan *s, rc_box tile, pixel_state *state) {
  rc_level *level = s->level;
  size_t at = rc_level_at(level, state->x, state->y);
  rc_query_set(level, state->x, state->y, &state->query);
  find_neighbours(s, tile, state);
  state->best = level->field[at];
  state->base = level->cost[at];
  bool locked = level->locked && level->locked[at];
  if (!locked) state->best = rc_query_kind(level, &state->query, state->best);
  rc_place place = rc_query_place(level, &state->query, state->best);
  if (s->search->recost || !rc_same_copy(state->best, level->field[at]))
    state->base = isnan(state->best.a) ? RC_NO_COST
                                       : rc_query_cost(level, s->search->kernels, &state->query,
                                                       state->best, &place, RC_NO_COST);
  if (locked) {
    level->cost[at] = state->base < RC_NO_COST ? state->base : 0.f; /* part of it is no source */
    return;
  }
  state->total = state->base + price_of(s, state, state->best, &place);
  try_neighbours(s, state);
  try_anywhere(s, state);
  try_periods(s, state);
  try_nearby(s, state);
  level->field[at] = state->best;
  level->cost[at] = state->base;
}

static void scan_tile(void *user, int item, int thread) {
  const scan *s = user;
  const rc_level *level = s->level;
  (void)thread;
  rc_box tile = {level->box.x0 + item % s->tiles_x * TILE_PX - s->shift,
                 level->box.y0 + item / s->tiles_x * TILE_PX - s->shift, 0, 0};
  tile.x1 = tile.x0 + TILE_PX > level->box.x1 ? level->box.x1 : tile.x0 + TILE_PX;
  tile.y1 = tile.y0 + TILE_PX > level->box.y1 ? level->box.y1 : tile.y0 + TILE_PX;
  tile.x0 = tile.x0 < level->box.x0 ? level->box.x0 : tile.x0;
  tile.y0 = tile.y0 < level->box.y0 ? level->box.y0 : tile.y0;
  int width = tile.x1 - tile.x0, count = width * (tile.y1 - tile.y0);
  pixel_state state;
  rc_query_init(&state.query);
  state.price = s->search->coherence * level->variance;
  for (int k = 0; k < count; k++) {
    int i = s->search->pass & 1 ? count - 1 - k : k;
    state.x = tile.x0 + i % width;
    state.y = tile.y0 + i / width;
    if (rc_level_is_target(level, state.x, state.y)) improve_pixel(s, tile, &state);
  }
}

recede_status rc_search_pass(rc_context *context, rc_level *level, const rc_search *search,
                             rc_copy *old) {
  scan s = {level, search, old, search->pass & 1 ? TILE_PX / 2 : 0, 0};
  s.tiles_x = (level->box_w + s.shift + TILE_PX - 1) / TILE_PX;
  int tiles_y = (level->box_h + s.shift + TILE_PX - 1) / TILE_PX;
  memcpy(old, level->field, (size_t)level->box_w * (size_t)level->box_h * sizeof *old);
  return rc_parallel(context, s.tiles_x * tiles_y, scan_tile, &s);
}
