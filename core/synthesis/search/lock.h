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
/* A marking of which the whole width is told comes into the hole by its own pieces only: where it
 * goes on beside the hole RC_SOURCE becomes RC_TAKEN at all levels, if that is no large part of
 * them. chart: of the finest. any: some was taken. */
recede_status rc_lines_take(rc_context *context, const rc_crossing *lines, int count,
                            const rc_chart *chart, const rc_mask *flags, int levels, bool *any);
/* For what is filled later, from the same flags. */
void rc_lines_give_back(const rc_mask *flags);
/* Sets the finest level's field, and laid, where rows cross the hole, when all else is done: what
 * is copied around them has no dashes. */
recede_status rc_dash_rows_lay(rc_context *context, const rc_dash_rows *rows, rc_level *finest);

#endif
