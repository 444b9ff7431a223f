/* Which of two textures a place belongs to, or of more that lie side by side, as a pavement, a kerb
 * and a road do. What is to be filled on one side is copied from that side. Where there are no two,
 * all lies on one. */
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

#define RC_MOST_BOUNDARIES 3

/* Boundaries that are parallel in the plane, their normals to the same side, or regions, as a level
 * sees them. */
typedef struct rc_sides {
  rc_boundary boundaries[RC_MOST_BOUNDARIES]; /* the one whose place is known best first */
  int boundary_count;
  rc_regions regions;
  bool apart; /* they look different: each has sources and detail of its own */
  /* The one boundary is a thing on one ground: only near it does it matter where a place lies. */
  bool one_ground;
  float px; /* one px of the level, in px of the finest */
} rc_sides;

static inline bool rc_has_sides(const rc_sides *sides) {
  return sides->boundary_count || sides->regions.distance;
}
/* The finest level's sides at one 2^exponent times coarser. */
static inline rc_sides rc_sides_coarser(rc_sides sides, int exponent) {
  for (int i = 0; i < sides.boundary_count; i++)
    sides.boundaries[i] = rc_boundary_coarser(sides.boundaries[i], exponent);
  sides.px *= (float)(1 << exponent);
  return sides;
}
/* Of regions or one boundary from -1 to 1, 0 where they meet; each boundary more adds as much. On
 * one ground the distance. In the plane, so that what lies along a boundary has the same. */
float rc_side(const rc_sides *sides, const rc_chart *chart, float x, float y);
/* How much two places differ by that, squared: those on the two sides of one boundary, or on one
 * ground those at it and far away, by 4. */
float rc_sides_square(const rc_sides *sides, float side, float other);
/* On which side of the regions or the first boundary. */
bool rc_is_other_side(const rc_sides *sides, const rc_chart *chart, float x, float y);

#endif
