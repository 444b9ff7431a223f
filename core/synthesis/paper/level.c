#include "synthesis/paper/level.h"

#include <string.h>

#include "base/memory.h"
#include "synthesis/paper/scale_channel.h"

recede_status rc_side_with_scale(rc_context *context, const rc_side *side, rc_side *with) {
  const rc_image *image = &side->image;
  int colours = image->channels;
  *with = *side;
  RC_TRY(rc_image_new(context, image->width, image->height, colours + 1, &with->image));
  for (int y = 0; y < image->height; y++)
    for (int x = 0; x < image->width; x++) {
      float *pixel = rc_pixel(&with->image, x, y);
      memcpy(pixel, rc_pixel(image, x, y), (size_t)colours * sizeof *pixel);
      pixel[colours] = rc_scale(&side->scale, x, y);
    }
  return RECEDE_OK;
}

static int clamp(int v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : v; }

void rc_side_upsample(const rc_side *coarse, int colours, rc_side *fine) {
  const rc_image *from = &coarse->image;
  for (int y = 0; y < fine->image.height; y++)
    for (int x = 0; x < fine->image.width; x++) {
      if (!rc_unknown(fine, x, y)) continue;
      /* Pixel x lies at x / 2 - 1/4 of the coarser level: 3/4 of x / 2, 1/4 of its neighbour. */
      int x0 = clamp(x / 2, from->width), x1 = clamp(x / 2 + (x & 1 ? 1 : -1), from->width);
      int y0 = clamp(y / 2, from->height), y1 = clamp(y / 2 + (y & 1 ? 1 : -1), from->height);
      const float *a = rc_pixel(from, x0, y0), *b = rc_pixel(from, x1, y0);
      const float *c = rc_pixel(from, x0, y1), *d = rc_pixel(from, x1, y1);
      float *pixel = rc_pixel(&fine->image, x, y);
      for (int k = 0; k < colours; k++)
        pixel[k] = .5625f * a[k] + .1875f * (b[k] + c[k]) + .0625f * d[k];
    }
}
