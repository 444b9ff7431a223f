/* What was made, written into the caller's view. */
#ifndef RECEDE_SYNTHESIS_RESULT_H
#define RECEDE_SYNTHESIS_RESULT_H

#include "image/shrink.h"
#include "synthesis/problem.h"

/* The least that a fill may be: copies that are joined in the gradient domain, or relit, may get
 * darker than black, but where nothing that is known is negative, as light is, they must not. 0 or
 * what is less of the known pixels; (x0, y0): where the problem's (0, 0) is in the view. */
float rc_least_known(const recede_view *image, const rc_problem *problem, int x0, int y0);
/* The picture, bit for bit, with the fill laid over it by the mask's value. */
void rc_write_fill(const rc_views *views, const rc_problem *problem, const rc_image *filled,
                   const recede_view *result);
/* Everything that was made, no less than that. Pixels without a flag are beyond the horizon:
 * transparent or black; flags NULL: there are none. */
void rc_write_synthesis(const rc_image *made, const rc_mask *flags, float least,
                        const recede_view *result);
/* The exemplar's own pixels over it, bit for bit. */
void rc_write_exemplar(const recede_view *exemplar, const rc_problem *problem,
                       const recede_view *result);

#endif
