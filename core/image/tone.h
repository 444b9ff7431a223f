/* The tone: the smooth brightness and colour of a picture, continued through what is to be filled.
 * Textures are compared and copied without it, so that light that drifts across a photo stays where
 * it is. */
#ifndef RECEDE_IMAGE_TONE_H
#define RECEDE_IMAGE_TONE_H

#include "image/image.h"

typedef struct rc_tone {
  rc_image base; /* one px for each factor x factor px */
  int factor;
} rc_tone;

/* A Gaussian of sigma px over the KNOWN pixels; where they are far, ever wider ones take over.
 * smooth false: the mean alone. */
recede_status rc_tone_new(rc_context *context, const rc_image *image, const rc_mask *flags,
                          float sigma, bool smooth, rc_tone *tone);
void rc_tone_at(const rc_tone *tone, int x, int y, float *value);
/* Adds sign * tone to the pixels with that flag. */
recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image);

#endif
