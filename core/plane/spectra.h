/* What frequencies a picture holds, and where: its local power spectra. */
#ifndef RECEDE_PLANE_SPECTRA_H
#define RECEDE_PLANE_SPECTRA_H

#include "image/image.h"

/* Four octaves, from RC_SPECTRA_LOWEST cycles/px up; six steps an octave, 24 directions a half
 * turn: dense enough that values between the steps may be had by linear interpolation, which would
 * smooth sparser, noisy ones and so prefer planes whose samples fall between the steps. */
#define RC_SPECTRA_OCTAVES 4
#define RC_SPECTRA_PER_OCTAVE 6
#define RC_SPECTRA_STEPS (RC_SPECTRA_OCTAVES * RC_SPECTRA_PER_OCTAVE)
#define RC_SPECTRA_DIRECTIONS 24
/* The highest frequency: above it lenses, scaling and JPEG leave little; aliasing adds to it. */
#define RC_SPECTRA_HIGHEST .36
#define RC_SPECTRA_LOWEST (RC_SPECTRA_HIGHEST / 16)

/* log2 power per px^2 of frequency; NaN where nothing is known. step s lies at
 * RC_SPECTRA_LOWEST * 2^((s + 1/2) / RC_SPECTRA_PER_OCTAVE) cycles/px, direction t at t half turns
 * / 24 clockwise from x; the last direction repeats the first. */
typedef float rc_spectrum[RC_SPECTRA_STEPS][RC_SPECTRA_DIRECTIONS + 1];

typedef struct rc_spectra {
  int count;
  float *x, *y;       /* px: middle of the cell that each spectrum was gathered in */
  rc_spectrum *power; /* one for each */
} rc_spectra;

/* Only RC_SOURCE pixels are looked at. count may be 0. The memory is the context's. */
recede_status rc_spectra_gather(rc_context *context, const rc_image *image, const rc_mask *flags,
                                rc_spectra *spectra);

#endif
