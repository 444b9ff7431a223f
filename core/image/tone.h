/* The tone: brightness and colour that drift evenly across a picture. Textures are compared and
 * copied without it, so that the light stays where it is. */
#ifndef RECEDE_IMAGE_TONE_H
#define RECEDE_IMAGE_TONE_H

#include "image/image.h"
#include "image/line.h"

#define RC_TONE_TERMS 6 /* 1, x, y, x^2, x y, y^2 */

/* A quadratic in x and y, both scaled to -1..1 over the picture and held within the box of the
 * sources: a trend says nothing about what lies outside. */
typedef struct rc_tone {
  double terms[3][RC_TONE_TERMS];
  rc_box box;
  double middle_x, middle_y, half_width, half_height;
  int channels;
} rc_tone;

/* Least squares over the SOURCE pixels of the band, or where it holds none over all. Where that
 * explains a good part of their variance one is fitted to what neighbouring places differ by, too,
 * steps left out, and taken if it explains more of that. Of trends that are coloured only what lies
 * along the mean colour stays. The trend is used where it explains some of the differences between
 * neighbouring places, as a step between two things does not, and does no harm beside the TARGET
 * pixels, nor to what lies right around them; and, if these lie mostly beyond the sources, where it
 * explains nearly all that differs from place to place. Else, and with drift false, the tone is the
 * sources' mean. */
recede_status rc_tone_fit(rc_context *context, const rc_image *image, const rc_mask *flags,
                          const rc_band *band, bool drift, rc_tone *tone);
bool rc_tone_drifts(const rc_tone *tone);
/* The terms of the quadratic at a pixel, and what a channel is by such terms. */
void rc_tone_terms(const rc_tone *tone, int x, int y, double terms[RC_TONE_TERMS]);
double rc_tone_value(const rc_tone *tone, int channel, const double terms[RC_TONE_TERMS]);
/* The tone's channels at a pixel. */
void rc_tone_at(const rc_tone *tone, int x, int y, double values[3]);
/* Adds sign * tone to the pixels with that flag. */
recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image);

#endif
