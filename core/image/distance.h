/* Chebyshev distances inside a region. */
#ifndef RECEDE_IMAGE_DISTANCE_H
#define RECEDE_IMAGE_DISTANCE_H

#include "base/context.h"
#include "image/image.h"

/* For each pixel with that flag its distance to the nearest without (1 = touches one), at most 255;
 * 0 for the others. Beyond the picture's border counts as without when outside_ends is true. */
void rc_distance_inside(const uint8_t *flags, uint8_t flag, int width, int height,
                        bool outside_ends, uint8_t *distance);

/* Whether any pixel with that flag has such a distance, 1 or more; beyond the picture's border
 * counts as with it. Stops at the first. */
recede_status rc_is_deep(rc_context *context, const rc_mask *flags, uint8_t flag, int px,
                         bool *deep);

#endif
