/* How far around the hole is copied from. A photo is seldom one texture: what is near goes on as
 * the hole does, under the same light; farther off lie other roofs and the water beside the pier.
 */
#ifndef RECEDE_SYNTHESIS_SOURCES_NEAR_H
#define RECEDE_SYNTHESIS_SOURCES_NEAR_H

#include "image/image.h"
#include "image/line.h"

/* Takes RC_SOURCE from pixels outside a window about target, the bounding box of RC_TARGET; none if
 * the whole picture is no more than the window should be. It is wide enough to hold, if the picture
 * does, as many places for patches of the hole's own scales (band) as a fill needs. */
recede_status rc_keep_near(rc_context *context, const rc_mask *flags, const rc_box *target,
                           const rc_band *band);

#endif
