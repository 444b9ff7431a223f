/* A smooth base (a wide Gaussian) was tried first: it takes planks', crests' and ripples' own tone
 * away, and what lies beyond the source bleeds into it; photos lost 15 points by it. */
#include "image/tone.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"

/* Part of the variance that a trend must explain: below, sources of the right brightness are found
 * all the same, and a trend that the texture only feigns (near stones, far stones) does harm. */
#define LEAST_EXPLAINED .75
/* Enough for six decimals of a trend. */
#define MOST_SAMPLES 400000

/* Sums over the sources, about the picture's middle. */
typedef struct sums {
  double n, x, y, xx, xy, yy, v[3], vv[3], xv[3], yv[3];
} sums;

static void add(sums *s, double x, double y, const float *pixel, int channels) {
  s->n++, s->x += x, s->y += y, s->xx += x * x, s->xy += x * y, s->yy += y * y;
  for (int k = 0; k < channels; k++) {
    double v = pixel[k];
    s->v[k] += v, s->vv[k] += v * v, s->xv[k] += x * v, s->yv[k] += y * v;
  }
}

static void gather(const rc_image *image, const rc_mask *flags, sums *s, rc_box *box) {
  double area = (double)image->width * image->height;
  int step = area > MOST_SAMPLES ? (int)ceil(sqrt(area / MOST_SAMPLES)) : 1;
  *box = (rc_box){image->width, image->height, 0, 0};
  for (int y = 0; y < image->height; y += step)
    for (int x = 0; x < image->width; x += step) {
      if (!(*rc_flag(flags, x, y) & RC_SOURCE)) continue;
      if (x < box->x0) box->x0 = x;
      if (x >= box->x1) box->x1 = x + 1;
      if (y < box->y0) box->y0 = y;
      box->y1 = y + 1;
      add(s, x - image->width / 2., y - image->height / 2., rc_pixel(image, x, y), image->channels);
    }
}

/* Covariances, and from them each channel's slopes. Returns the part of the variance explained. */
static double solve(const sums *s, rc_tone *tone) {
  double xx = s->xx - s->x * s->x / s->n, yy = s->yy - s->y * s->y / s->n;
  double xy = s->xy - s->x * s->y / s->n, det = xx * yy - xy * xy;
  double explained = 0, total = 0;
  if (!(det > 1e-6 * xx * yy)) return 0;
  for (int k = 0; k < tone->channels; k++) {
    double xv = s->xv[k] - s->x * s->v[k] / s->n, yv = s->yv[k] - s->y * s->v[k] / s->n;
    tone->slope_x[k] = (xv * yy - yv * xy) / det;
    tone->slope_y[k] = (yv * xx - xv * xy) / det;
    explained += tone->slope_x[k] * xv + tone->slope_y[k] * yv;
    total += s->vv[k] - s->v[k] * s->v[k] / s->n;
  }
  return total > 0 ? explained / total : 0;
}

void rc_tone_fit(const rc_image *image, const rc_mask *flags, bool drift, rc_tone *tone) {
  sums s = {0};
  memset(tone, 0, sizeof *tone);
  tone->channels = image->channels;
  gather(image, flags, &s, &tone->box);
  if (!(s.n > 0)) return;
  if (!drift || solve(&s, tone) < LEAST_EXPLAINED) {
    memset(tone->slope_x, 0, sizeof tone->slope_x);
    memset(tone->slope_y, 0, sizeof tone->slope_y);
  }
  double x = s.x / s.n + image->width / 2., y = s.y / s.n + image->height / 2.;
  for (int k = 0; k < tone->channels; k++)
    tone->at[k] = s.v[k] / s.n - tone->slope_x[k] * x - tone->slope_y[k] * y;
}

static int within(int v, int low, int end) { return v < low ? low : v >= end ? end - 1 : v; }

typedef struct application {
  const rc_tone *tone;
  const rc_mask *flags;
  uint8_t flag;
  float sign;
  rc_image *image;
} application;

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  const rc_tone *tone = a->tone;
  (void)thread;
  for (int x = 0; x < a->image->width; x++) {
    if (!(*rc_flag(a->flags, x, y) & a->flag)) continue;
    double tx = within(x, tone->box.x0, tone->box.x1), ty = within(y, tone->box.y0, tone->box.y1);
    for (int k = 0; k < tone->channels; k++)
      rc_pixel(a->image, x, y)[k] +=
          a->sign * (float)(tone->at[k] + tone->slope_x[k] * tx + tone->slope_y[k] * ty);
  }
}

recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image) {
  application a = {tone, flags, flag, sign, image};
  return rc_parallel(context, image->height, apply_row, &a);
}
