/* A quantity that is linear over a picture, such as the plane's w, and where it lies within bounds.
 */
#ifndef RECEDE_IMAGE_LINE_H
#define RECEDE_IMAGE_LINE_H

#include <stdbool.h>

/* w(x, y) = a x + b y + c */
typedef struct rc_line {
  double a, b, c;
} rc_line;

static inline double rc_w(const rc_line *line, double x, double y) {
  return line->a * x + line->b * y + line->c;
}

/* The same in a picture of half the size, whose pixel (x, y) is that at (2 x + .5, 2 y + .5). */
static inline rc_line rc_line_halved(const rc_line *line) {
  return (rc_line){2 * line->a, 2 * line->b, rc_w(line, .5, .5)};
}

/* Pixels where least <= w <= most. */
typedef struct rc_band {
  rc_line w;
  double least, most;
} rc_band;

static inline bool rc_band_holds(const rc_band *band, double x, double y) {
  double w = rc_w(&band->w, x, y);
  return w >= band->least && w <= band->most;
}

#endif
