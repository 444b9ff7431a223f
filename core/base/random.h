/* Counter-based random numbers: a pure function of the seed and of where and when the number is
 * needed, so that threads and tile orders cannot change it. */
#ifndef RECEDE_BASE_RANDOM_H
#define RECEDE_BASE_RANDOM_H

#include <stdint.h>

/* The finaliser of SplitMix64: every input bit flips each output bit with probability ~1/2. */
static inline uint64_t rc_mix(uint64_t v) {
  v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
  v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
  return v ^ (v >> 31);
}
/* Key of a stage: seed and two small counters (level, iteration ...). */
static inline uint64_t rc_key(uint64_t seed, uint32_t a, uint32_t b) {
  return rc_mix(rc_mix(seed + 0x9e3779b97f4a7c15u) + ((uint64_t)a << 32 | b));
}
/* 64 random bits for the n-th draw at (x, y). */
static inline uint64_t rc_random(uint64_t key, uint32_t x, uint32_t y, uint32_t n) {
  return rc_mix(key ^ rc_mix(((uint64_t)y << 32 | x) * 0x9e3779b97f4a7c15u + n));
}
/* Uniform integer in [0, range), range < 2^31, from 32 of the bits. */
static inline uint32_t rc_below(uint32_t bits, uint32_t range) {
  return (uint32_t)(((uint64_t)bits * range) >> 32);
}
/* Uniform in [0, 1). */
static inline double rc_unit(uint64_t bits) { return (double)(bits >> 11) * 0x1p-53; }

#endif
