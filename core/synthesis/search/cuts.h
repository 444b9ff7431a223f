/* Where copies meet: seams are led where the copies on both sides look alike, between stones and
 * not through them, and one large copy takes what several small ones had. */
#ifndef RECEDE_SYNTHESIS_SEARCH_CUTS_H
#define RECEDE_SYNTHESIS_SEARCH_CUTS_H

#include "synthesis/search/level.h"

/* Of a hole of so many px: the largest box that is cut, px, and what each px of a box and a frame
 * of 1 px around it takes. */
static inline uint64_t rc_most_cut_box(int most_px) { return (uint64_t)most_px * 5 / 2; }
#define RC_CUT_BYTES_PER_PX 160

/* Changes the level's field, not its costs: by the guide, which the old copies made, the new ones
 * would seem bad, and the next level's first vote would hardly count them. (Where the finest level
 * is cut it settles by the old ones' costs: copies grow together, and hardly any goes back.)
 * price_uses: the same source costs more where the field takes it elsewhere, too: the same stone
 * twice is seen. */
recede_status rc_cut_copies(rc_context *context, const rc_kernels *kernels, bool price_uses,
                            rc_level *level);

#endif
