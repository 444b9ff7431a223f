/* What lies right beside the hole, read on its own: in a street it may lie in a wall, while most of
 * the picture is floor. */
#ifndef RECEDE_PLANE_NEARBY_H
#define RECEDE_PLANE_NEARBY_H

#include "base/context.h"
#include "plane/readings.h"

/* What the cells beside what is meant say of a plane; 1 and 0 where they say nothing. picture: its
 * reference lies beside what is meant. */
recede_status rc_nearby_ask(rc_context *context, const rc_homogeneity *picture, rc_lean lean,
                            rc_beside *beside);
/* flat: the whole picture's, its reference beside what is meant. *lean and *confidence hold its
 * reading, of a raised texture or a flat one; where the cells nearby contradict it, and are surer,
 * they get theirs. */
recede_status rc_nearby_correct(rc_context *context, const rc_homogeneity *flat, bool raised,
                                rc_lean *lean, double *confidence);

#endif
