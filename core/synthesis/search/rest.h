/* What the search could not reach: pixels so near the horizon, or the viewer, that no whole patch
 * of the source covers theirs. */
#ifndef RECEDE_SYNTHESIS_SEARCH_REST_H
#define RECEDE_SYNTHESIS_SEARCH_REST_H

#include "synthesis/search/level.h"

/* Gives each target pixel without a copy that of a neighbour, as long as it leads to a source, else
 * one from the sources nearest to its size. *count: how many there were; marked, of each pixel of
 * the level: becomes 1 for them, NULL = not asked for. */
recede_status rc_continue_rest(rc_context *context, rc_level *level, uint64_t key, uint8_t *marked,
                               uint64_t *count);
/* What is laid continues nothing: takes it from what is marked, and its count. */
void rc_rest_forget_laid(const rc_level *finest, uint8_t *marked, uint64_t *count);

#endif
