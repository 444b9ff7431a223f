#include "image/distance.h"

#include <stddef.h>
#include <string.h>

#include "base/memory.h"

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

/* A picture's part, its rows so many pixels apart. */
typedef struct part {
  int width, height;
  ptrdiff_t stride;
} part;

static void sweep(part of, int step, int edge, uint8_t *distance) {
  for (int i = 0, y = step > 0 ? 0 : of.height - 1; i < of.height; i++, y += step) {
    uint8_t *row = distance + y * of.stride;
    if (i)
      from_row(row - step * of.stride, of.width, edge, row);
    else if (!edge)
      for (int x = 0; x < of.width; x++) row[x] = row[x] ? 1 : 0;
    along_row(of.width, step, edge, row);
  }
}

/* What has a distance, and a pixel more on each side where the picture goes on: all else is 0, and
 * a hole is a small part of its picture. */
static rc_box part_with_any(const uint8_t *distance, int width, int height) {
  rc_box box = {width, height, 0, 0};
  for (int y = 0; y < height; y++) {
    const uint8_t *row = distance + (size_t)y * (size_t)width;
    const uint8_t *first = memchr(row, 255, (size_t)width);
    if (!first) continue;
    int x0 = (int)(first - row), x1 = width;
    while (!row[x1 - 1]) x1--;
    if (!box.y1) box.y0 = y;
    box.y1 = y + 1;
    box.x0 = x0 < box.x0 ? x0 : box.x0, box.x1 = x1 > box.x1 ? x1 : box.x1;
  }
  box.x0 -= box.x0 > 0, box.y0 -= box.y0 > 0;
  box.x1 += box.x1 < width, box.y1 += box.y1 < height;
  return box;
}

void rc_distance_inside(const uint8_t *flags, uint8_t flag, int width, int height,
                        bool outside_ends, uint8_t *distance) {
  size_t count = (size_t)width * (size_t)height;
  int edge = outside_ends ? 0 : 255;
  for (size_t i = 0; i < count; i++) distance[i] = flags[i] & flag ? 255 : 0;
  rc_box box = part_with_any(distance, width, height);
  part of = {box.x1 - box.x0, box.y1 - box.y0, width};
  if (of.width <= 0) return;
  distance += (size_t)box.y0 * (size_t)width + (size_t)box.x0;
  sweep(of, 1, edge, distance);
  sweep(of, -1, edge, distance);
}

/* Whether so many columns side by side, with those beyond the ends, have had the flag for so many
 * rows. */
static bool has_run(const int *rows, int width, int side) {
  int run = side / 2;
  for (int x = 0; x < width; x++) {
    run = rows[x] >= side ? run + 1 : 0;
    if (run >= side) return true;
  }
  return width && run + side / 2 >= side;
}

recede_status rc_is_deep(rc_context *context, const rc_mask *flags, uint8_t flag, int px,
                         bool *deep) {
  int side = 2 * px - 1, width = flags->width, height = flags->height;
  int *rows; /* of each column, up to here and without a break */
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, width, &rows));
  for (int x = 0; x < width; x++) rows[x] = px - 1;
  *deep = false;
  for (int y = 0; y < height + px - 1 && !*deep; y++) {
    const uint8_t *row = y < height ? rc_flag(flags, 0, y) : NULL;
    int most = 0;
    for (int x = 0; x < width; x++) {
      rows[x] = !row || row[x] & flag ? rows[x] + 1 : 0;
      most = rows[x] > most ? rows[x] : most;
    }
    *deep = most >= side && has_run(rows, width, side);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
