/* Pixels inside the core: floats, interleaved, 1 or 3 colour channels; and one byte a pixel for
 * what a pixel is. */
#ifndef RECEDE_IMAGE_IMAGE_H
#define RECEDE_IMAGE_IMAGE_H

#include "base/context.h"

typedef struct rc_image {
  int width, height, channels;
  float *data;
} rc_image;

/* What a pixel is. TARGET: to be filled. KNOWN: has a value that must be continued. SOURCE: known,
 * and may be copied from. ALLOWED: was a source at first, where that is asked for later. TAKEN: is
 * none while something is filled. 0: nothing there (transparent, not finite, beyond the horizon).
 */
enum { RC_TARGET = 1, RC_KNOWN = 2, RC_SOURCE = 4, RC_ALLOWED = 8, RC_TAKEN = 16 };

typedef struct rc_mask {
  int width, height;
  uint8_t *data;
} rc_mask;

typedef struct rc_box {
  int x0, y0, x1, y1; /* x0 <= x < x1 */
} rc_box;

recede_status rc_image_new(rc_context *context, int width, int height, int channels,
                           rc_image *image);
recede_status rc_mask_new(rc_context *context, int width, int height, rc_mask *mask);
/* Around the pixels with any of these flags; all 0 where there is none. */
rc_box rc_box_of(const rc_mask *mask, int wanted);
/* Adds RC_ALLOWED to all sources: what is taken from them later may still be copied by what knows
 * where it comes from. */
void rc_allow_sources(rc_mask *mask);
/* Which pixels x0 .. x1 - 1 of a row are target and touch a known one to a side: 1, else 0. */
void rc_border_of_row(const rc_mask *flags, int y, int x0, int x1, uint8_t *border);
/* So many px larger to each side, inside width x height. */
rc_box rc_box_grown(rc_box box, int px, int width, int height);
/* What both hold; x1 <= x0 or y1 <= y0: nothing. */
rc_box rc_box_common(rc_box a, rc_box b);
static inline int rc_longer_side(rc_box box) {
  int width = box.x1 - box.x0, height = box.y1 - box.y0;
  return width > height ? width : height;
}
static inline int rc_shorter_side(rc_box box) {
  int width = box.x1 - box.x0, height = box.y1 - box.y0;
  return width < height ? width : height;
}
static inline float *rc_pixel(const rc_image *image, int x, int y) {
  return image->data + ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)image->channels;
}
static inline float rc_brightness_at(const rc_image *image, int x, int y) {
  const float *v = rc_pixel(image, x, y);
  return image->channels == 1 ? v[0] : .3f * v[0] + .59f * v[1] + .11f * v[2];
}
static inline uint8_t *rc_flag(const rc_mask *mask, int x, int y) {
  return mask->data + (size_t)y * (size_t)mask->width + (size_t)x;
}
static inline bool rc_inside(int width, int height, int x, int y) {
  return x >= 0 && y >= 0 && x < width && y < height;
}

#endif
