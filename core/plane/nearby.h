/* What lies right beside the hole, read on its own: in a street it may lie in a wall, while most of
 * the picture is floor. */
#ifndef RECEDE_PLANE_NEARBY_H
#define RECEDE_PLANE_NEARBY_H

#include "base/context.h"
#include "plane/homogeneity.h"

/* flat: the whole picture's, its reference beside what is meant. *lean and *confidence hold its
 * reading, of a raised texture or a flat one; where the cells nearby contradict it, they get
 * theirs.
 */
recede_status rc_nearby_correct(rc_context *context, const rc_homogeneity *flat, bool raised,
                                rc_lean *lean, double *confidence);

#endif
