/* How blurred a place is, where depth of field differs over a photo. */
#ifndef RECEDE_SYNTHESIS_SOURCES_FOCUS_H
#define RECEDE_SYNTHESIS_SOURCES_FOCUS_H

#include "image/image.h"

/* Of cells of 2^exponent px of the finest level, octaves: 0 is sharp. images and flags: the
 * pyramid's levels, finest first; of two alone nothing is told. cells: what any of a cell's pixels
 * is; in the TARGET the blur is what lies around it, evenly between, and where nothing is to be
 * copied it is 0. differs: it is not the same, or nearly, wherever copies come from or go to. */
recede_status rc_focus_measure(rc_context *context, const rc_image *images, const rc_mask *flags,
                               int levels, const rc_mask *cells, int exponent, float *blur,
                               bool *differs);

#endif
