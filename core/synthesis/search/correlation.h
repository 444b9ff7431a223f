/* The masked correlation of a level's sources with themselves, displaced in the plane, and its
 * peaks. */
#ifndef RECEDE_SYNTHESIS_SEARCH_CORRELATION_H
#define RECEDE_SYNTHESIS_SEARCH_CORRELATION_H

#include "synthesis/search/level.h"

/* What is told of a displacement that too few points share. */
#define RC_NOT_KNOWN 0.f

typedef struct rc_correlation {
  const rc_level *level;
  rc_chart flat;
  const float *trait; /* of each pixel */
  const int32_t *points;
  int count;    /* of points */
  int lag;      /* largest, px */
  float *value; /* (lag + 1) rows of 2 lag + 1 */
} rc_correlation;

typedef struct rc_peak {
  float value, x, y;
  float rise;  /* from the least on the way there; 0 where it is not inside */
  bool inside; /* of the lags looked at */
} rc_peak;

/* points: each displacement is tried at so many, chosen by the key. trait: what is correlated, of
 * each pixel. */
recede_status rc_correlation_new(rc_context *context, const rc_level *level, const float *trait,
                                 uint64_t key, int points, rc_correlation *c);
/* Of all displacements up to the lag, and its peaks, strongest first. */
recede_status rc_correlate(rc_context *context, rc_correlation *c, int lag, rc_peak **peaks,
                           int *count);
float rc_correlation_at(const rc_correlation *c, int dx, int dy);
/* What the correlation at (dx, dy) rises by from the least on the way there from (from_x, from_y):
 * a high one may be shading's alone, which drifts. */
float rc_correlation_rise(const rc_correlation *c, int from_x, int from_y, int dx, int dy);
/* Of the trait, among the points. */
double rc_correlation_variance(const rc_correlation *c);

#endif
