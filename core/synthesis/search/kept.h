/* Whether a guide continues the lines that cross the hole. */
#ifndef RECEDE_SYNTHESIS_SEARCH_KEPT_H
#define RECEDE_SYNTHESIS_SEARCH_KEPT_H

#include "synthesis/search/level.h"
#include "synthesis/structure/lines.h"

/* How much of the lines' contrast on the hole's border the level's guide has in the hole, 0..1: the
 * mean over them. A line too short to be measured at this level counts as kept. */
recede_status rc_lines_kept(rc_context *context, const rc_level *level, const rc_crossing *lines,
                            int count, int exponent, double *kept);

#endif
