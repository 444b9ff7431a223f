/* The start of the paper's section 4: "choosing the points in the output image having the same
 * scale values as that of the input sample". */
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/paper/level.h"
#include "synthesis/paper/scale_channel.h"

typedef struct scaled_pixel {
  float scale;
  uint32_t index; /* y * width + x in the exemplar */
} scaled_pixel;

static uint32_t key_bits(float positive) {
  uint32_t bits;
  memcpy(&bits, &positive, sizeof bits);
  return bits;
}

/* By scale, two passes of 16 bits: positive floats sort as their bits do. */
static recede_status sort(rc_context *context, scaled_pixel *pixels, size_t count) {
  scaled_pixel *swap;
  size_t *place;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &swap));
  RC_TRY(RC_NEW(context, 65537, &place));
  for (int shift = 0; shift <= 16; shift += 16) {
    memset(place, 0, 65537 * sizeof *place);
    for (size_t i = 0; i < count; i++) place[(key_bits(pixels[i].scale) >> shift & 65535) + 1]++;
    for (int b = 0; b < 65536; b++) place[b + 1] += place[b];
    for (size_t i = 0; i < count; i++)
      swap[place[key_bits(pixels[i].scale) >> shift & 65535]++] = pixels[i];
    memcpy(pixels, swap, count * sizeof *pixels);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}

static recede_status sorted_sources(rc_context *context, const rc_side *exemplar,
                                    scaled_pixel **pixels, size_t *count) {
  int width = exemplar->image.width, height = exemplar->image.height;
  RC_TRY(RC_NEW(context, (size_t)width * (size_t)height, pixels));
  *count = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      if (*rc_flag(&exemplar->flags, x, y) & RC_SOURCE)
        (*pixels)[(*count)++] = (scaled_pixel){rc_scale(&exemplar->scale, x, y),
                                               (uint32_t)y * (uint32_t)width + (uint32_t)x};
  return sort(context, *pixels, *count);
}

/* First place whose scale is not below the value. */
static size_t lower_bound(const scaled_pixel *pixels, size_t count, float scale) {
  size_t low = 0, high = count;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (pixels[middle].scale < scale)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Widens first..end, always to the side that is nearer in scale, until it holds enough. */
static void widen(const scaled_pixel *pixels, size_t count, float scale, size_t *first,
                  size_t *end) {
  while (*end - *first < RC_SCALE_CANDIDATES && *end - *first < count) {
    bool down = *first > 0 &&
                (*end == count || scale - pixels[*first - 1].scale < pixels[*end].scale - scale);
    if (down)
      --*first;
    else
      ++*end;
  }
}

recede_status rc_paper_start(rc_context *context, rc_paper_level *level, uint64_t seed) {
  rc_side *output = &level->output;
  scaled_pixel *pixels;
  size_t count;
  uint64_t key = rc_key(seed, 1, 0);
  rc_block *mark = rc_mark(context);
  RC_TRY(sorted_sources(context, &level->exemplar, &pixels, &count));
  for (int y = 0; y < output->image.height; y++) {
    for (int x = 0; x < output->image.width && count; x++) {
      if (!rc_unknown(output, x, y)) continue;
      float scale = rc_scale(&output->scale, x, y);
      size_t first = lower_bound(pixels, count, scale * (1 - RC_SCALE_TOLERANCE));
      size_t end = lower_bound(pixels, count, scale * (1 + RC_SCALE_TOLERANCE));
      widen(pixels, count, scale, &first, &end);
      double unit = rc_unit(rc_random(key, (uint32_t)x, (uint32_t)y, 0));
      size_t pick = first + (size_t)(unit * (double)(end - first));
      memcpy(rc_pixel(&output->image, x, y),
             level->exemplar.image.data +
                 (size_t)pixels[pick].index * (size_t)level->exemplar.image.channels,
             (size_t)level->colours * sizeof(float));
    }
    RC_TRY(rc_poll(context));
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
