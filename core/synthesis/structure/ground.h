/* The plane as it lies: places on it whose distances and angles are true, as a chart's are not. In
 * px across the tilt where w = 1, of the finest level. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_GROUND_H
#define RECEDE_SYNTHESIS_STRUCTURE_GROUND_H

#include <math.h>
#include <stdbool.h>

#include "synthesis/copy.h"

typedef struct rc_ground {
  double lx, ly, x0, y0; /* the chart's */
  double from_x, from_y; /* where that lies from the picture's middle, px */
  double focal_px;
  double a, b, c; /* of p = X / w: u = a px + b py, v = c py */
} rc_ground;

/* The C library's hypot chooses other code by processor. */
static inline double rc_distance(double x, double y) { return sqrt(x * x + y * y); }

/* chart: of the finest level. */
rc_ground rc_ground_of(const rc_chart *chart, double from_x, double from_y, double focal_px);
/* The plane turned: w grows by this part for each px along the unit vector (along_u, along_v). */
rc_ground rc_ground_turned(const rc_ground *ground, double by, double along_u, double along_v);
/* The same plane with its horizon nearer, by this factor. */
rc_ground rc_ground_tilted(const rc_ground *ground, double times);
/* Where a px of a level 2^exponent times coarser lies, and its w. False: beyond the horizon. */
bool rc_ground_place(const rc_ground *ground, int exponent, double x, double y, double *u,
                     double *v, double *w);
/* And back. False also where that is farther away than any picture is large. */
bool rc_ground_px(const rc_ground *ground, int exponent, double u, double v, double *x, double *y,
                  double *w);

#endif
