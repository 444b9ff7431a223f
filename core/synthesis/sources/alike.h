/* What may be copied: sources that look like something beside the hole. Elsewhere in a photo lie
 * walls, windows, bare ground; they are even, so that averages of anything fit them, and without
 * this a hole among roof tiles gets a piece of wall. */
#ifndef RECEDE_SYNTHESIS_SOURCES_ALIKE_H
#define RECEDE_SYNTHESIS_SOURCES_ALIKE_H

#include "image/image.h"
#include "image/line.h"

/* Takes RC_SOURCE from pixels that look like nothing beside the hole, where all stays: of what is
 * there only some is looked at, and that may miss a post. band: where the hole's own
 * scales are, of the finest level; images and flags: the pyramid's levels, finest first; what is
 * unlike is found at the coarsest. Where too few of the hole's own scales would be left only the
 * most unlike goes; all stay where too little beside the hole is source. taken: the part of the
 * sources that lost it. */
recede_status rc_keep_alike(rc_context *context, const rc_band *band, const rc_image *images,
                            const rc_mask *flags, int levels, double *taken);

#endif
