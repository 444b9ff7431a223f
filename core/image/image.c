#include "image/image.h"

#include "base/memory.h"

recede_status rc_image_new(rc_context *context, int width, int height, int channels,
                           rc_image *image) {
  *image = (rc_image){width, height, channels, NULL};
  return RC_NEW_ZERO(context, (size_t)width * (size_t)height * (size_t)channels, &image->data);
}

recede_status rc_mask_new(rc_context *context, int width, int height, rc_mask *mask) {
  *mask = (rc_mask){width, height, NULL};
  return RC_NEW_ZERO(context, (size_t)width * (size_t)height, &mask->data);
}

rc_box rc_box_of(const rc_mask *mask, int wanted) {
  rc_box box = {mask->width, mask->height, 0, 0};
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++) {
      if (!(*rc_flag(mask, x, y) & wanted)) continue;
      if (x < box.x0) box.x0 = x;
      if (x >= box.x1) box.x1 = x + 1;
      if (y < box.y0) box.y0 = y;
      box.y1 = y + 1;
    }
  return box.x1 ? box : (rc_box){0, 0, 0, 0};
}
