/* Whether a texture repeats along a line: bricks, tiles and steps do. Their joints would break if
 * each line were moved by itself. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_REPEATS_H
#define RECEDE_SYNTHESIS_STRUCTURE_REPEATS_H

#include "synthesis/structure/crossing.h"
#include "synthesis/structure/sides.h"

/* Near the hole, for from one rail of a pier to the other its texture seems to; along the unit
 * vector (a, b). image, flags, chart: of the coarsest level. */
recede_status rc_repeats_near(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const rc_chart *chart, float a, float b, bool *repeats);
/* On one side of the boundary, px of the finest level: that where (x, y) lies. images and masks:
 * the pyramid's levels, finest first; chart: of the finest. */
recede_status rc_repeats_beside(rc_context *context, const rc_image *images, const rc_mask *masks,
                                int levels, const rc_chart *chart, const rc_crossing *line,
                                const rc_boundary *boundary, float x, float y, bool *repeats);

#endif
