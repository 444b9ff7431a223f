/* The vote: the guide that the next search compares with, an average of what the patches that cover
 * a pixel would put there. It only guides; the picture itself is composed of whole copies. */
#ifndef RECEDE_SYNTHESIS_SEARCH_VOTE_H
#define RECEDE_SYNTHESIS_SEARCH_VOTE_H

#include "synthesis/search/level.h"

/* Replaces the target's pixels. */
recede_status rc_vote(rc_context *context, rc_level *level);
/* Takes the field of the coarser level over. */
void rc_field_from_coarser(rc_level *level, const rc_level *coarser);

#endif
