/* The displacements at which a texture repeats in its plane: bricks, tiles, planks. */
#ifndef RECEDE_SYNTHESIS_SEARCH_PERIODS_H
#define RECEDE_SYNTHESIS_SEARCH_PERIODS_H

#include "synthesis/search/level.h"

#define RC_MOST_PERIODS 60

/* Peaks of the masked correlation of the level's sources with themselves, displaced in the plane;
 * strongest first, each with its opposite. Flat copies, in this level's px. repeats: the
 * same piece twice is natural, or not seen. */
recede_status rc_find_periods(rc_context *context, const rc_level *level, uint64_t key,
                              rc_copy periods[RC_MOST_PERIODS], int *count, bool *repeats);

#endif
