/* The start at the coarsest level: the hole is peeled from its border inwards, each pixel taking
 * the copy that continues best what is already there. */
#ifndef RECEDE_SYNTHESIS_SEARCH_START_H
#define RECEDE_SYNTHESIS_SEARCH_START_H

#include "synthesis/search/search.h"

/* Fills level->field, cost and the guide. search gives kernels, key, coherence, periods, and in
 * `anywhere` the random candidates per pixel. Pixels that no source fits keep a NAN copy. */
recede_status rc_start(rc_context *context, rc_level *level, const rc_search *search);

#endif
