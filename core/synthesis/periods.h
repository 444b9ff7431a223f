/* The displacements at which a texture repeats in its plane: bricks, tiles, planks. */
#ifndef RECEDE_SYNTHESIS_PERIODS_H
#define RECEDE_SYNTHESIS_PERIODS_H

#include "synthesis/level.h"

#define RC_MOST_PERIODS 60

/* Peaks of the masked correlation of the level's sources with themselves, displaced in the plane;
 * strongest first, each with its opposite. Flat copies, in this level's px. repetition: by how
 * much the correlation rises again, at the most, from the least on the way to one of them. */
recede_status rc_find_periods(rc_context *context, const rc_level *level, uint64_t key,
                              rc_copy periods[RC_MOST_PERIODS], int *count, float *repetition);

#endif
