/* What a copy costs at a pixel: the distance of the patches, the price of another resolution. */
#ifndef RECEDE_SYNTHESIS_SEARCH_EVALUATE_H
#define RECEDE_SYNTHESIS_SEARCH_EVALUATE_H

#include "synthesis/search/level.h"

/* Prices in units of the picture's variance, per log2(s)^2 with s = ratio^1.5: too coarse a source
 * is blurred, too fine a one costs little. */
#define RC_PRICE_COARSE .3f
#define RC_PRICE_FINE .02f
/* And of a raised copy whose one scale does not fit its depth, per log2(mismatch)^2. */
#define RC_PRICE_MISMATCH .3f
/* A raised copy may be off by its scale step and a little more. */
#define RC_MOST_MISMATCH 1.1f

/* And of a source on another side than the target, per square of what their sides differ by: 4
 * at the most, where there are two. */
#define RC_PRICE_SIDE 6.f

#define RC_NO_COST 1e30f

/* The target patch at one pixel, ready to be compared. */
typedef struct rc_query {
  rc_patch patch;
  float per_weight;              /* 1 / sum of weights */
  float side;                    /* -1 .. 1 */
  const rc_condition *condition; /* NULL where all have the same */
  float phases[2];               /* in the lattice, if there is one */
  float x, y;                    /* relative to the chart's origin */
  float low, high;               /* ratios allowed here */
  int32_t px, py;
  bool gathered; /* patch and per_weight are set: not before the first distance is asked for */
} rc_query;

/* Once per query, before the first set: the padding lanes must weigh nothing. */
void rc_query_init(rc_query *query);
void rc_query_set(const rc_level *level, int x, int y, rc_query *query);
/* Cost of the copy, whose place it is, or any value >= limit (RC_NO_COST when it is not allowed:
 * wrong scale, or its footprint is not wholly source). */
float rc_query_cost(const rc_level *level, const rc_kernels *kernels, rc_query *query, rc_copy copy,
                    const rc_place *place, float limit);
/* The part of it that needs no pixels: what the place costs. */
float rc_query_price(const rc_level *level, const rc_query *query, rc_copy copy,
                     const rc_place *place);
/* Whether the copy has a cost at all. */
bool rc_query_allows(const rc_level *level, const rc_query *query, rc_copy copy,
                     const rc_place *place);
/* Where a copy takes the query's pixel from. */
static inline rc_place rc_query_place(const rc_level *level, const rc_query *query, rc_copy copy) {
  return rc_copy_place(&level->chart, copy, query->x, query->y);
}
/* Whether a copy stands where things stand, or lies where they lie. */
static inline bool rc_query_is_kind(const rc_level *level, const rc_query *query, rc_copy copy) {
  const rc_chart *chart = &level->chart;
  return !(chart->standing_w > 0.f) || rc_chart_stands(chart, query->x, query->y) == (copy.r > 0.f);
}
/* The copy, or the one of the right kind that takes the pixel from the same place. */
static inline rc_copy rc_query_kind(const rc_level *level, const rc_query *query, rc_copy copy) {
  if (rc_query_is_kind(level, query, copy) || isnan(copy.a)) return copy;
  rc_place place = rc_query_place(level, query, copy);
  if (place.beyond) return (rc_copy){NAN, NAN, NAN};
  return rc_copy_between(&level->chart, query->x, query->y, place.x, place.y);
}
/* How much two of a level's pixels differ by, squared, over all components. */
static inline float rc_pixels_square(uint32_t p, uint32_t q) {
  float sum = 0.f;
  for (int k = 0; k < RC_COMPONENTS; k++) {
    float off = (float)(p >> 8 * k & 255) - (float)(q >> 8 * k & 255);
    sum += off * off;
  }
  return sum;
}
/* Price of ratio and mismatch alone; RC_NO_COST outside the allowed range. */
float rc_place_price(float variance, const rc_place *place, float low, float high);
/* The level's pixel nearest to a place; false when it lies outside the picture. */
static inline bool rc_place_px(const rc_level *level, const rc_place *place, int *px, int *py) {
  float x = place->x + level->chart.x0 + .5f, y = place->y + level->chart.y0 + .5f;
  if (place->beyond ||
      !(x >= 0.f && y >= 0.f && x < (float)level->width && y < (float)level->height))
    return false;
  *px = (int)x, *py = (int)y;
  return true;
}
/* And its index. */
static inline bool rc_place_at(const rc_level *level, const rc_place *place, size_t *at) {
  int x, y;
  if (!rc_place_px(level, place, &x, &y)) return false;
  *at = (size_t)y * (size_t)level->width + (size_t)x;
  return true;
}
/* Its pixel; false when it is no source. */
static inline bool rc_place_pixel(const rc_level *level, const rc_place *place, uint32_t *pixel) {
  size_t at;
  if (!rc_place_at(level, place, &at) || !level->room[at]) return false;
  *pixel = level->pixels[at];
  return true;
}
/* The same of the copy that box pixel at has in the field. A sure line's may come from what is no
 * source any more: a marking looks unlike all the ground beside the hole. */
static inline bool rc_place_field_pixel(const rc_level *level, const rc_place *place, size_t at,
                                        uint32_t *pixel) {
  size_t source;
  if (!level->locked || level->locked[at] != RC_LOCKED_SURELY)
    return rc_place_pixel(level, place, pixel);
  if (!rc_place_at(level, place, &source) || !(level->flags[source] & RC_ALLOWED)) return false;
  *pixel = level->pixels[source];
  return true;
}

#endif
