/* Patch distances: a table of functions, one for each instruction set. Integers only, so that every
 * one gives the reference's bytes. */
#ifndef RECEDE_KERNELS_KERNELS_H
#define RECEDE_KERNELS_KERNELS_H

#include <stddef.h>
#include <stdint.h>

#define RC_PATCH_RADIUS 4
#define RC_PATCH_WIDTH (2 * RC_PATCH_RADIUS + 1)
#define RC_PATCH_PIXELS (RC_PATCH_WIDTH * RC_PATCH_WIDTH)
/* The pixels of a patch in an order that spreads each third over the whole patch, so that a bad
 * candidate is recognised after the first; padded with weightless pixels to whole vectors. */
#define RC_PATCH_CHUNK 32
#define RC_PATCH_LANES (3 * RC_PATCH_CHUNK)

/* Bytes of a pixel, the first the lowest: red, green, blue and 0, or other traits. */
#define RC_COMPONENTS 4
/* Largest weight of a pixel: 4 * 255^2 * 64 * 81 < 2^31. */
#define RC_WEIGHT_ONE 64

/* One patch of the target, gathered once and compared with many candidates. */
typedef struct rc_patch {
  uint32_t pixel[RC_PATCH_LANES];
  int16_t weight[RC_PATCH_LANES][RC_COMPONENTS]; /* 0..RC_WEIGHT_ONE, the same for all of a pixel */
} rc_patch;

/* Where a candidate's pixels lie: pixel (ox, oy) of the patch at origin[sy * stride + sx],
 * sx = (x + xx ox + xy oy) >> 16, sy = (y + yx ox + yy oy) >> 16 (16.16 fixed point, arithmetic
 * shift; x and y hold the fraction and the rounding's half). */
typedef struct rc_footprint {
  const uint32_t *origin;
  int32_t stride;
  int32_t x, y, xx, xy, yx, yy;
} rc_footprint;

/* Sum over the patch of weight * squared distance over the components. May stop and return any
 * value >= limit once the sum has reached it. */
typedef uint32_t rc_distance_kernel(const rc_patch *patch, const rc_footprint *footprint,
                                    uint32_t limit);

typedef struct rc_kernels {
  const char *name;
  rc_distance_kernel *distance;
} rc_kernels;

/* The offsets of a patch's lanes. */
extern const int32_t rc_lane_x[RC_PATCH_LANES], rc_lane_y[RC_PATCH_LANES];

/* index -1: the best this machine runs; else the index-th of all; NULL past the last or when this
 * machine cannot run it. Index 0 is the reference. */
const rc_kernels *rc_kernels_select(int index);

extern const rc_kernels rc_kernels_reference, rc_kernels_baseline, rc_kernels_avx2,
    rc_kernels_avx512;

#endif
