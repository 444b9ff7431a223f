#include "image/distance.h"

#include <stddef.h>

/* One pixel of a sweep: the least of the neighbours already swept, plus one. */
static void relax(uint8_t *distance, int width, int height, int x, int y, int step, int edge) {
  uint8_t *at = distance + (size_t)y * (size_t)width + (size_t)x;
  int least = x - step < 0 || x - step >= width ? edge : at[-step], ny = y - step;
  for (int d = -1; d <= 1; d++) {
    bool inside = ny >= 0 && ny < height && x + d >= 0 && x + d < width;
    int v = inside ? distance[(size_t)ny * (size_t)width + (size_t)(x + d)] : edge;
    if (v < least) least = v;
  }
  if (least + 1 < *at) *at = (uint8_t)(least + 1);
}

void rc_distance_inside(const uint8_t *flags, uint8_t flag, int width, int height,
                        bool outside_ends, uint8_t *distance) {
  size_t count = (size_t)width * (size_t)height;
  int edge = outside_ends ? 0 : 255;
  for (size_t i = 0; i < count; i++) distance[i] = flags[i] & flag ? 255 : 0;
  for (size_t i = 0; i < count; i++)
    if (distance[i])
      relax(distance, width, height, (int)(i % (size_t)width), (int)(i / (size_t)width), 1, edge);
  for (size_t i = count; i-- > 0;)
    if (distance[i])
      relax(distance, width, height, (int)(i % (size_t)width), (int)(i / (size_t)width), -1, edge);
}
