/* Which of two textures a place belongs to. What is to be filled on one side is copied from that
 * side. Where there are no two, all lies on one. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_SIDES_H
#define RECEDE_SYNTHESIS_STRUCTURE_SIDES_H

#include "synthesis/copy.h"

/* A straight line between two textures: a signed distance from it in px is nx x + ny y + at, x and
 * y relative to the chart's origin; n is a unit vector, or 0 where there is no such line. */
typedef struct rc_boundary {
  float nx, ny, at;
} rc_boundary;

/* The same boundary at a level 2^exponent times coarser. */
static inline rc_boundary rc_boundary_coarser(rc_boundary boundary, int exponent) {
  boundary.at /= (float)(1 << exponent);
  return boundary;
}

static inline rc_boundary rc_other_side(rc_boundary b) {
  return (rc_boundary){-b.nx, -b.ny, -b.at};
}

/* A map of signed distances in its own px, whose first is (x0, y0); NULL where there is none. */
typedef struct rc_regions {
  const float *distance;
  int x0, y0, width, height;
  float px; /* one of its px, in px of the finest level */
} rc_regions;

/* One of them, as a level sees it. */
typedef struct rc_sides {
  rc_boundary boundary;
  rc_regions regions;
  bool apart; /* they look different: each has sources and detail of its own */
  float px;   /* one px of the level, in px of the finest */
} rc_sides;

static inline bool rc_has_sides(const rc_sides *sides) {
  return sides->boundary.nx != 0.f || sides->boundary.ny != 0.f || sides->regions.distance;
}
/* The finest level's sides at one 2^exponent times coarser. */
static inline rc_sides rc_sides_coarser(rc_sides sides, int exponent) {
  sides.boundary = rc_boundary_coarser(sides.boundary, exponent);
  sides.px *= (float)(1 << exponent);
  return sides;
}
/* From -1 to 1, 0 where they meet; in the plane, so that what lies along a boundary has the same.
 */
float rc_side(const rc_sides *sides, const rc_chart *chart, float x, float y);

#endif
