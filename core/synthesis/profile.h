/* Profiles across a line: what it looks like, wherever it is looked at. */
#ifndef RECEDE_SYNTHESIS_PROFILE_H
#define RECEDE_SYNTHESIS_PROFILE_H

#include <stdbool.h>

/* So many samples, 1 px apart. */
#define RC_PROFILE_HALF 3
#define RC_PROFILE (2 * RC_PROFILE_HALF + 1)

/* A line in a picture. value: the brightness of one pixel; false: it is none to look at. */
typedef struct rc_ruler {
  bool (*value)(const void *picture, int x, int y, float *value);
  const void *picture;
  float ux, uy; /* the line's direction, a unit vector */
} rc_ruler;

/* The mean of count profiles at (x, y) + u (from + k step), sampled bilinearly, its own mean taken
 * off. False: fewer than a third of them could be seen. */
bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     float mean[RC_PROFILE]);
float rc_profile_dot(const float a[RC_PROFILE], const float b[RC_PROFILE]);

#endif
