/* Moves texture in along lines and holds it there; and whole dashes. */
#ifndef RECEDE_SYNTHESIS_SEARCH_LOCK_H
#define RECEDE_SYNTHESIS_SEARCH_LOCK_H

#include "synthesis/search/level.h"
#include "synthesis/structure/dash_rows.h"
#include "synthesis/structure/lines.h"

/* Sets the field along the lines and marks it in level->locked, which is made for it: start and
 * search leave it alone. */
recede_status rc_lines_lock(rc_context *context, const rc_crossing *lines, int count, int exponent,
                            rc_level *level);
/* A marking comes into the hole by its own pieces only: takes RC_SOURCE from
 * where it goes on to both sides. chart and flags: of a level 2^exponent times coarser than the
 * finest, of which the lines are. */
void rc_lines_take(const rc_crossing *lines, int count, int exponent, const rc_chart *chart,
                   const rc_mask *flags);
/* Sets the finest level's field, and laid, where rows cross the hole, when all else is done: what
 * is copied around them has no dashes. */
recede_status rc_dash_rows_lay(rc_context *context, const rc_dash_rows *rows, rc_level *finest);

#endif
