/* What readings of the plane are believed by, of the whole picture and beside a hole. */
#ifndef RECEDE_PLANE_BELIEF_H
#define RECEDE_PLANE_BELIEF_H

#include <math.h>

#include "plane/lean.h"

/* A misfit that halves the confidence. Measured on drawn cases, where errors above 8 degrees began
 * at .95, and on photos of several planes: 2. */
#define RC_LARGE_MISFIT 1.15
/* Pictures show floors more often than ceilings: between readings, not within one, a ceiling must
 * explain this much more. From .25 to .4 all photos' skies stay up, and drawn ceilings are read. */
#define RC_CEILING_COST .3

/* A plane explains much that a frontal one does not, or it is read into what has no plane: it is
 * doubted from the first of these parts of the frontal plane's cost on, and by RC_DOUBT from the
 * second on, by which no wrong one of confidence 1 is believed. */
#define RC_HARDLY_BETTER .89
#define RC_NO_BETTER_TO_TELL .93
#define RC_DOUBT .6

static inline double rc_cost_of_ceiling(rc_lean lean) {
  return 1 + RC_CEILING_COST * rc_lean_ceiling(lean);
}

/* 1 at 0, a half at half. */
static inline double rc_falling(double value, double half) {
  return 1 / (1 + (value / half) * (value / half));
}
/* 0 up to from, 1 from to on. */
static inline double rc_rising(double value, double from, double to) {
  return fmin(1, fmax(0, (value - from) / (to - from)));
}
/* How little a plane explains that a frontal one does not: 0..1. */
static inline double rc_explains_little(double cost, double frontal) {
  return rc_rising(cost / frontal, RC_HARDLY_BETTER, RC_NO_BETTER_TO_TELL);
}

#endif
