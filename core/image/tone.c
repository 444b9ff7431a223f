#include "image/tone.h"

#include "base/parallel.h"

#define TERMS RC_TONE_TERMS
/* The trend is added to so many pixels of a row at once. */
#define COLUMNS 64

static int within(int v, int low, int end) { return v < low ? low : v >= end ? end - 1 : v; }

static double unit_x(const rc_tone *tone, int px) {
  return (px - tone->middle_x) / tone->half_width;
}

static double unit_y(const rc_tone *tone, int py) {
  return (py - tone->middle_y) / tone->half_height;
}

void rc_tone_terms(const rc_tone *tone, int px, int py, double terms[RC_TONE_TERMS]) {
  double x = unit_x(tone, px), y = unit_y(tone, py);
  terms[0] = 1, terms[1] = x, terms[2] = y;
  terms[3] = x * x, terms[4] = x * y, terms[5] = y * y;
}

double rc_tone_value(const rc_tone *tone, int channel, const double terms[RC_TONE_TERMS]) {
  double value = 0;
  for (int i = 0; i < TERMS; i++) value += tone->terms[channel][i] * terms[i];
  return value;
}

void rc_tone_at(const rc_tone *tone, int x, int y, double values[3]) {
  double terms[TERMS];
  rc_tone_terms(tone, within(x, tone->box.x0, tone->box.x1), within(y, tone->box.y0, tone->box.y1),
                terms);
  for (int k = 0; k < tone->channels; k++) values[k] = rc_tone_value(tone, k, terms);
}

bool rc_tone_drifts(const rc_tone *tone) {
  for (int k = 0; k < tone->channels; k++)
    for (int i = 1; i < TERMS; i++)
      if (tone->terms[k][i] != 0) return true;
  return false;
}

typedef struct application {
  const rc_tone *tone;
  const rc_mask *flags;
  uint8_t flag;
  float sign;
  rc_image *image;
} application;

static bool has_any(const uint8_t *flags, int count, uint8_t flag) {
  uint8_t any = 0;
  for (int i = 0; i < count; i++) any |= flags[i];
  return any & flag;
}

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  const rc_tone *tone = a->tone;
  double v = unit_y(tone, within(y, tone->box.y0, tone->box.y1));
  (void)thread;
  for (int first = 0; first < a->image->width; first += COLUMNS) {
    double u[COLUMNS], trend[COLUMNS];
    int count = a->image->width - first < COLUMNS ? a->image->width - first : COLUMNS;
    const uint8_t *flags = rc_flag(a->flags, first, y);
    float *pixels = rc_pixel(a->image, first, y);
    if (!has_any(flags, count, a->flag)) continue;
    for (int i = 0; i < COLUMNS; i++)
      u[i] = unit_x(tone, within(first + i, tone->box.x0, tone->box.x1));
    for (int k = 0; k < tone->channels; k++) {
      const double *own =
          tone->terms[k]; /* in the terms' order; the compiler makes vectors of it */
      for (int i = 0; i < COLUMNS; i++)
        trend[i] = own[0] + own[1] * u[i] + own[2] * v + own[3] * (u[i] * u[i]) +
                   own[4] * (u[i] * v) + own[5] * (v * v);
      for (int i = 0; i < count; i++)
        if (flags[i] & a->flag) pixels[i * tone->channels + k] += a->sign * (float)trend[i];
    }
  }
}

recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image) {
  application a = {tone, flags, flag, sign, image};
  return rc_parallel(context, image->height, apply_row, &a);
}
