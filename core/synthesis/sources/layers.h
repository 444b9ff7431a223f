/* Layers: most pictures are taken upright, and what they show lies in layers, sky over houses over
 * ground, a wall over a floor. Where no plane recedes nothing else says how high in the picture a
 * thing may lie. */
#ifndef RECEDE_SYNTHESIS_SOURCES_LAYERS_H
#define RECEDE_SYNTHESIS_SOURCES_LAYERS_H

#include "image/tone.h"

/* The price, in units of the texture's variance, of a copy from as much higher or lower as the
 * hole's longer side is, and by the square of that; 0 where around the hole colours do not change
 * faster upwards than sideways. image and flags: the coarsest level, 2^exponent times coarser than
 * the finest, without the tone. */
recede_status rc_layers_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                             int exponent, const rc_tone *tone, float *price);

#endif
