/* How far below the horizon is the plane hidden by what stands on it? */
#ifndef RECEDE_SYNTHESIS_STANDING_H
#define RECEDE_SYNTHESIS_STANDING_H

#include "synthesis/copy.h"
#include "synthesis/problem.h"

/* Cars, railings and houses have upright edges. Near the horizon a plane has hardly any, for it is
 * seen so flat there, and its lines lead to the vanishing point. *standing_w gets the w below which
 * upright edges beside the hole are a good part of all, 0 where there are none or the hole does not
 * reach there. image, flags: of level exponent; finest: the chart of level 0. */
recede_status rc_measure_standing(rc_context *context, const rc_problem *problem,
                                  const rc_image *image, const rc_mask *flags, int exponent,
                                  const rc_chart *finest, float *standing_w);

#endif
