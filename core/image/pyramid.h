/* Pictures at half the size. */
#ifndef RECEDE_IMAGE_PYRAMID_H
#define RECEDE_IMAGE_PYRAMID_H

#include "image/image.h"

/* A side of so many px, halved so many times. */
static inline int rc_halved(int px, int times) { return (px + (1 << times) - 1) >> times; }
/* [1 3 3 1] / 8 in x and y over the KNOWN pixels. A coarse pixel is TARGET if any of its four is,
 * KNOWN or SOURCE if all four are. Sizes round up; what lies beyond the border repeats it. */
recede_status rc_half(rc_context *context, const rc_image *image, const rc_mask *flags,
                      rc_image *half_image, rc_mask *half_flags);

/* The same in parts. Of count rows (or columns) the j-th of the four that make the half's y-th. */
int rc_half_from(int y, int j, int count);
/* The half's x-th pixel from four rows of 1..3 channels, which start at column first of the width,
 * and their flags, which start at column 0. */
void rc_half_pixel(const float *const rows[4], int first, const uint8_t *const flags[4], int width,
                   int channels, int x, float *out);

#endif
