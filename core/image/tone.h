/* The tone: brightness and colour that drift evenly across a picture. Textures are compared and
 * copied without it, so that the light stays where it is. */
#ifndef RECEDE_IMAGE_TONE_H
#define RECEDE_IMAGE_TONE_H

#include "image/image.h"

/* value = at + slope_x * x + slope_y * y, x and y held within the box of the sources: a trend says
 * nothing about what lies far outside. */
typedef struct rc_tone {
  double at[3], slope_x[3], slope_y[3];
  rc_box box;
  int channels;
} rc_tone;

/* Least squares over the SOURCE pixels. The trend is used where it explains a good part of their
 * variance; else, and with drift false, the tone is their mean. */
void rc_tone_fit(const rc_image *image, const rc_mask *flags, bool drift, rc_tone *tone);
/* Adds sign * tone to the pixels with that flag. */
recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image);

#endif
