/* Neighbourhoods: square windows of a picture, named by their top left pixel (their corner). */
#ifndef RECEDE_SYNTHESIS_PAPER_NEIGHBOURHOOD_H
#define RECEDE_SYNTHESIS_PAPER_NEIGHBOURHOOD_H

#include "image/image.h"

typedef struct rc_corner {
  int x, y; /* x < 0: none */
} rc_corner;

/* The exemplar's neighbourhoods of one width. */
typedef struct rc_windows {
  const rc_image *image;
  int width;
  int columns, rows; /* corners that keep the window inside the picture */
  uint8_t *valid;    /* one a corner: every pixel of the window is SOURCE */
  size_t count;      /* of the valid */
} rc_windows;

/* columns = 0 when the picture is smaller than the window. */
recede_status rc_windows_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                              int width, rc_windows *windows);
static inline bool rc_window_valid(const rc_windows *windows, int x, int y) {
  return rc_inside(windows->columns, windows->rows, x, y) &&
         windows->valid[(size_t)y * (size_t)windows->columns + (size_t)x];
}
/* At most most of the valid windows, spread evenly by random picks, in reading order. */
recede_status rc_windows_sample(rc_context *context, const rc_windows *windows, size_t most,
                                uint64_t key, rc_corner **corners, int *count);

/* ||x_p - z_p||^2 of eq. 4. May stop at, and return, any value above limit. */
float rc_window_distance(const rc_image *a, rc_corner at, const rc_image *b, rc_corner bt,
                         int width, float limit);

/* Sums in eight fixed lanes: the same bits however the compiler and the machine vectorise. count is
 * a multiple of 8. */
float rc_squared_distance(const float *a, const float *b, int count);
float rc_dot(const float *a, const float *b, int count);
static inline int rc_padded(int count) { return (count + 7) / 8 * 8; }

#endif
