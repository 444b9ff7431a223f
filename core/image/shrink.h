/* A picture of any size as a small one to look at: what orientation is read from. */
#ifndef RECEDE_IMAGE_SHRINK_H
#define RECEDE_IMAGE_SHRINK_H

#include "image/image.h"

typedef struct rc_views {
  const recede_view *image, *mask, *source; /* mask and source may be NULL */
} rc_views;

/* What the count pixels of row y from x on are (image.h), from their values (channels of the image,
 * interleaved) and the mask and source rows; scratch holds count floats. Returns how many pixels
 * that matter were not finite or beyond +-1e9. */
int rc_classify_row(const rc_views *views, int x, int y, int count, const float *values,
                    float *scratch, uint8_t *flags);

/* Averages blocks of factor x factor px over their KNOWN pixels; a block is TARGET if any pixel is,
 * SOURCE if all are. Colour only. */
recede_status rc_shrink(rc_context *context, const rc_views *views, int factor, rc_image *image,
                        rc_mask *flags);

#endif
