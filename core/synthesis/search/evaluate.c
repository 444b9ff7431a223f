#include "synthesis/search/evaluate.h"

#include <math.h>
#include <string.h>

static void set_lane(rc_patch *patch, int lane, uint32_t pixel, uint8_t weight) {
  patch->pixel[lane] = pixel;
  for (int k = 0; k < RC_COMPONENTS; k++) patch->weight[lane][k] = weight;
}

/* Away from the border all lanes lie in the picture. */
static int32_t gather_inside(const rc_level *level, size_t at, rc_patch *patch) {
  const uint32_t *pixels = level->pixels + at;
  const uint8_t *weights = level->weight + at;
  int32_t sum = 0;
  for (int chunk = 0; chunk < RC_PATCH_LANES; chunk += RC_PATCH_CHUNK)
    for (int i = chunk; i < chunk + RC_PATCH_PIXELS / 3; i++) {
      int32_t offset = level->lane_offset[i];
      set_lane(patch, i, pixels[offset], weights[offset]);
      sum += weights[offset];
    }
  return sum;
}

static int32_t gather_at_border(const rc_level *level, int x, int y, rc_patch *patch) {
  int32_t sum = 0;
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    int px = x + rc_lane_x[i], py = y + rc_lane_y[i];
    set_lane(patch, i, 0, 0);
    if (i % RC_PATCH_CHUNK >= RC_PATCH_PIXELS / 3 ||
        !rc_inside(level->width, level->height, px, py))
      continue;
    size_t at = (size_t)py * (size_t)level->width + (size_t)px;
    set_lane(patch, i, level->pixels[at], level->weight[at]);
    sum += level->weight[at];
  }
  return sum;
}

/* Other boards weigh nothing. */
static int32_t keep_board(const rc_level *level, int x, int y, rc_patch *patch) {
  int32_t sum = 0;
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    if (!patch->weight[i][0]) continue; /* padding, or outside the picture */
    if (!rc_level_same_board(level, x, y, x + rc_lane_x[i], y + rc_lane_y[i]))
      set_lane(patch, i, patch->pixel[i], 0);
    sum += patch->weight[i][0];
  }
  return sum;
}

void rc_query_init(rc_query *query) { memset(query, 0, sizeof *query); }

static void gather(const rc_level *level, rc_query *query) {
  int x = query->px, y = query->py;
  bool inside = x >= RC_PATCH_RADIUS && y >= RC_PATCH_RADIUS &&
                x < level->width - RC_PATCH_RADIUS && y < level->height - RC_PATCH_RADIUS;
  int32_t sum =
      inside ? gather_inside(level, (size_t)y * (size_t)level->width + (size_t)x, &query->patch)
             : gather_at_border(level, x, y, &query->patch);
  if (level->board) sum = keep_board(level, x, y, &query->patch);
  query->per_weight = sum ? 1.f / (float)sum : 0.f;
  query->gathered = true;
}

void rc_query_set(const rc_level *level, int x, int y, rc_query *query) {
  query->px = x;
  query->py = y;
  query->gathered = false;
  query->x = rc_level_x(level, x);
  query->y = rc_level_y(level, y);
  query->side =
      rc_has_sides(&level->sides) ? rc_side(&level->sides, &level->chart, query->x, query->y) : 0.f;
  query->condition = level->conditions.cells ? rc_condition_at(&level->conditions, x, y) : NULL;
  if (rc_has_lattice(&level->lattice)) {
    float w = rc_level_w(level, query->x, query->y);
    rc_lattice_phases(&level->lattice, query->x / w, query->y / w, query->phases);
  }
  int c = level->classes[rc_level_at(level, x, y)];
  query->low = level->ranges.low[c];
  query->high = level->ranges.high[c];
}

float rc_place_price(float variance, const rc_place *place, float low, float high) {
  if (place->beyond || !(place->ratio >= low && place->ratio <= high)) return RC_NO_COST;
  float log2_ratio = rc_log2(place->ratio), octaves = 1.5f * log2_ratio, price = 0;
  if (place->mismatch != 1.f) {
    if (!(place->mismatch < RC_MOST_MISMATCH && place->mismatch > 1.f / RC_MOST_MISMATCH))
      return RC_NO_COST;
    /* A copy of scale 1 is off by all of its ratio. */
    float off = place->mismatch == place->ratio ? log2_ratio : rc_log2(place->mismatch);
    price = RC_PRICE_MISMATCH * off * off;
  }
  price += (octaves < 0.f ? RC_PRICE_COARSE : RC_PRICE_FINE) * octaves * octaves;
  return variance * price;
}

