/* The orientation that a run's parameters ask for: converted, or read from the picture. */
#ifndef RECEDE_ORIENTATION_H
#define RECEDE_ORIENTATION_H

#include "image/shrink.h"

/* width x height: the frame that the orientation is of, the picture's own or (synthesis) a larger
 * one with the picture in its middle. on: a point of the frame that lies on the plane; where it is
 * told by a mask, views->mask is there. */
recede_status rc_resolve_orientation(rc_context *context, const recede_params *params,
                                     const rc_views *views, int width, int height,
                                     const double on[2], recede_orientation *orientation);
/* The same for a run: an estimate that cannot be trusted gives way to the frontal orientation, and
 * that is said. */
recede_status rc_trusted_orientation(rc_context *context, const recede_params *params,
                                     const rc_views *views, int width, int height,
                                     const double on[2], recede_orientation *orientation);

/* Upper bound of the memory that reading it from a picture of that size takes, bytes; 0 where the
 * parameters give it. */
uint64_t rc_orientation_bytes(const recede_params *params, int width, int height, int threads);

#endif
