#include "image/distance.h"

#include <stddef.h>

static int least_of(int a, int b) { return a < b ? a : b; }
static uint8_t one_more(int v) { return (uint8_t)(v < 255 ? v + 1 : 255); }

/* What the row swept before allows; the compiler makes vectors of it. */
static void from_row(const uint8_t *restrict before, int width, int edge,
                     uint8_t *restrict distance) {
  for (int x = 1; x < width - 1; x++) {
    uint8_t least = before[x - 1] < before[x] ? before[x - 1] : before[x];
    least = least < before[x + 1] ? least : before[x + 1];
    least = (uint8_t)(least + (least < 255));
    distance[x] = distance[x] < least ? distance[x] : least;
  }
  for (int end = 0; end < 2; end++) {
    int x = end ? width - 1 : 0, inner = end ? x - 1 : x + 1;
    int least = least_of(before[x], edge);
    if (inner >= 0 && inner < width) least = least_of(least, before[inner]);
    distance[x] = (uint8_t)least_of(distance[x], one_more(least));
  }
}

static void along_row(int width, int step, int edge, uint8_t *distance) {
  int before = edge;
  for (int i = 0, x = step > 0 ? 0 : width - 1; i < width; i++, x += step) {
    before = least_of(distance[x], before + 1);
    distance[x] = (uint8_t)before;
  }
}

static void sweep(int width, int height, int step, int edge, uint8_t *distance) {
  for (int i = 0, y = step > 0 ? 0 : height - 1; i < height; i++, y += step) {
    uint8_t *row = distance + (size_t)y * (size_t)width;
    if (i)
      from_row(step > 0 ? row - width : row + width, width, edge, row);
    else if (!edge)
      for (int x = 0; x < width; x++) row[x] = row[x] ? 1 : 0;
    along_row(width, step, edge, row);
  }
}

void rc_distance_inside(const uint8_t *flags, uint8_t flag, int width, int height,
                        bool outside_ends, uint8_t *distance) {
  size_t count = (size_t)width * (size_t)height;
  int edge = outside_ends ? 0 : 255;
  for (size_t i = 0; i < count; i++) distance[i] = flags[i] & flag ? 255 : 0;
  sweep(width, height, 1, edge, distance);
  sweep(width, height, -1, edge, distance);
}
