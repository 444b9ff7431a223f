/* The scale channel S: the number that tells pixels of different depth apart.
 *
 * Both maps in use are linear in the image: the paper's S(p) of eq. 3, and the exact scale across
 * the tilt, w. So a map is three numbers, stretching it to another size or moving it to another
 * pyramid level changes the numbers, and no map is ever stored. */
#ifndef RECEDE_SYNTHESIS_PAPER_SCALE_CHANNEL_H
#define RECEDE_SYNTHESIS_PAPER_SCALE_CHANNEL_H

#include <math.h>

#include "synthesis/problem.h"

/* Eqs 1-3 for a picture of the plane's size; slant < 90. */
rc_line rc_scale_channel(const recede_plane *plane);
/* The paper's section 4: the same map resampled, corner to corner, from one size to another. */
rc_line rc_scale_resampled(const rc_line *scale, int width, int height, int new_width,
                           int new_height);
/* The map of the picture moved so that (x, y) becomes (0, 0). */
rc_line rc_scale_moved(const rc_line *scale, int x, int y);

/* Scale is positive on the plane; known pixels near and beyond the horizon share this value. */
#define RC_LEAST_SCALE .01f
static inline float rc_scale(const rc_line *scale, double x, double y) {
  return fmaxf((float)rc_w(scale, x, y), RC_LEAST_SCALE);
}

#endif
