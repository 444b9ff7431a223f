/* Moves texture in along lines and holds it there. */
#ifndef RECEDE_SYNTHESIS_SEARCH_LOCK_H
#define RECEDE_SYNTHESIS_SEARCH_LOCK_H

#include "synthesis/search/level.h"
#include "synthesis/structure/lines.h"

/* Sets the field along the lines and marks it in level->locked, which is made for it: start and
 * search leave it alone. */
recede_status rc_lines_lock(rc_context *context, const rc_crossing *lines, int count, int exponent,
                            rc_level *level);

#endif
