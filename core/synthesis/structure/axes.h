/* Weights of colours that two textures are told apart by: their edge is a line in the picture so
 * weighed. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_AXES_H
#define RECEDE_SYNTHESIS_STRUCTURE_AXES_H

#include "image/image.h"

/* Of three colours; grey has only the first. */
typedef struct rc_covariance {
  double of[3][3];
} rc_covariance;

/* The sources' of a level. */
rc_covariance rc_covariance_of(const rc_image *image, const rc_mask *flags);
double rc_covariance_trace(const rc_covariance *covariance);
/* What colours differ by most: grass and brick may be equally bright. */
void rc_principal_axis(const rc_covariance *covariance, float axis[3]);
/* What they differ by most at the coarsest level, for what they do within its pixels. Setts differ
 * by their brightness more than by anything that tells them from grass. all: a finer level's, far:
 * the coarsest one's. */
void rc_telling_axis(const rc_covariance *all, const rc_covariance *far, float axis[3]);

#endif
