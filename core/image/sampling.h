/* Pictures between their pixels, by the cardinal cubic B-spline: the least blur of what was tried
 * (nearest, bilinear, Catmull-Rom). */
#ifndef RECEDE_IMAGE_SAMPLING_H
#define RECEDE_IMAGE_SAMPLING_H

#include "image/image.h"

#define RC_SPLINE_TAPS 10
#define RC_SPLINE_STEPS 512 /* of a px */

typedef struct rc_sampler {
  float taps[RC_SPLINE_STEPS][RC_SPLINE_TAPS];
} rc_sampler;

/* bilinear: for the ablation only. */
void rc_sampler_init(rc_sampler *sampler, bool bilinear);
/* Value at (x, y) px; beyond the border the last pixel is repeated. At whole pixels exactly the
 * pixel. */
void rc_sample(const rc_sampler *sampler, const rc_image *image, float x, float y, float *value);

#endif
