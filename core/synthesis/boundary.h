/* Where two textures meet in a straight line that crosses the hole: a road and its verge, a wall
 * and the roof it stands on. The line is moved in as other lines are, and what lies to one side of
 * it is copied from that side. */
#ifndef RECEDE_SYNTHESIS_BOUNDARY_H
#define RECEDE_SYNTHESIS_BOUNDARY_H

#include "synthesis/lines.h"

/* Looks for one and makes it the only line; without one lines and *count stay, and the boundary is
 * all 0. images and masks: the pyramid's levels, finest first; chart: of the finest. */
recede_status rc_boundary_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                               int levels, const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                               int *count, rc_boundary *boundary);

/* The boundary, px of the finest level relative to its chart's origin, at another level. */
rc_boundary rc_boundary_coarser(rc_boundary boundary, int exponent);

#endif
