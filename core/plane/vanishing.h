/* Where parallel lines of a picture meet. */
#ifndef RECEDE_PLANE_VANISHING_H
#define RECEDE_PLANE_VANISHING_H

#include "image/image.h"

/* direction: unit ray (x, y, focal) of the point, at infinity too; support: the share, by length
 * and nearness to the point that is meant, of segments that point to it; of another point, of
 * those that do not point to the ones before. */
typedef struct rc_vanishing {
  double direction[3], support;
} rc_vanishing;

#define RC_VANISHING_POINTS 3

/* The best supported vanishing points of RC_SOURCE pixels. on as in rc_estimate_plane(). */
recede_status rc_vanishing_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                                double focal_px, const double on[2],
                                rc_vanishing points[RC_VANISHING_POINTS], int *count);

#endif
