/* What was made, written into the caller's view. */
#ifndef RECEDE_SYNTHESIS_RESULT_H
#define RECEDE_SYNTHESIS_RESULT_H

#include "image/shrink.h"
#include "synthesis/problem.h"

/* The picture, bit for bit, with the fill laid over it by the mask's value. */
void rc_write_fill(const rc_views *views, const rc_problem *problem, const rc_image *filled,
                   const recede_view *result);
/* Everything that was made. Pixels without a flag are beyond the horizon: transparent or black;
 * flags NULL: there are none. */
void rc_write_synthesis(const rc_image *made, const rc_mask *flags, const recede_view *result);
/* The exemplar's own pixels over it, bit for bit. */
void rc_write_exemplar(const recede_view *exemplar, const rc_problem *problem,
                       const recede_view *result);

#endif
