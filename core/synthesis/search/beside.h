/* What is near the horizon: a coarse level's patches are too large there, or reach across it, but
 * beside the hole the same depth is to be seen. */
#ifndef RECEDE_SYNTHESIS_SEARCH_BESIDE_H
#define RECEDE_SYNTHESIS_SEARCH_BESIDE_H

#include "synthesis/search/level.h"

/* What a coarser level could copy only from what is much nearer, or not at all, gets what lies
 * beside it along the horizon, as far away, if that is source. whole: only if all of its patch is;
 * for a level that has been seen, before it is searched. Else it first goes on as its neighbours
 * do. */
recede_status rc_take_beside(rc_context *context, rc_level *level, uint64_t key, bool whole);

#endif
