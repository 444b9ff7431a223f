/* Which kinds of copies a fill has: flat ones, raised ones, or both. */
#ifndef RECEDE_SYNTHESIS_KINDS_H
#define RECEDE_SYNTHESIS_KINDS_H

#include "synthesis/copy.h"
#include "synthesis/problem.h"

/* As asked for, or by what the sources show; *raised stays as it is where nothing can be told.
 * images and masks: the pyramid's levels, finest first. */
recede_status rc_choose_surface(rc_context *context, const rc_problem *problem,
                                const rc_image *images, const rc_mask *masks, int levels,
                                recede_surface asked, bool *raised);
/* Of a flat plane, up to where things stand on it: standing_w of the finest level's chart. */
recede_status rc_find_standing(rc_context *context, const rc_problem *problem,
                               const rc_image *images, const rc_mask *masks, int levels,
                               rc_chart *chart);

#endif
