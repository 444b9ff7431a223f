/* Pictures at half the size. */
#ifndef RECEDE_IMAGE_PYRAMID_H
#define RECEDE_IMAGE_PYRAMID_H

#include "image/image.h"

/* [1 3 3 1] / 8 in x and y over the KNOWN pixels. A coarse pixel is TARGET if any of its four is,
 * KNOWN or SOURCE if all four are. Sizes round up; what lies beyond the border repeats it. */
recede_status rc_half(rc_context *context, const rc_image *image, const rc_mask *flags,
                      rc_image *half_image, rc_mask *half_flags);

#endif
