/* What is done with floats. exp2 and log2 have the same bits on every machine: the C library's
 * choose other code by processor. Good to a float's precision. */
#ifndef RECEDE_BASE_REAL_H
#define RECEDE_BASE_REAL_H

#include <stdint.h>
#include <string.h>

/* v > 0, finite, not subnormal. log2 m = (2 / ln 2) atanh((m - 1) / (m + 1)), m in [.70, 1.42). */
static inline float rc_log2(float v) {
  uint32_t bits;
  memcpy(&bits, &v, 4);
  int exponent = (int)((bits - 0x3f350000u) >> 23);
  if (exponent > 127) exponent -= 512;
  bits -= (uint32_t)exponent << 23;
  float mantissa;
  memcpy(&mantissa, &bits, 4);
  double z = ((double)mantissa - 1.) / ((double)mantissa + 1.), s = z * z;
  double series = 1. + s * (1. / 3 + s * (1. / 5 + s * (1. / 7 + s * (1. / 9 + s / 11))));
  return (float)((double)exponent + 2.8853900817779268 * z * series);
}

/* 2^v; 0 below -126, clamped above 127. Taylor series of e^(f ln 2), |f| <= 1/2. */
static inline float rc_exp2(float v) {
  if (v < -126.f) return 0.f;
  if (v > 127.f) v = 127.f;
  int whole = (int)(v + (v < 0.f ? -.5f : .5f));
  double f = ((double)v - whole) * 0.69314718055994531;
  double e =
      1. +
      f * (1. + f / 2 * (1. + f / 3 * (1. + f / 4 * (1. + f / 5 * (1. + f / 6 * (1. + f / 7))))));
  uint32_t bits = (uint32_t)(whole + 127) << 23;
  float power;
  memcpy(&power, &bits, 4);
  return (float)(e * (double)power);
}

/* For qsort, of floats: the smallest first. */
static inline int rc_by_value(const void *a, const void *b) {
  float p = *(const float *)a, q = *(const float *)b;
  return (p > q) - (p < q);
}

/* floorf and roundf without calls into the C library, which is what a compiler makes of them for
 * plain x86-64. rc_floor: |v| < 2^24. */
static inline int rc_floor(float v) {
  int whole = (int)v;
  return whole - (v < (float)whole);
}
static inline float rc_round(float v) {
  if (!(v > -8388608.f && v < 8388608.f)) return v; /* whole already, or NaN */
  float whole = (float)(int)v, rest = v - whole;
  return whole + (float)((rest >= .5f) - (rest <= -.5f));
}

static inline float rc_exp(float v) { return rc_exp2(v * 1.44269504f); }

#endif
