/* What is regular, all that there is coming again both ways, or one way in a row, needs no more
 * than its periods. What lies beside a square of a chess board is another one's, so nothing is
 * foreign to it; and a start by patches, which see less than a square, goes on with one where the
 * next is due. */
#ifndef RECEDE_SYNTHESIS_SEARCH_REGULAR_H
#define RECEDE_SYNTHESIS_SEARCH_REGULAR_H

#include "synthesis/search/periods.h"

/* What rc_find_periods tells of the coarsest level's sources, in its px. images and flags: the
 * pyramid's levels, finest first; shorter_px, chart: the finest level's; gain: byte = value * gain
 * + 128. */
recede_status rc_periods_of_all(rc_context *context, const rc_image *images, const rc_mask *flags,
                                int levels, int shorter_px, const rc_chart *chart, float gain,
                                uint64_t key, rc_periods *periods);
/* Widens the ranges of scale until they hold, of each target pixel, the source nearest in scale
 * that such a move, by periods or along rails, leads to. */
recede_status rc_reach_moves(rc_context *context, rc_level *level, const rc_copy *moves, int count);
/* Moves by whole periods, the context's. */
recede_status rc_moves_by_periods(rc_context *context, const rc_periods *periods,
                                  const rc_copy **moves, int *count);

#endif
