#include "image/shrink.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/view.h"

/* Beyond this a value is damage, not light, and sums of its squares would overflow. */
#define MOST_VALUE 1e9f

static bool usable_colour(const float *pixel, int colours) {
  for (int k = 0; k < colours; k++)
    if (!(fabsf(pixel[k]) <= MOST_VALUE)) return false;
  return true;
}

int rc_classify_row(const rc_views *views, int x, int y, int count, const float *values,
                    float *scratch, uint8_t *flags) {
  int channels = views->image->channels, colours = channels < 3 ? 1 : 3, nonfinite = 0;
  memset(flags, 0, (size_t)count);
  if (views->mask) {
    rc_view_read(views->mask, x, y, count, scratch);
    for (int i = 0; i < count; i++)
      if (scratch[i] > 0) flags[i] = RC_TARGET;
  }
  if (views->source) rc_view_read(views->source, x, y, count, scratch);
  for (int i = 0; i < count; i++) {
    const float *pixel = values + (size_t)i * (size_t)channels;
    if (flags[i] & RC_TARGET) continue;
    if (colours < channels && !(pixel[colours] > 0)) continue; /* transparent: never read */
    if (!usable_colour(pixel, colours))
      nonfinite++;
    else
      flags[i] = !views->source || scratch[i] > .5f ? RC_KNOWN | RC_SOURCE : RC_KNOWN;
  }
  return nonfinite;
}

typedef struct block_sum {
  float colour[3];
  int known, targets, sources;
} block_sum;

static void add_row(block_sum *sums, int factor, int width, int channels, const float *values,
                    const uint8_t *flags) {
  int colours = channels < 3 ? 1 : 3;
  for (int x = 0; x < width; x++) {
    block_sum *sum = sums + x / factor;
    const float *pixel = values + (size_t)x * (size_t)channels;
    sum->targets += flags[x] & RC_TARGET ? 1 : 0;
    sum->sources += flags[x] & RC_SOURCE ? 1 : 0;
    if (!(flags[x] & RC_KNOWN)) continue;
    sum->known++;
    for (int k = 0; k < colours; k++) sum->colour[k] += pixel[k];
  }
}

static void finish_block(const block_sum *sum, int pixels, int colours, float *pixel,
                         uint8_t *flags) {
  *flags = sum->targets
               ? RC_TARGET
               : (uint8_t)((sum->known ? RC_KNOWN : 0) | (sum->sources == pixels ? RC_SOURCE : 0));
  for (int k = 0; k < colours && sum->known; k++) pixel[k] = sum->colour[k] / (float)sum->known;
}

recede_status rc_shrink(rc_context *context, const rc_views *views, int factor, rc_image *image,
                        rc_mask *flags) {
  int width = views->image->width, height = views->image->height;
  int channels = views->image->channels, colours = channels < 3 ? 1 : 3;
  int small_w = (width + factor - 1) / factor, small_h = (height + factor - 1) / factor;
  float *values, *scratch;
  uint8_t *row_flags;
  block_sum *sums;
  RC_TRY(rc_image_new(context, small_w, small_h, colours, image));
  RC_TRY(rc_mask_new(context, small_w, small_h, flags));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, width * channels, &values));
  RC_TRY(RC_NEW(context, width, &scratch));
  RC_TRY(RC_NEW(context, width, &row_flags));
  RC_TRY(RC_NEW(context, small_w, &sums));
  for (int by = 0; by < small_h; by++) {
    int rows = height - by * factor < factor ? height - by * factor : factor;
    memset(sums, 0, (size_t)small_w * sizeof *sums);
    for (int r = 0; r < rows; r++) {
      rc_view_read(views->image, 0, by * factor + r, width, values);
      rc_classify_row(views, 0, by * factor + r, width, values, scratch, row_flags);
      add_row(sums, factor, width, channels, values, row_flags);
    }
    for (int bx = 0; bx < small_w; bx++) {
      int columns = width - bx * factor < factor ? width - bx * factor : factor;
      finish_block(&sums[bx], rows * columns, colours, rc_pixel(image, bx, by),
                   rc_flag(flags, bx, by));
    }
    RC_TRY(rc_poll(context));
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
