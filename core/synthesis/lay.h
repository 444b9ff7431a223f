/* An exemplar seen from the front, as the result's camera sees it lying on the plane. */
#ifndef RECEDE_SYNTHESIS_LAY_H
#define RECEDE_SYNTHESIS_LAY_H

#include "image/shrink.h"
#include "synthesis/problem.h"

/* The point where the picture's middle line along the tilt reaches its border on the viewer's side:
 * there the exemplar begins, and a pixel of it is one of the result across. Where the plane comes
 * nearer still, in a corner, it is magnified. */
void rc_lay_anchor(const recede_plane *plane, double *x, double *y);
/* exemplar: flags say what of it is KNOWN and SOURCE; its other pixels are overwritten. Writes the
 * pixels it covers into the problem's image, and what they are into its flags; the others become
 * TARGET. Sets its least. The plane is the problem's; it must recede, and its w be above 0 at the
 * anchor. */
recede_status rc_lay(rc_context *context, const rc_image *exemplar, const rc_mask *flags,
                     rc_problem *problem);

#endif
