/* Logarithm and angle from additions, products and divisions alone: the C library's own differ in
 * the last bit between machines with and without fused multiply-add, and are slower. Four at once.
 */
#ifndef RECEDE_PLANE_APPROXIMATE_H
#define RECEDE_PLANE_APPROXIMATE_H

#include "base/four.h"

/* log2 of positive, normal values; error < 1e-6. */
static inline rc_four rc_log2_of_four(rc_four value) {
  rc_four_words bits = (rc_four_words)value;
  rc_four_ints exponent = (rc_four_ints)(bits >> 23) - 127;
  rc_four mantissa = (rc_four)((bits & 0x7fffff) | 0x3f800000);
  rc_four_ints large = mantissa > 1.41421356f;
  mantissa = rc_select(large, mantissa * .5f, mantissa), exponent -= large;
  /* ln m = 2 atanh((m - 1) / (m + 1)), |argument| < .172 */
  rc_four t = (mantissa - 1) / (mantissa + 1), s = t * t;
  return __builtin_convertvector(exponent, rc_four) +
         t * (2.88539008f + s * (.961796694f + s * (.577078016f + s * .412198583f)));
}

static inline float rc_log2(float value) {
  return rc_log2_of_four((rc_four){value, value, value, value})[0];
}

/* Directions of lines through the origin and (x, y), in half turns, [0, 1]; error < 1e-6. */
static inline rc_four rc_half_turns_of_four(rc_four x, rc_four y) {
  rc_four_ints below = y < 0;
  x = rc_select(below, -x, x), y = rc_select(below, -y, y);
  rc_four ax = rc_select(x < 0, -x, x);
  rc_four_ints steep = ax < y;
  rc_four small = rc_select(steep, ax, y), large = rc_select(steep, y, ax);
  rc_four t = rc_select(large > 0, small / large, (rc_four){0}), s = t * t;
  /* Least-squares fit of atan(t) / pi, weighted to an even error. */
  rc_four tail = -.04212260f + s * (.02534418f + s * (-.01069582f + s * .00216801f));
  rc_four angle = t * (.31830865f + s * (-.10605246f + s * (.06305013f + s * tail)));
  angle = rc_select(steep, .5f - angle, angle);
  return rc_select(x < 0, 1 - angle, angle);
}

#endif
