/* The width of boards, where all have one. Then a board may also be filled from others, and does
 * not mind what those beside it look like: their ends lie anywhere. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_GAUGE_H
#define RECEDE_SYNTHESIS_STRUCTURE_GAUGE_H

#include "synthesis/structure/rails.h"

/* Sets the gauge, the joint and the rows of rails that run; all 0 where boards are not of one
 * width. images and masks: the pyramid's levels, finest first; chart: of the finest. */
recede_status rc_gauge_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, const rc_chart *chart, rc_rails *rails);

#endif
