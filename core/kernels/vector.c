/* The one vector source, built once for each instruction set with RC_KERNELS_NAME saying which:
 * plain loops over fixed lanes that the compiler turns into vectors. */
#include "kernels/kernels.h"

#define RC_STRING_(name) #name
#define RC_STRING(name) RC_STRING_(name)
#define RC_TABLE_(name) rc_kernels_##name
#define RC_TABLE(name) RC_TABLE_(name)

static uint32_t chunk(const rc_patch *restrict patch, const rc_footprint *restrict at, int first) {
  const int32_t *restrict lane_x = rc_lane_x + first, *restrict lane_y = rc_lane_y + first;
  uint32_t pixels[RC_PATCH_CHUNK];
  int32_t index[RC_PATCH_CHUNK];
  const uint32_t *origin = at->origin;
  int32_t stride = at->stride, x = at->x, y = at->y;
  int32_t xx = at->xx, xy = at->xy, yx = at->yx, yy = at->yy;
  for (int i = 0; i < RC_PATCH_CHUNK; i++)
    index[i] = ((y + yx * lane_x[i] + yy * lane_y[i]) >> 16) * stride +
               ((x + xx * lane_x[i] + xy * lane_y[i]) >> 16);
  for (int i = 0; i < RC_PATCH_CHUNK; i++) pixels[i] = origin[index[i]];
  /* Byte by byte, whose order in a pixel does not matter. Differences times weights fit 16 bits, of
   * which processors multiply and add pairs at once. */
  const uint8_t *restrict target = (const uint8_t *)(patch->pixel + first);
  const uint8_t *restrict found = (const uint8_t *)pixels;
  const int16_t *restrict weight = patch->weight[first];
  int32_t sum = 0;
  for (int i = 0; i < RC_PATCH_CHUNK * RC_COMPONENTS; i++) {
    int16_t difference = (int16_t)(target[i] - found[i]);
    int16_t weighted = (int16_t)(difference * weight[i]);
    sum += difference * weighted;
  }
  return (uint32_t)sum;
}

static uint32_t distance(const rc_patch *patch, const rc_footprint *footprint, uint32_t limit) {
  uint32_t sum = chunk(patch, footprint, 0);
  if (sum >= limit) return sum;
  sum += chunk(patch, footprint, RC_PATCH_CHUNK);
  if (sum >= limit) return sum;
  return sum + chunk(patch, footprint, 2 * RC_PATCH_CHUNK);
}

const rc_kernels RC_TABLE(RC_KERNELS_NAME) = {RC_STRING(RC_KERNELS_NAME), distance};
