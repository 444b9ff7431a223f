/* What is regular, its squares or windows larger than what patches see: a start by patches goes on
 * with one square where the next is due. So whole copies are tried that move it by its periods. */
#ifndef RECEDE_SYNTHESIS_SEARCH_REGULAR_H
#define RECEDE_SYNTHESIS_SEARCH_REGULAR_H

#include "synthesis/search/periods.h"

/* Widens the ranges of scale until they hold, of each target pixel, the source nearest in scale
 * that lies whole periods away. */
void rc_reach_periods(rc_level *level, const rc_periods *periods);
/* Moves by whole periods, and beside them, for they are not known so exactly; the context's. */
recede_status rc_moves_by_periods(rc_context *context, const rc_periods *periods,
                                  const rc_copy **moves, int *count);

#endif
