#include "synthesis/structure/sides.h"

#include <math.h>
#include <stddef.h>

/* So far from where they meet a place is half of its side, px of the finest level: beside it lie
 * kerbs and gutters, which are not to be copied farther in. */
#define HALF_PX 8.f

/* Bilinear; beyond the map's end as at it. */
static float distance_at(const rc_regions *map, float x, float y) {
  float px = fminf(fmaxf(x - (float)map->x0, 0.f), (float)(map->width - 1));
  float py = fminf(fmaxf(y - (float)map->y0, 0.f), (float)(map->height - 1));
  int ix = (int)px, iy = (int)py;
  size_t right = ix + 1 < map->width ? 1 : 0;
  size_t below = iy + 1 < map->height ? (size_t)map->width : 0;
  const float *v = map->distance + (size_t)iy * (size_t)map->width + (size_t)ix;
  float fx = px - (float)ix, fy = py - (float)iy;
  float upper = v[0] * (1.f - fx) + v[right] * fx;
  float lower = v[below] * (1.f - fx) + v[below + right] * fx;
  return upper * (1.f - fy) + lower * fy;
}

/* px of the level, in the picture. */
static float far_from(const rc_sides *sides, const rc_chart *chart, int boundary, float x,
                      float y) {
  const rc_boundary *b = &sides->boundaries[boundary];
  const rc_regions *map = &sides->regions;
  if (!map->distance) return b->nx * x + b->ny * y + b->at;
  float unit = sides->px / map->px;
  return distance_at(map, (x + chart->x0 + .5f) * unit - .5f, (y + chart->y0 + .5f) * unit - .5f) /
         unit;
}

float rc_side(const rc_sides *sides, const rc_chart *chart, float x, float y) {
  float w = 1.f + chart->lx * x + chart->ly * y, side = 0.f;
  int count = sides->regions.distance ? 1 : sides->boundary_count;
  if (sides->one_ground) return far_from(sides, chart, 0, x, y) / w * sides->px / HALF_PX;
  for (int i = 0; i < count; i++) {
    float far = far_from(sides, chart, i, x, y) / w;
    side += far / (fabsf(far) + HALF_PX / sides->px);
  }
  return side;
}

/* On one ground the distances lie on a circle, so that both ends are the same. */
float rc_sides_square(const rc_sides *sides, float side, float other) {
  float square = (side - other) * (side - other);
  return sides->one_ground ? 4.f * square / ((1.f + side * side) * (1.f + other * other)) : square;
}

bool rc_is_other_side(const rc_sides *sides, const rc_chart *chart, float x, float y) {
  return far_from(sides, chart, 0, x, y) < 0.f;
}
