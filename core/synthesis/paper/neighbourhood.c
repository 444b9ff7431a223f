#include "synthesis/paper/neighbourhood.h"

#include <string.h>

#include "base/four.h"
#include "base/memory.h"
#include "base/random.h"

static inline rc_four load(const float *from) {
  rc_four v;
  memcpy(&v, from, sizeof v);
  return v;
}
static inline float total(rc_four low, rc_four high) {
  rc_four sum = low + high;
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

float rc_squared_distance(const float *a, const float *b, int count) {
  rc_four low = {0}, high = {0};
  for (int i = 0; i < count; i += 8) {
    rc_four d = load(a + i) - load(b + i), e = load(a + i + 4) - load(b + i + 4);
    low += d * d;
    high += e * e;
  }
  return total(low, high);
}

float rc_dot(const float *a, const float *b, int count) {
  rc_four low = {0}, high = {0};
  for (int i = 0; i < count; i += 8) {
    low += load(a + i) * load(b + i);
    high += load(a + i + 4) * load(b + i + 4);
  }
  return total(low, high);
}

static float row_distance(const float *a, const float *b, int count) {
  int whole = count / 8 * 8;
  float sum = rc_squared_distance(a, b, whole);
  for (int i = whole; i < count; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

float rc_window_distance(const rc_image *a, rc_corner at, const rc_image *b, rc_corner bt,
                         int width, float limit) {
  float sum = 0;
  for (int y = 0; y < width && sum <= limit; y++)
    sum +=
        row_distance(rc_pixel(a, at.x, at.y + y), rc_pixel(b, bt.x, bt.y + y), width * a->channels);
  return sum;
}

/* Two passes, each a running count of SOURCE pixels in a row: first along x, then along y. */
recede_status rc_windows_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                              int width, rc_windows *windows) {
  int columns = image->width - width + 1, rows = image->height - width + 1;
  uint8_t *across;
  int *below;
  *windows = (rc_windows){.image = image, .width = width};
  if (columns < 1 || rows < 1) return RECEDE_OK;
  windows->columns = columns, windows->rows = rows;
  RC_TRY(RC_NEW_ZERO(context, (size_t)columns * (size_t)rows, &windows->valid));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)columns * (size_t)image->height, &across));
  RC_TRY(RC_NEW_ZERO(context, columns, &below));
  for (int y = 0; y < image->height; y++) {
    int run = 0;
    for (int x = 0; x < image->width; x++) {
      run = *rc_flag(flags, x, y) & RC_SOURCE ? run + 1 : 0;
      if (x >= width - 1) across[(size_t)y * (size_t)columns + x - width + 1] = run >= width;
    }
    for (int x = 0; x < columns; x++) {
      below[x] = across[(size_t)y * (size_t)columns + x] ? below[x] + 1 : 0;
      if (below[x] < width) continue;
      windows->valid[(size_t)(y - width + 1) * (size_t)columns + x] = 1;
      windows->count++;
    }
  }
  rc_release(context, mark);
  return RECEDE_OK;
}

/* Selection sampling: each window is taken with (still wanted) / (still to come). */
recede_status rc_windows_sample(rc_context *context, const rc_windows *windows, size_t most,
                                uint64_t key, rc_corner **corners, int *count) {
  size_t left = windows->count, wanted = left < most ? left : most;
  *count = 0;
  RC_TRY(RC_NEW(context, wanted, corners));
  for (int y = 0; y < windows->rows && wanted; y++)
    for (int x = 0; x < windows->columns && wanted; x++) {
      if (!rc_window_valid(windows, x, y)) continue;
      if (rc_unit(rc_random(key, (uint32_t)x, (uint32_t)y, 0)) * (double)left < (double)wanted) {
        (*corners)[(*count)++] = (rc_corner){x, y};
        wanted--;
      }
      left--;
    }
  return RECEDE_OK;
}
