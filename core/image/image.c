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
