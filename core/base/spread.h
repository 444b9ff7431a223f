/* How points spread in the plane, by their second moments about their mean. */
#ifndef RECEDE_BASE_SPREAD_H
#define RECEDE_BASE_SPREAD_H

#include <math.h>
#include <stdbool.h>

typedef struct rc_spread {
  double great, little; /* the variances along the axis that is the longer, and across it */
  double x, y;          /* that axis, a unit vector */
} rc_spread;

/* False: it has no such axis, for it is the same to all sides. */
static inline bool rc_spread_of(double xx, double xy, double yy, rc_spread *spread) {
  double middle = (xx + yy) / 2, apart = sqrt((xx - yy) * (xx - yy) / 4 + xy * xy);
  double great = middle + apart, x = xx > yy ? great - yy : xy, y = xx > yy ? xy : great - xx;
  double length = sqrt(x * x + y * y);
  *spread = (rc_spread){great, fmax(middle - apart, 0), x / length, y / length};
  return length > 0;
}

#endif
