/* What has colours that nothing near the hole has: people on cobble or beside a sharp edge, whose
 * contrast is such that they are no spots (spots.h). */
#ifndef RECEDE_SYNTHESIS_SOURCES_STRANGERS_H
#define RECEDE_SYNTHESIS_SOURCES_STRANGERS_H

#include "image/image.h"
#include "image/line.h"

/* Takes RC_SOURCE from small things of such colours, as rc_keep_alike does from what is unlike. */
recede_status rc_drop_strangers(rc_context *context, const rc_band *band, const rc_image *images,
                                const rc_mask *flags, int levels);

#endif
