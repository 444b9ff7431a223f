/* Finds the lattice of a texture: its periods, and how they bend. */
#ifndef RECEDE_SYNTHESIS_SEARCH_LATTICE_FIND_H
#define RECEDE_SYNTHESIS_SEARCH_LATTICE_FIND_H

#include "synthesis/search/level.h"

/* From the periods, as rc_find_periods tells them, and the known pixels of this, the coarsest
 * level. bends: what the lattice then points to. */
recede_status rc_lattice_find(rc_context *context, const rc_level *level, const rc_copy *periods,
                              int period_count, rc_bends *bends, rc_lattice *lattice);

#endif
