#include "synthesis/structure/axes.h"

#include <math.h>

#define POWER_STEPS 30
/* What has no noise at all is not told by everything: so much of the trace there always is. */
#define LEAST_NOISE .01

rc_covariance rc_covariance_of(const rc_image *image, const rc_mask *flags) {
  rc_covariance c = {{{0}}};
  double mean[3] = {0, 0, 0}, count = 0;
  for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
    const float *v = image->data + i * (size_t)image->channels;
    if (!(flags->data[i] & RC_SOURCE)) continue;
    for (int k = 0; k < image->channels; k++) {
      mean[k] += v[k];
      for (int j = 0; j < image->channels; j++) c.of[k][j] += (double)v[k] * v[j];
    }
    count++;
  }
  for (int k = 0; k < 3 && count > 0; k++)
    for (int j = 0; j < 3; j++) c.of[k][j] = (c.of[k][j] - mean[k] * mean[j] / count) / count;
  return c;
}

double rc_covariance_trace(const rc_covariance *c) {
  return c->of[0][0] + c->of[1][1] + c->of[2][2];
}

static void times(const double m[3][3], const double v[3], double product[3]) {
  for (int k = 0; k < 3; k++) {
    product[k] = 0;
    for (int j = 0; j < 3; j++) product[k] += m[k][j] * v[j];
  }
}

/* By the power method, of so far as first times second; first may be NULL. */
static void greatest_axis(const double first[3][3], const double second[3][3], float axis[3]) {
  double v[3] = {.3, .59, .11};
  for (int step = 0; step < POWER_STEPS; step++) {
    double next[3], once[3], square = 0;
    times(second, v, next);
    for (int k = 0; k < 3 && first; k++) once[k] = next[k];
    if (first) times(first, once, next);
    for (int k = 0; k < 3; k++) square += next[k] * next[k];
    for (int k = 0; k < 3 && square > 0; k++) v[k] = next[k] / sqrt(square);
  }
  for (int k = 0; k < 3; k++) axis[k] = (float)v[k];
}

void rc_principal_axis(const rc_covariance *c, float axis[3]) { greatest_axis(NULL, c->of, axis); }

void rc_telling_axis(const rc_covariance *all, const rc_covariance *far, float axis[3]) {
  double near[3][3], inverse[3][3], least = LEAST_NOISE * rc_covariance_trace(all);
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++) near[k][j] = all->of[k][j] - far->of[k][j] + (k == j ? least : 0);
  for (int k = 0; k < 3; k++) /* but for a factor */
    for (int j = 0; j < 3; j++) {
      int a = (j + 1) % 3, b = (j + 2) % 3, c = (k + 1) % 3, d = (k + 2) % 3;
      inverse[k][j] = near[a][c] * near[b][d] - near[a][d] * near[b][c];
    }
  greatest_axis((const double(*)[3])inverse, far->of, axis);
}
