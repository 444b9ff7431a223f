/* Profiles across a line: what it looks like, wherever it is looked at. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_PROFILE_H
#define RECEDE_SYNTHESIS_STRUCTURE_PROFILE_H

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

/* The picture's brightness at (x, y), bilinear. False: not all of it can be seen. */
bool rc_ruler_sample(const rc_ruler *ruler, float x, float y, float *value);

typedef struct rc_profile {
  float mean[RC_PROFILE]; /* without their mean, */
  float tone;             /* which is this */
} rc_profile;

/* The mean of count profiles at (x, y) + u (from + k step), sampled bilinearly. False: fewer than a
 * third of them could be seen. */
bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     rc_profile *profile);
float rc_profile_dot(const rc_profile *a, const rc_profile *b);

#endif
