#include "image/pyramid.h"

#include "base/parallel.h"

typedef struct halving {
  const rc_image *image;
  const rc_mask *flags;
  rc_image *half_image;
  rc_mask *half_flags;
} halving;

static int clamp(int v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : v; }

int rc_half_from(int y, int j, int count) { return clamp(2 * y - 1 + j, count); }

static const float tap[4] = {1, 3, 3, 1};

/* Whether all sixteen are known, which begin at an inner column. */
static bool all_known(const uint8_t *const flags[4], int column) {
  uint8_t all = 255;
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) all &= flags[j][column + i];
  return all & RC_KNOWN;
}

/* The mean of these. The same sums in the same order as with some unknown, in a third of the time.
 */
static inline void mean_of_known(const float *const rows[4], size_t at, int channels, float *out) {
  float sum[3] = {0, 0, 0};
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < channels; k++)
        sum[k] += tap[i] * tap[j] * rows[j][at + (size_t)(i * channels + k)];
  for (int k = 0; k < channels; k++) out[k] = sum[k] / 64;
}

void rc_half_pixel(const float *const rows[4], int first, const uint8_t *const flags[4], int width,
                   int channels, int x, float *out) {
  float sum[3] = {0, 0, 0}, total = 0;
  if (x > 0 && 2 * x + 3 <= width && all_known(flags, 2 * x - 1)) {
    size_t at = (size_t)(2 * x - 1 - first) * (size_t)channels;
    if (channels == 3)
      mean_of_known(rows, at, 3, out);
    else
      mean_of_known(rows, at, channels, out);
    return;
  }
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) {
      int from = rc_half_from(x, i, width);
      if (!(flags[j][from] & RC_KNOWN)) continue;
      const float *pixel = rows[j] + (size_t)(from - first) * (size_t)channels;
      float weight = tap[i] * tap[j];
      for (int k = 0; k < channels; k++) sum[k] += weight * pixel[k];
      total += weight;
    }
  for (int k = 0; k < channels; k++) out[k] = total > 0 ? sum[k] / total : 0;
}

static void half_row(void *user, int y, int thread) {
  const halving *h = user;
  const float *rows[4];
  const uint8_t *flags[4];
  int width = h->image->width;
  (void)thread;
  for (int j = 0; j < 4; j++) {
    int from = rc_half_from(y, j, h->image->height);
    rows[j] = rc_pixel(h->image, 0, from), flags[j] = rc_flag(h->flags, 0, from);
  }
  for (int x = 0; x < h->half_image->width; x++) {
    uint8_t any = 0, all = 255;
    for (int c = 0; c < 4; c++) {
      uint8_t flag = flags[1 + (c >> 1)][clamp(2 * x + (c & 1), width)];
      any |= flag, all &= flag;
    }
    *rc_flag(h->half_flags, x, y) =
        any & RC_TARGET ? RC_TARGET : (uint8_t)(all & (RC_KNOWN | RC_SOURCE | RC_ALLOWED));
    rc_half_pixel(rows, 0, flags, width, h->image->channels, x, rc_pixel(h->half_image, x, y));
  }
}

recede_status rc_half(rc_context *context, const rc_image *image, const rc_mask *flags,
                      rc_image *half_image, rc_mask *half_flags) {
  int width = (image->width + 1) / 2, height = (image->height + 1) / 2;
  RC_TRY(rc_image_new(context, width, height, image->channels, half_image));
  RC_TRY(rc_mask_new(context, width, height, half_flags));
  halving h = {image, flags, half_image, half_flags};
  return rc_parallel(context, height, half_row, &h);
}
