/* A start of few whole copies: those that together go on best from what lies around the hole. A
 * start by patches sees a few pixels at a time; this one sees which shift of the plane carries a
 * whole side of the hole on, as a chimney's edge or a row of tiles. */
#ifndef RECEDE_SYNTHESIS_SEARCH_WHOLE_H
#define RECEDE_SYNTHESIS_SEARCH_WHOLE_H

#include "synthesis/search/search.h"

/* So many copies are compared, not all there are: several starts differ. */
#define RC_WHOLE_CANDIDATES 2000

/* Gives every target pixel that is not locked one of at most `copies` copies, and the guide its
 * pixel; a = NAN where none of them has one. Costs are not known yet. The copies come from
 * moves, the first RC_WHOLE_CANDIDATES of them, or where there are none from chance sources. */
recede_status rc_start_whole(rc_context *context, rc_level *level, uint64_t key,
                             const rc_copy *moves, int move_count, int copies);

#endif
