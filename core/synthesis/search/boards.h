/* Which board each pixel of a level belongs to, where all boards have one width. */
#ifndef RECEDE_SYNTHESIS_SEARCH_BOARDS_H
#define RECEDE_SYNTHESIS_SEARCH_BOARDS_H

#include "synthesis/search/level.h"
#include "synthesis/structure/rails.h"

/* Sets level->board where rails, of the finest level, have a gauge. */
recede_status rc_boards_mark(rc_context *context, const rc_rails *rails, int exponent,
                             rc_level *level);

#endif
