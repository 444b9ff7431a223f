/* What the search for the plane reads, and how far it can be trusted. */
#ifndef RECEDE_PLANE_READINGS_H
#define RECEDE_PLANE_READINGS_H

#include "plane/homogeneity.h"
#include "plane/simplex.h"
#include "plane/vanishing.h"

enum { RC_FLAT, RC_RAISED, RC_MODELS };

/* The best coarse orientations that are looked at closer, for each of the two models. */
#define RC_STARTS 4
/* Parts of the picture that are asked again on their own: four halves and two chequers. */
#define RC_PARTS 6
/* A plane misses half of a vanishing point that lies 3.5 degrees off it. */
#define RC_POINT_REACH .06

/* Among the cells beside what is meant: what a plane costs, as a part of what the frontal one
 * costs; how much the plane's scale differs there (standard deviation). */
typedef struct rc_beside {
  double of_frontal, octaves;
} rc_beside;

typedef struct rc_readings {
  rc_homogeneity model[RC_MODELS];
  /* support: 0..1, how far it counts. Where the third does, the plane holds it, which lies in
   * front, and one of the others, which both lie far off; else it holds the first and the second.
   */
  rc_vanishing points[RC_VANISHING_POINTS];
  float *weight;  /* of each cell */
  float *scratch; /* one a thread: rc_homogeneity_cost's, then a float for each cell */
  rc_point closer[RC_MODELS][RC_STARTS], part[RC_PARTS];
  int best_model;
  rc_point best;
  double frontal;   /* what the frontal plane costs */
  bool placed;      /* a point is meant, and what lies beside it is asked, too */
  rc_beside beside; /* what that says of the best; all 0 where nothing is asked */
} rc_readings;

static inline rc_lean rc_lean_of(const rc_point *p) { return (rc_lean){p->x, p->y}; }

/* 0: the plane holds the point; 1: it is far from that. */
static inline double rc_missed(const rc_vanishing *point, const double normal[3]) {
  const double *v = point->direction;
  double miss = (normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2]) / RC_POINT_REACH;
  return miss * miss / (1 + miss * miss);
}

/* 0: the plane holds the points that count; else how much of them it is far from. */
double rc_points_missed(const rc_readings *readings, const double normal[3]);
/* The less, the likelier such a plane is in a picture, whatever this one shows. */
double rc_times_unlikely(const rc_point *reading);
/* Of the best reading, 0..1. */
double rc_trust(const rc_readings *readings);

#endif
