#include "synthesis/structure/seen.h"

#include <math.h>

#include "base/memory.h"

/* False: (x, y) is no source. */
static bool source_at(const rc_seen *picture, int x, int y, float *value) {
  if (!rc_inside(picture->flags->width, picture->flags->height, x, y)) return false;
  *value = picture->value[(size_t)y * (size_t)picture->flags->width + (size_t)x];
  return !isnan(*value);
}

const float *rc_brightness_axis(const rc_image *image) {
  static const float grey[3] = {1, 0, 0}, colours[3] = {.3f, .59f, .11f};
  return image->channels == 1 ? grey : colours;
}

recede_status rc_see(rc_context *context, const rc_image *image, const rc_mask *flags,
                     const float axis[3], rc_seen *seen) {
  size_t pixels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
  float *value;
  RC_TRY(RC_NEW(context, pixels, &value));
  for (size_t i = 0; i < pixels; i++) {
    float sum = 0;
    for (size_t k = 0; k < channels; k++) sum += axis[k] * image->data[i * channels + k];
    value[i] = flags->data[i] & RC_SOURCE ? sum : NAN;
  }
  *seen = (rc_seen){flags, value, false, NULL};
  return RECEDE_OK;
}

recede_status rc_see_contrast(rc_context *context, rc_seen *seen) {
  int width = seen->flags->width, height = seen->flags->height;
  float *contrast;
  RC_TRY(RC_NEW(context, (size_t)width * (size_t)height, &contrast));
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      float sum = 0, square = 0, count = 0, value;
      size_t at = (size_t)y * (size_t)width + (size_t)x;
      contrast[at] = NAN;
      if (isnan(seen->value[at])) continue;
      for (int k = 0; k < 9; k++) {
        if (!source_at(seen, x - 1 + k % 3, y - 1 + k / 3, &value)) continue;
        sum += value, square += value * value, count++;
      }
      contrast[at] = sqrtf(fmaxf(square / count - sum / count * (sum / count), 0.f));
    }
  seen->value = contrast;
  return rc_poll(context);
}
