#include "image/sampling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So far outside all taps are the edge's, and fixed point still holds it. */
#define FARTHEST_PX 2097152.f

static double cubic(double v) {
  v = fabs(v);
  return v < 1 ? (4 - 6 * v * v + 3 * v * v * v) / 6 : v < 2 ? (2 - v) * (2 - v) * (2 - v) / 6 : 0;
}

/* The B-spline of the samples' coefficients; those are the samples filtered with the inverse of
 * (1 4 1) / 6, whose taps fall off as z^|k|. */
static double cardinal(double v) {
  double z = sqrt(3.) - 2, sum = 0;
  for (int k = -12; k <= 12; k++) sum += -6 * z / (1 - z * z) * pow(z, abs(k)) * cubic(v - k);
  return sum;
}

void rc_sampler_init(rc_sampler *sampler, bool bilinear) {
  for (int s = 0; s < RC_SPLINE_STEPS; s++) {
    double sum = 0, t = (double)s / RC_SPLINE_STEPS, taps[RC_SPLINE_TAPS];
    for (int i = 0; i < RC_SPLINE_TAPS; i++) {
      double v = t - (i - (RC_SPLINE_TAPS / 2 - 1));
      taps[i] = bilinear ? fmax(1 - fabs(v), 0) : cardinal(v);
      sum += taps[i];
    }
    for (int i = 0; i < RC_SPLINE_TAPS; i++) sampler->taps[s][i] = (float)(taps[i] / sum);
  }
}

static int clamp(int v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : v; }

/* The same where all pixels are inside and one more behind each row: of three channels four are
 * summed, a whole vector. */
static void sample_inside(const float *taps_x, const float *taps_y, const float *pixel,
                          size_t image_row, float *value) {
  float sum[4] = {0, 0, 0, 0};
  for (int j = 0; j < RC_SPLINE_TAPS; j++, pixel += image_row) {
    float row[4] = {0, 0, 0, 0};
    for (int i = 0; i < RC_SPLINE_TAPS; i++)
      for (int k = 0; k < 4; k++) row[k] += taps_x[i] * pixel[3 * i + k];
    for (int k = 0; k < 4; k++) sum[k] += taps_y[j] * row[k];
  }
  memcpy(value, sum, 3 * sizeof *value);
}

void rc_sample(const rc_sampler *sampler, const rc_image *image, float x, float y, float *value) {
  int channels = image->channels, reach = RC_SPLINE_TAPS / 2 - 1;
  x = fminf(fmaxf(x, -FARTHEST_PX), FARTHEST_PX), y = fminf(fmaxf(y, -FARTHEST_PX), FARTHEST_PX);
  int fixed_x = (int)floorf(x * RC_SPLINE_STEPS + .5f),
      fixed_y = (int)floorf(y * RC_SPLINE_STEPS + .5f);
  int step_x = fixed_x & (RC_SPLINE_STEPS - 1), step_y = fixed_y & (RC_SPLINE_STEPS - 1);
  int ix = (fixed_x - step_x) / RC_SPLINE_STEPS, iy = (fixed_y - step_y) / RC_SPLINE_STEPS;
  if (!step_x && !step_y) {
    memcpy(value, rc_pixel(image, clamp(ix, image->width), clamp(iy, image->height)),
           (size_t)channels * sizeof *value);
    return;
  }
  int left = ix - reach, top = iy - reach;
  if (channels == 3 && left >= 0 && top >= 0 && left + RC_SPLINE_TAPS < image->width &&
      top + RC_SPLINE_TAPS <= image->height) {
    sample_inside(sampler->taps[step_x], sampler->taps[step_y], rc_pixel(image, left, top),
                  3 * (size_t)image->width, value);
    return;
  }
  float sum[3] = {0, 0, 0};
  for (int j = 0; j < RC_SPLINE_TAPS; j++) {
    float row[3] = {0, 0, 0}, tap_y = sampler->taps[step_y][j];
    int sy = clamp(top + j, image->height);
    for (int i = 0; i < RC_SPLINE_TAPS; i++) {
      const float *pixel = rc_pixel(image, clamp(left + i, image->width), sy);
      float tap = sampler->taps[step_x][i];
      for (int k = 0; k < channels; k++) row[k] += tap * pixel[k];
    }
    for (int k = 0; k < channels; k++) sum[k] += tap_y * row[k];
  }
  memcpy(value, sum, (size_t)channels * sizeof *value);
}
