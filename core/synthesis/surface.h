/* Is the texture painted on the plane, or does it stand up from it? */
#ifndef RECEDE_SYNTHESIS_SURFACE_H
#define RECEDE_SYNTHESIS_SURFACE_H

#include "synthesis/problem.h"

/* Lines painted on the plane lean towards its vanishing point, the more the farther aside they are;
 * stones, grass and waves stand upright everywhere. *lean gets how much of the plane's lean the
 * sources' gradients show, by regression: 1 flat, 0 raised, and *error its standard error. *lean is
 * NAN where the plane leans too little to tell (then it does not matter). */
recede_status rc_measure_lean(rc_context *context, const rc_problem *problem, const rc_image *image,
                              const rc_mask *flags, int exponent, double *lean, double *error);

#endif
