#include "image/tone.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"

/* The base is kept at a resolution of a quarter of its sigma: finer shows nothing. */
#define CELLS_PER_SIGMA 4
/* Gaussians of 1, 2, 4, 8, 16 sigma; each counts this much less, so that it matters only where the
 * narrower ones see next to nothing. */
#define WIDTHS 5
#define WIDER_COUNTS .01f

/* Channels of a cell: sum of each colour, then the number of pixels. */
static recede_status sum_cells(rc_context *context, const rc_image *image, const rc_mask *flags,
                               int factor, rc_image *cells) {
  int channels = image->channels;
  RC_TRY(rc_image_new(context, (image->width + factor - 1) / factor,
                      (image->height + factor - 1) / factor, channels + 1, cells));
  for (int y = 0; y < image->height; y++)
    for (int x = 0; x < image->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_KNOWN)) continue;
      float *cell = rc_pixel(cells, x / factor, y / factor);
      const float *pixel = rc_pixel(image, x, y);
      for (int k = 0; k < channels; k++) cell[k] += pixel[k];
      cell[channels] += 1.f;
    }
  return RECEDE_OK;
}

/* One direction of a Gaussian cut off at 3 sigma; beyond the border there is nothing. */
static void blur_line(const float *in, float *out, int count, size_t step, int channels,
                      const float *taps, int radius) {
  for (int i = 0; i < count; i++) {
    float sum[4] = {0, 0, 0, 0};
    for (int d = -radius; d <= radius; d++) {
      if (i + d < 0 || i + d >= count) continue;
      const float *cell = in + (size_t)(i + d) * step;
      for (int k = 0; k < channels; k++) sum[k] += taps[d + radius] * cell[k];
    }
    memcpy(out + (size_t)i * step, sum, (size_t)channels * sizeof *sum);
  }
}

static recede_status blur(rc_context *context, const rc_image *cells, float sigma, rc_image *out) {
  float *taps;
  rc_image middle;
  int radius = (int)(3.f * sigma) + 1, channels = cells->channels;
  size_t row = (size_t)cells->width * (size_t)channels;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 2 * radius + 1, &taps));
  RC_TRY(rc_image_new(context, cells->width, cells->height, channels, &middle));
  for (int d = -radius; d <= radius; d++)
    taps[d + radius] = rc_exp(-.5f * (float)(d * d) / (sigma * sigma));
  for (int y = 0; y < cells->height; y++)
    blur_line(cells->data + (size_t)y * row, middle.data + (size_t)y * row, cells->width,
              (size_t)channels, channels, taps, radius);
  for (int x = 0; x < cells->width; x++)
    blur_line(middle.data + (size_t)x * (size_t)channels, out->data + (size_t)x * (size_t)channels,
              cells->height, row, channels, taps, radius);
  rc_release(context, mark);
  return rc_poll(context);
}

static recede_status mean_only(rc_context *context, const rc_image *cells, rc_tone *tone) {
  double sum[4] = {0, 0, 0, 0};
  int channels = cells->channels - 1;
  for (size_t i = 0; i < (size_t)cells->width * (size_t)cells->height; i++)
    for (int k = 0; k <= channels; k++)
      sum[k] += cells->data[i * (size_t)cells->channels + (size_t)k];
  RC_TRY(rc_image_new(context, 1, 1, channels, &tone->base));
  for (int k = 0; k < channels; k++)
    tone->base.data[k] = sum[channels] > 0 ? (float)(sum[k] / sum[channels]) : 0;
  tone->factor = 1 << 20;
  return RECEDE_OK;
}

static void add_width(const rc_image *blurred, float share, rc_image *sum) {
  size_t count = (size_t)sum->width * (size_t)sum->height * (size_t)sum->channels;
  for (size_t i = 0; i < count; i++) sum->data[i] += share * blurred->data[i];
}

static void divide(const rc_image *sum, rc_image *base) {
  int channels = base->channels;
  for (size_t i = 0; i < (size_t)base->width * (size_t)base->height; i++) {
    const float *cell = sum->data + i * (size_t)sum->channels;
    for (int k = 0; k < channels; k++)
      base->data[i * (size_t)channels + (size_t)k] =
          cell[channels] > 0 ? cell[k] / cell[channels] : 0;
  }
}

recede_status rc_tone_new(rc_context *context, const rc_image *image, const rc_mask *flags,
                          float sigma, bool smooth, rc_tone *tone) {
  rc_image cells, sum, blurred;
  int factor = (int)(sigma / CELLS_PER_SIGMA);
  tone->factor = factor < 1 ? 1 : factor;
  int width = (image->width + tone->factor - 1) / tone->factor;
  int height = (image->height + tone->factor - 1) / tone->factor;
  if (smooth) RC_TRY(rc_image_new(context, width, height, image->channels, &tone->base));
  rc_block *mark = rc_mark(context);
  RC_TRY(sum_cells(context, image, flags, tone->factor, &cells));
  if (!smooth) return mean_only(context, &cells, tone);
  RC_TRY(rc_image_new(context, width, height, cells.channels, &sum));
  RC_TRY(rc_image_new(context, width, height, cells.channels, &blurred));
  float share = 1.f, cell_sigma = sigma / (float)tone->factor;
  for (int i = 0; i < WIDTHS; i++, share *= WIDER_COUNTS) {
    RC_TRY(blur(context, &cells, cell_sigma, &blurred));
    add_width(&blurred, share, &sum);
    cell_sigma *= 2.f;
  }
  divide(&sum, &tone->base);
  rc_release(context, mark);
  return RECEDE_OK;
}

void rc_tone_at(const rc_tone *tone, int x, int y, float *value) {
  const rc_image *base = &tone->base;
  float fx = ((float)x + .5f) / (float)tone->factor - .5f;
  float fy = ((float)y + .5f) / (float)tone->factor - .5f;
  fx = fminf(fmaxf(fx, 0.f), (float)(base->width - 1));
  fy = fminf(fmaxf(fy, 0.f), (float)(base->height - 1));
  int ix = (int)fx, iy = (int)fy;
  int nx = ix + 1 < base->width ? ix + 1 : ix, ny = iy + 1 < base->height ? iy + 1 : iy;
  fx -= (float)ix, fy -= (float)iy;
  for (int k = 0; k < base->channels; k++) {
    float top = rc_pixel(base, ix, iy)[k] * (1.f - fx) + rc_pixel(base, nx, iy)[k] * fx;
    float bottom = rc_pixel(base, ix, ny)[k] * (1.f - fx) + rc_pixel(base, nx, ny)[k] * fx;
    value[k] = top * (1.f - fy) + bottom * fy;
  }
}

typedef struct application {
  const rc_tone *tone;
  const rc_mask *flags;
  uint8_t flag;
  float sign;
  rc_image *image;
} application;

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  (void)thread;
  for (int x = 0; x < a->image->width; x++) {
    float value[3];
    if (!(*rc_flag(a->flags, x, y) & a->flag)) continue;
    rc_tone_at(a->tone, x, y, value);
    for (int k = 0; k < a->image->channels; k++) rc_pixel(a->image, x, y)[k] += a->sign * value[k];
  }
}

recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image) {
  application a = {tone, flags, flag, sign, image};
  return rc_parallel(context, image->height, apply_row, &a);
}
