/* Method plane in one step: all that there is to fill, from what there is to copy from. */
#ifndef RECEDE_SYNTHESIS_FILL_PLANE_H
#define RECEDE_SYNTHESIS_FILL_PLANE_H

#include "synthesis/problem.h"

/* Target pixels that no source is right for. */
typedef struct rc_shortfall {
  uint8_t *rest; /* in: of each pixel of the problem, 0; out: 1 for those, 2 for missing ones */
  uint64_t continued; /* too small or too large for any: they go on what is beside them */
  uint64_t missing;   /* have the smooth tone alone */
} rc_shortfall;

struct rc_known_rails; /* of structure/rails.h */

/* As problem.h says of all methods. restored: known pixels are as before, but for rounding; else
 * they are spoiled. Adds to what the report has of magnified pixels, those of the rest left out.
 * known: the rails are taken from there if they run, and else looked for and put there, with
 * whether the fill kept to them. */
recede_status rc_fill_plane(rc_context *context, const rc_problem *problem,
                            const recede_params *params, bool restored, rc_image *filled,
                            rc_shortfall *shortfall, struct rc_known_rails *known);

#endif
