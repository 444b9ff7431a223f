/* Pixels whose gradients point the same way grow together into a region; a region that is long and
 * thin is a segment along its main axis (the idea of Burns et al. and of LSD). */
#include "plane/segments.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/spread.h"

/* Weakest gradient, in values per px: twice what rounding to 8 bits can make. */
#define LEAST_GRADIENT .02f
/* Cosine of the angle within which a pixel follows its region: 22.5 degrees. */
#define SAME_DIRECTION .92f
/* Shortest segment, of the picture's long side; and how many times longer than wide. */
#define LEAST_LENGTH .03f
#define LEAST_ASPECT 6

typedef struct edge_map {
  int width, height;
  float *gx, *gy, *strength;
  uint8_t *used;
  int *queue, *order;
} edge_map;

/* Roberts' differences turned by 45 degrees: the mean difference over a 2 x 2 square. */
static void take_gradient(const rc_image *image, const rc_mask *flags, edge_map *map, int x,
                          int y) {
  size_t at = (size_t)y * (size_t)map->width + (size_t)x;
  float v[4] = {0, 0, 0, 0};
  for (int i = 0; i < 4; i++) {
    int px = x + (i & 1), py = y + (i >> 1);
    if (!(*rc_flag(flags, px, py) & RC_SOURCE)) return;
    const float *pixel = rc_pixel(image, px, py);
    for (int k = 0; k < image->channels; k++) v[i] += pixel[k] / (float)image->channels;
  }
  float gx = .5f * (v[1] - v[0] + v[3] - v[2]), gy = .5f * (v[2] - v[0] + v[3] - v[1]);
  float strength = sqrtf(gx * gx + gy * gy);
  if (strength < LEAST_GRADIENT) return;
  map->gx[at] = gx / strength, map->gy[at] = gy / strength;
  map->strength[at] = strength;
}

static recede_status make_map(rc_context *context, const rc_image *image, const rc_mask *flags,
                              edge_map *map) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  *map = (edge_map){.width = image->width, .height = image->height};
  RC_TRY(RC_NEW_ZERO(context, pixels, &map->gx));
  RC_TRY(RC_NEW_ZERO(context, pixels, &map->gy));
  RC_TRY(RC_NEW_ZERO(context, pixels, &map->strength));
  RC_TRY(RC_NEW_ZERO(context, pixels, &map->used));
  RC_TRY(RC_NEW(context, pixels, &map->queue));
  RC_TRY(RC_NEW(context, pixels, &map->order));
  for (int y = 0; y + 1 < map->height; y++) {
    for (int x = 0; x + 1 < map->width; x++) take_gradient(image, flags, map, x, y);
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

#define BUCKETS 64

/* Pixels by falling strength, in buckets: strong edges start the regions. */
static int sort_pixels(const edge_map *map) {
  int pixels = map->width * map->height, start[BUCKETS + 1] = {0};
  for (int pass = 0; pass < 2; pass++) {
    for (int i = 0; i < pixels; i++) {
      if (map->strength[i] == 0) continue;
      int bucket = BUCKETS - 1 - (int)fminf(map->strength[i] * 128, BUCKETS - 1);
      if (pass == 0)
        start[bucket + 1]++;
      else
        map->order[start[bucket]++] = i;
    }
    for (int b = 0; pass == 0 && b < BUCKETS; b++) start[b + 1] += start[b];
  }
  return start[BUCKETS];
}

static int grow(const edge_map *map, int seed) {
  int count = 1;
  float sx = map->gx[seed], sy = map->gy[seed];
  map->queue[0] = seed;
  map->used[seed] = 1;
  for (int i = 0; i < count; i++) {
    int x = map->queue[i] % map->width, y = map->queue[i] / map->width;
    for (int k = 0; k < 9; k++) {
      int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
      if (!rc_inside(map->width, map->height, nx, ny)) continue;
      int at = ny * map->width + nx;
      if (map->used[at] || map->strength[at] == 0) continue;
      float along = sx * map->gx[at] + sy * map->gy[at];
      if (along < 0 || along * along < SAME_DIRECTION * SAME_DIRECTION * (sx * sx + sy * sy))
        continue;
      map->used[at] = 1;
      map->queue[count++] = at;
      sx += map->gx[at], sy += map->gy[at];
    }
  }
  return count;
}

/* Main axis from the second moments; a line of length L has variance L^2 / 12 along itself. */
static bool fit_segment(const edge_map *map, int count, rc_segment *segment) {
  double sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  for (int i = 0; i < count; i++) {
    double x = map->queue[i] % map->width, y = map->queue[i] / map->width;
    sx += x, sy += y, xx += x * x, yy += y * y, xy += x * y;
  }
  sx /= count, sy /= count;
  xx = xx / count - sx * sx, yy = yy / count - sy * sy, xy = xy / count - sx * sy;
  rc_spread spread;
  if (!rc_spread_of(xx, xy, yy, &spread)) return false;
  int longer = map->width > map->height ? map->width : map->height;
  *segment = (rc_segment){(float)sx + .5f, (float)sy + .5f, (float)spread.x, (float)spread.y,
                          (float)sqrt(12 * spread.great)};
  return segment->length >= LEAST_LENGTH * (float)longer &&
         spread.great >= LEAST_ASPECT * LEAST_ASPECT * spread.little;
}

static int longer_first(const void *a, const void *b) {
  const rc_segment *s = a, *t = b;
  if (s->length != t->length) return s->length < t->length ? 1 : -1;
  if (s->y != t->y) return s->y > t->y ? 1 : -1;
  return (s->x > t->x) - (s->x < t->x);
}

recede_status rc_segments_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                               rc_segment segments[RC_MOST_SEGMENTS], int *count) {
  rc_block *mark = rc_mark(context);
  edge_map map;
  rc_segment *all;
  int found = 0;
  RC_TRY(make_map(context, image, flags, &map));
  int pixels = sort_pixels(&map), room = pixels / 8 + 1; /* a region has at least 8 pixels */
  RC_TRY(RC_NEW(context, room, &all));
  for (int i = 0; i < pixels; i++) {
    if (map.used[map.order[i]]) continue;
    int size = grow(&map, map.order[i]);
    if (size >= 8 && fit_segment(&map, size, &all[found])) found++;
    if (i % 1024 == 0) RC_TRY(rc_poll(context));
  }
  qsort(all, (size_t)found, sizeof *all, longer_first);
  *count = found < RC_MOST_SEGMENTS ? found : RC_MOST_SEGMENTS;
  for (int i = 0; i < *count; i++) segments[i] = all[i];
  rc_release(context, mark);
  return RECEDE_OK;
}
