#include "synthesis/sources/looks.h"

#include <math.h>

/* So much of the square must be known. */
#define LEAST_KNOWN .4

/* Of known pixels: how many, colours, brightness and its square. */
typedef struct sums {
  double known, colour[3], bright, square;
} sums;

static void add(sums *to, const sums *s) {
  to->known += s->known, to->bright += s->bright, to->square += s->square;
  for (int k = 0; k < 3; k++) to->colour[k] += s->colour[k];
}

static sums pixel_sums(const rc_image *image, const rc_mask *flags, int x, int y) {
  sums s = {0, {0, 0, 0}, 0, 0};
  if (!(*rc_flag(flags, x, y) & RC_KNOWN)) return s;
  const float *v = rc_pixel(image, x, y);
  bool grey = image->channels == 1;
  s.known = 1;
  for (int k = 0; k < 3; k++) s.colour[k] = v[grey ? 0 : k];
  s.bright = rc_brightness_at(image, x, y);
  s.square = s.bright * s.bright;
  return s;
}

bool rc_look(const rc_image *image, const rc_mask *flags, int x, int y, int half_px,
             rc_looks *out) {
  int x0 = x < half_px ? 0 : x - half_px, y0 = y < half_px ? 0 : y - half_px;
  int x1 = x + half_px >= image->width ? image->width : x + half_px + 1;
  int y1 = y + half_px >= image->height ? image->height : y + half_px + 1;
  sums sum = {0, {0, 0, 0}, 0, 0};
  for (int j = y0; j < y1; j++)
    for (int i = x0; i < x1; i++) {
      sums s = pixel_sums(image, flags, i, j);
      add(&sum, &s);
    }
  if (sum.known < LEAST_KNOWN * (x1 - x0) * (y1 - y0)) return false;
  for (int k = 0; k < 3; k++)
    out->value[k] = (float)(sum.colour[k] / sum.known * .57735026918962576);
  double bright = sum.bright / sum.known;
  out->value[3] = (float)sqrt(fmax(sum.square / sum.known - bright * bright, 0));
  return true;
}
