/* Lines that the parallel ones leave out: those that cross them, joints that end at another one,
 * two that meet in the hole, as slabs' do, and what leaves the picture. Only what is no chance, and
 * no joint of many: those keep in order by themselves, and moved in alone break the ones that cross
 * them. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_BRANCHES_H
#define RECEDE_SYNTHESIS_STRUCTURE_BRANCHES_H

#include "synthesis/structure/lines.h"

/* Adds them to the lines, px of the finest level, of which chart is. Of one that ends in the hole a
 * is there, and b at the border. image and mask: the level rc_lines_level says, 2^exponent times
 * coarser. */
recede_status rc_branches_add(rc_context *context, const rc_image *image, const rc_mask *mask,
                              int exponent, const rc_chart *chart, rc_crossing lines[RC_ALL_LINES],
                              int *count);
/* Adds clear ones that stand alone and leave the picture where the hole does, or behind it, too
 * near to be seen there: markings that lead to the viewer; or that get too narrow to be seen in the
 * hole, as those that lead to the horizon. Of these a is there. The rest as above. */
recede_status rc_leaving_add(rc_context *context, const rc_image *image, const rc_mask *mask,
                             int exponent, const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                             int *count);

#endif
