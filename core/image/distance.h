/* Chebyshev distances inside a region. */
#ifndef RECEDE_IMAGE_DISTANCE_H
#define RECEDE_IMAGE_DISTANCE_H

#include <stdbool.h>
#include <stdint.h>

/* For each pixel with that flag its distance to the nearest without (1 = touches one), at most 255;
 * 0 for the others. Beyond the picture's border counts as without when outside_ends is true. */
void rc_distance_inside(const uint8_t *flags, uint8_t flag, int width, int height,
                        bool outside_ends, uint8_t *distance);

#endif