/* Footprints that fit reach 64 px per px at the most. */
static int32_t fixed(float value) { return rc_floor(value * 65536.f + .5f); }

/* Whether all of a footprint lies in a square of room px around its centre's pixel. A pixel's index
 * is floor(fraction + .5 + offset), fraction < 1; .001 covers the fixed point's rounding. False for
 * an infinite or undefined Jacobian. */
static bool fits(const float j[4], uint8_t room) {
  float x = fabsf(j[0]) + fabsf(j[1]), y = fabsf(j[2]) + fabsf(j[3]);
  return RC_PATCH_RADIUS * x + 1.501f < (float)room && RC_PATCH_RADIUS * y + 1.501f < (float)room;
}

static bool set_footprint(const rc_level *level, const rc_chart *chart, rc_copy copy,
                          const rc_place *place, rc_footprint *footprint) {
  float jacobian[4], x = place->x + chart->x0, y = place->y + chart->y0;
  if (!(x >= 0.f && y >= 0.f && x <= (float)(level->width - 1) && y <= (float)(level->height - 1)))
    return false;
  int ix = (int)x, iy = (int)y;
  size_t at = (size_t)iy * (size_t)level->width + (size_t)ix;
  if (level->room[at] < RC_PATCH_RADIUS + 1) return false;
  rc_copy_jacobian(chart, copy, place, jacobian);
  if (!fits(jacobian, level->room[at])) return false;
  footprint->origin = level->pixels + at;
  footprint->stride = level->width;
  footprint->x = fixed(x - (float)ix) + 32768;
  footprint->y = fixed(y - (float)iy) + 32768;
  footprint->xx = fixed(jacobian[0]), footprint->xy = fixed(jacobian[1]);
  footprint->yx = fixed(jacobian[2]), footprint->yy = fixed(jacobian[3]);
  return true;
}

static float price_of_sides(const rc_level *level, const rc_query *query, const rc_place *place) {
  if (!rc_has_sides(&level->sides)) return 0.f;
  float side = rc_side(&level->sides, &level->chart, place->x, place->y);
  return RC_PRICE_SIDE * level->variance * rc_sides_square(&level->sides, side, query->side);
}

static float price_of_conditions(const rc_level *level, const rc_query *query,
                                 const rc_place *place) {
  int x, y;
  if (!query->condition || !rc_place_px(level, place, &x, &y)) return 0.f;
  return level->variance *
         rc_conditions_price(rc_condition_at(&level->conditions, x, y), query->condition);
}

static float price_of_layers(const rc_level *level, const rc_query *query, const rc_place *place) {
  if (!(level->layers > 0.f)) return 0.f;
  float off = (place->y - query->y) / (float)rc_longer_side(level->box);
  return level->layers * level->variance * off * off;
}

static float price_of_lattice(const rc_level *level, const rc_query *query, const rc_place *place) {
  if (!rc_has_lattice(&level->lattice)) return 0.f;
  return level->variance *
         rc_lattice_price(&level->lattice, &level->chart, query->phases, place->x, place->y);
}

float rc_query_price(const rc_level *level, const rc_query *query, rc_copy copy,
                     const rc_place *place) {
  return rc_query_allows(level, query, copy, place)
             ? rc_place_price(level->variance, place, query->low, query->high) +
                   price_of_sides(level, query, place) + price_of_conditions(level, query, place) +
                   price_of_layers(level, query, place) + price_of_lattice(level, query, place)
             : RC_NO_COST;
}

bool rc_query_allows(const rc_level *level, const rc_query *query, rc_copy copy,
                     const rc_place *place) {
  rc_footprint footprint;
  return rc_place_price(level->variance, place, query->low, query->high) < RC_NO_COST &&
         set_footprint(level, &level->chart, copy, place, &footprint);
}

float rc_query_cost(const rc_level *level, const rc_kernels *kernels, rc_query *query, rc_copy copy,
                    const rc_place *place, float limit) {
  rc_footprint footprint;
  float price = rc_place_price(level->variance, place, query->low, query->high);
  if (price < limit) price += price_of_sides(level, query, place);
  if (price < limit) price += price_of_conditions(level, query, place);
  if (price < limit) price += price_of_layers(level, query, place);
  if (price < limit) price += price_of_lattice(level, query, place);
  if (price >= limit || !set_footprint(level, &level->chart, copy, place, &footprint))
    return RC_NO_COST;
  if (!query->gathered) gather(level, query);
  float most = query->per_weight > 0.f ? (limit - price) / query->per_weight : 0.f;
  uint32_t stop = most < 4e9f ? (uint32_t)most + 1u : 4000000000u;
  return price + (float)kernels->distance(&query->patch, &footprint, stop) * query->per_weight;
}
