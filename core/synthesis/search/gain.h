/* How values become the bytes that the search compares: byte = value * gain + 128. */
#ifndef RECEDE_SYNTHESIS_SEARCH_GAIN_H
#define RECEDE_SYNTHESIS_SEARCH_GAIN_H

#include "image/image.h"

/* Bytes span this many standard deviations to each side. */
#define RC_GAIN_DEVIATIONS 4.f

/* By the sources, whose mean is 0; 1 where they are all the same. */
recede_status rc_find_gain(rc_context *context, const rc_image *residual, const rc_mask *flags,
                           float *gain);

#endif
