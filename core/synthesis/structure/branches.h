/* Joints that end at another one: slabs, setts beside a kerb. Seen from outside such a line enters
 * the hole and does not leave it, for in it another line, which is known, crosses its way. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_BRANCHES_H
#define RECEDE_SYNTHESIS_STRUCTURE_BRANCHES_H

#include "synthesis/structure/lines.h"

#define RC_MOST_BRANCHES 16

/* All that end at one of the lines, strongest first: each from there, its a, to the hole's border,
 * its b. lines and branches: px of the finest level, of which chart is; image and mask: the level
 * rc_lines_level says, 2^exponent times coarser. */
recede_status rc_branches_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                               int exponent, const rc_chart *chart, const rc_crossing *lines,
                               int line_count, rc_crossing branches[RC_MOST_BRANCHES], int *count);

#endif
