/* Straight edges in a picture. */
#ifndef RECEDE_PLANE_SEGMENTS_H
#define RECEDE_PLANE_SEGMENTS_H

#include "image/image.h"

typedef struct rc_segment {
  float x, y;   /* middle, px */
  float dx, dy; /* unit direction */
  float length; /* px */
} rc_segment;

#define RC_MOST_SEGMENTS 600

/* The longest straight edges between RC_SOURCE pixels, at most RC_MOST_SEGMENTS, longest first. */
recede_status rc_segments_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                               rc_segment segments[RC_MOST_SEGMENTS], int *count);

#endif
