/* What stands out more than anything near the hole: people on sand, a dash on a road. Whole copies
 * of sand with a person in it fit sand as well as any, and who removes a person wants none. */
#ifndef RECEDE_SYNTHESIS_SOURCES_SPOTS_H
#define RECEDE_SYNTHESIS_SOURCES_SPOTS_H

#include "image/image.h"
#include "image/line.h"

/* Takes RC_SOURCE from such spots, as rc_keep_alike does from what is unlike. */
recede_status rc_drop_spots(rc_context *context, const rc_band *band, const rc_image *images,
                            const rc_mask *flags, int levels);

#endif
