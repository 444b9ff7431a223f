/* Profiles across a line: what it looks like, wherever it is looked at. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_PROFILE_H
#define RECEDE_SYNTHESIS_STRUCTURE_PROFILE_H

#include "synthesis/structure/seen.h"

/* So many samples. */
#define RC_PROFILE_HALF 3
#define RC_PROFILE (2 * RC_PROFILE_HALF + 1)

/* Where a line's profile begins outside the hole. */
#define RC_PROFILE_FROM_PX 2.f
/* A line's own profile is that of so many px. */
#define RC_PROFILE_NEAR_PX 14

/* A line in a picture. */
typedef struct rc_ruler {
  const rc_seen *picture;
  float ux, uy;          /* the line's direction, a unit vector */
  const rc_chart *chart; /* of the same level: samples are w px apart; NULL: 1 px */
} rc_ruler;

/* The picture's brightness at (x, y), bilinear. False: not all of it can be seen. */
bool rc_ruler_sample(const rc_ruler *ruler, float x, float y, float *value);

/* How far from each other samples across lie at (x, y). */
float rc_ruler_px(const rc_chart *chart, float x, float y);
/* The mean, so many samples across, of count samples at (x, y) + u (from + k step). False: fewer
 * than a third of them could be seen. */
bool rc_ruler_mean(const rc_ruler *ruler, float x, float y, float across, float from, float step,
                   int count, float *mean);

typedef struct rc_profile {
  float mean[RC_PROFILE]; /* without their mean, */
  float tone;             /* which is this */
} rc_profile;

/* The mean of count profiles there. */
bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     rc_profile *profile);
float rc_profile_dot(const rc_profile *a, const rc_profile *b);
/* Whether they correlate by more than that, and neither has so many times the other's amplitude. */
bool rc_profiles_alike(const rc_profile *a, const rc_profile *b, float least_likeness,
                       float most_unlike);

#endif
