/* The specification: one pixel after the other. */
#include "kernels/kernels.h"

static uint32_t distance(const rc_patch *patch, const rc_footprint *footprint, uint32_t limit) {
  uint32_t sum = 0;
  (void)limit;
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    int32_t ox = rc_lane_x[i], oy = rc_lane_y[i];
    int32_t sx = (footprint->x + footprint->xx * ox + footprint->xy * oy) >> 16;
    int32_t sy = (footprint->y + footprint->yx * ox + footprint->yy * oy) >> 16;
    uint32_t pixel = footprint->origin[(ptrdiff_t)sy * footprint->stride + sx];
    int32_t square = 0;
    for (int k = 0; k < RC_COMPONENTS; k++) {
      int32_t difference =
          (int32_t)(patch->pixel[i] >> 8 * k & 255) - (int32_t)(pixel >> 8 * k & 255);
      square += difference * difference;
    }
    sum += (uint32_t)(patch->weight[i][0] * square);
  }
  return sum;
}

const rc_kernels rc_kernels_reference = {"reference", distance};
