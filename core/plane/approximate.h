/* Logarithm and angle from additions, products and divisions alone: the C library's own differ in
 * the last bit between machines with and without fused multiply-add, and are slower. */
#ifndef RECEDE_PLANE_APPROXIMATE_H
#define RECEDE_PLANE_APPROXIMATE_H

#include <stdint.h>
#include <string.h>

/* log2 of a positive, normal value; error < 1e-6. */
static inline float rc_log2(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof bits);
  int exponent = (int)(bits >> 23) - 127;
  bits = (bits & 0x7fffff) | 0x3f800000;
  float mantissa;
  memcpy(&mantissa, &bits, sizeof mantissa);
  if (mantissa > 1.41421356f) mantissa *= .5f, exponent++;
  /* ln m = 2 atanh((m - 1) / (m + 1)), |argument| < .172 */
  float t = (mantissa - 1) / (mantissa + 1), s = t * t;
  return (float)exponent +
         t * (2.88539008f + s * (.961796694f + s * (.577078016f + s * .412198583f)));
}

/* Direction of a line through the origin and (x, y), in half turns, [0, 1]; error < 1e-6. */
static inline float rc_half_turns(float x, float y) {
  if (y < 0) x = -x, y = -y;
  float ax = x < 0 ? -x : x;
  float small = ax < y ? ax : y, large = ax < y ? y : ax;
  float t = large > 0 ? small / large : 0, s = t * t;
  /* Least-squares fit of atan(t) / pi, weighted to an even error. */
  float tail = -.04212260f + s * (.02534418f + s * (-.01069582f + s * .00216801f));
  float angle = t * (.31830865f + s * (-.10605246f + s * (.06305013f + s * tail)));
  if (ax < y) angle = .5f - angle;
  return x < 0 ? 1 - angle : angle;
}

#endif
