#include "synthesis/level.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/distance.h"

/* Ratios of s = ratio^1.5 in .9 .. 1.2: wider ones score the same on flat patterns but lean and
 * stretch real stones. */
#define NARROW_LOW .932f
#define NARROW_HIGH 1.129f
/* A class's range is widened until it holds this many times its target's pixels in sources. */
#define ENOUGH_SOURCE 2.0
#define LEAST_SOURCE_PIXELS 64
#define WIDEN_BY 1.3f
/* Each single depth needs at least these; more would widen ordinary holes at the coarsest level,
 * where a row of the picture has few pixels. */
#define LEAST_REACHED 8
#define REACH_BY 1.05f
#define WIDEST 8.f

static uint32_t encode(float value, float gain) {
  float byte = value * gain + 128.5f;
  return byte < 0.f ? 0u : byte >= 255.f ? 255u : (uint32_t)byte;
}

static void pack(const rc_image *image, float gain, uint32_t *pixels) {
  size_t count = (size_t)image->width * (size_t)image->height;
  const float *v = image->data;
  if (image->channels == 1)
    for (size_t i = 0; i < count; i++) pixels[i] = encode(v[i], gain) * 0x010101u;
  else
    for (size_t i = 0; i < count; i++)
      pixels[i] = encode(v[3 * i], gain) | encode(v[3 * i + 1], gain) << 8 |
                  encode(v[3 * i + 2], gain) << 16;
}

static void set_weights(rc_level *level, float gamma) {
  uint8_t table[256];
  size_t count = (size_t)level->width * (size_t)level->height;
  for (int i = 0; i < 256; i++) {
    float weight = RC_WEIGHT_ONE * rc_exp2(-(float)i * rc_log2(gamma));
    table[i] = weight < 1.f ? 1 : (uint8_t)(weight + .5f);
  }
  rc_distance_inside(level->flags, RC_TARGET, level->width, level->height, false, level->weight);
  for (size_t i = 0; i < count; i++)
    level->weight[i] = level->flags[i] & RC_TARGET  ? table[level->weight[i]]
                       : level->flags[i] & RC_KNOWN ? RC_WEIGHT_ONE
                                                    : 0;
}

static void find_box(rc_level *level) {
  rc_box box = {level->width, level->height, 0, 0};
  for (int y = 0; y < level->height; y++)
    for (int x = 0; x < level->width; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      if (x < box.x0) box.x0 = x;
      if (x >= box.x1) box.x1 = x + 1;
      if (y < box.y0) box.y0 = y;
      box.y1 = y + 1;
    }
  level->box = box;
  level->box_w = box.x1 - box.x0;
  level->box_h = box.y1 - box.y0;
}

static void set_variance(rc_level *level) {
  double sum[3] = {0}, square[3] = {0}, count = 0, total = 0;
  for (size_t i = 0; i < (size_t)level->width * (size_t)level->height; i++) {
    if (!(level->flags[i] & RC_SOURCE)) continue;
    count++;
    for (int k = 0; k < 3; k++) {
      double v = level->pixels[i] >> 8 * k & 255;
      sum[k] += v, square[k] += v * v;
    }
  }
  for (int k = 0; k < 3 && count > 0; k++)
    total += square[k] / count - sum[k] / count * (sum[k] / count);
  level->variance = fmaxf((float)(total / 3), 1.f);
}

static recede_status for_each_source(rc_context *context, rc_level *level, int32_t *fill) {
  for (int y = 0; y < level->height; y++) {
    RC_TRY(rc_poll(context));
    for (int x = 0; x < level->width; x++) {
      size_t i = (size_t)y * (size_t)level->width + (size_t)x;
      if (level->room[i] <= RC_PATCH_RADIUS + 1) continue;
      float w = rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
      if (!(w > 0.f)) continue;
      int bin = (int)((rc_log2(w) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE);
      bin = bin < 0 ? 0 : bin >= level->bins ? level->bins - 1 : bin;
      if (level->order)
        level->order[fill[bin]++] = (int32_t)i;
      else
        fill[bin]++;
    }
  }
  return RECEDE_OK;
}

/* A counting sort of the sources by log2 w. */
static recede_status sort_sources(rc_context *context, rc_level *level) {
  int32_t count[RC_MAX_BINS] = {0};
  float least = 1e9f, most = 1e-9f;
  for (int c = 0; c < 4; c++) {
    float w = rc_level_w(level, rc_level_x(level, c & 1 ? level->width - 1 : 0),
                         rc_level_y(level, c & 2 ? level->height - 1 : 0));
    least = fminf(least, w), most = fmaxf(most, w);
  }
  least = fmaxf(least, .02f);
  most = fmaxf(most, least);
  level->bin_log2_w0 = rc_log2(least);
  level->bins = (int)(rc_log2(most / least) * RC_BINS_PER_OCTAVE) + 1;
  if (level->bins > RC_MAX_BINS) level->bins = RC_MAX_BINS;
  level->order = NULL;
  RC_TRY(for_each_source(context, level, count));
  level->first[0] = 0;
  for (int b = 0; b < level->bins; b++) {
    level->first[b + 1] = level->first[b] + count[b];
    count[b] = level->first[b];
  }
  RC_TRY(RC_NEW(context, level->first[level->bins] + 1, &level->order));
  return for_each_source(context, level, count);
}

/* Sources with w in low..high: a run of level->order. */
static void bins_between(const rc_level *level, float low, float high, int *begin, int *end) {
  int from = rc_floor((rc_log2(low) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE);
  int to = rc_floor((rc_log2(high) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE) + 1;
  from = from < 0 ? 0 : from > level->bins ? level->bins : from;
  to = to < from ? from : to > level->bins ? level->bins : to;
  *begin = level->first[from];
  *end = level->first[to];
}

static float log2_w_at(const rc_level *level, int x, int y) {
  return rc_log2(fmaxf(rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y)), 1e-4f));
}

/* What a class holds: target pixels, and their smallest and largest log2 w. */
typedef struct class_extent {
  double count;
  float least, most;
} class_extent;

static void classify(rc_level *level, class_extent extents[RC_MAX_CLASSES]) {
  for (int c = 0; c < RC_MAX_CLASSES; c++) extents[c] = (class_extent){0, 1e9f, -1e9f};
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      float v = log2_w_at(level, x, y);
      int c = (int)((v - level->ranges.log2_w0) / RC_CLASS_OCTAVES);
      c = c < 0 ? 0 : c >= level->ranges.count ? level->ranges.count - 1 : c;
      level->classes[rc_level_at(level, x, y)] = (uint8_t)c;
      extents[c].count++;
      extents[c].least = fminf(extents[c].least, v);
      extents[c].most = fmaxf(extents[c].most, v);
    }
}

static void make_classes(rc_level *level) {
  float least = 1e9f, most = -1e9f;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      float v = log2_w_at(level, x, y);
      least = fminf(least, v), most = fmaxf(most, v);
    }
  level->ranges.log2_w0 = least;
  int count = (int)((most - least) / RC_CLASS_OCTAVES) + 1;
  level->ranges.count = count > RC_MAX_CLASSES ? RC_MAX_CLASSES : count;
}

/* Widens a range until a target of this w has some source well inside it: a class's nearest and
 * farthest pixels are not its middle, and a footprint needs more room the more it is scaled. */
static void reach_source(const rc_level *level, float w, float *low, float *high) {
  int begin, end;
  for (;;) {
    bins_between(level, w * *low * REACH_BY, w * *high / REACH_BY, &begin, &end);
    if (end - begin >= LEAST_REACHED || *high > WIDEST) return;
    *low /= REACH_BY, *high *= REACH_BY;
  }
}

/* Starts narrow and widens a class's range while it holds too little source. */
static void set_ranges(rc_level *level, const class_extent extents[RC_MAX_CLASSES]) {
  for (int c = 0; c < level->ranges.count; c++) {
    float low = NARROW_LOW, high = NARROW_HIGH;
    float w = rc_exp2(level->ranges.log2_w0 + ((float)c + .5f) * RC_CLASS_OCTAVES);
    for (;;) {
      int begin, end;
      bins_between(level, w * low, w * high, &begin, &end);
      if (end - begin >= fmax(ENOUGH_SOURCE * extents[c].count, LEAST_SOURCE_PIXELS) ||
          high > WIDEST)
        break;
      low /= WIDEN_BY, high *= WIDEN_BY;
    }
    if (extents[c].count > 0) {
      reach_source(level, rc_exp2(extents[c].least), &low, &high);
      reach_source(level, rc_exp2(extents[c].most), &low, &high);
    }
    level->ranges.low[c] = low;
    level->ranges.high[c] = high;
  }
}

rc_sources rc_level_sources(const rc_level *level, float x, float y, int class_index) {
  rc_sources sources;
  float w = rc_level_w(level, x, y);
  bins_between(level, w * level->ranges.low[class_index], w * level->ranges.high[class_index],
               &sources.begin, &sources.end);
  return sources;
}

void rc_level_random_source(const rc_level *level, rc_sources sources, uint64_t bits, int *x,
                            int *y) {
  uint32_t count = (uint32_t)(sources.end - sources.begin);
  int32_t i = level->order[sources.begin + (int)rc_below((uint32_t)bits, count)];
  *x = i % level->width;
  *y = i / level->width;
}

recede_status rc_level_new(rc_context *context, const rc_image *image, const rc_mask *flags,
                           const rc_chart *chart, float gamma, float gain, const rc_ranges *ranges,
                           rc_level *level) {
  size_t count = (size_t)image->width * (size_t)image->height;
  class_extent extents[RC_MAX_CLASSES];
  memset(level, 0, sizeof *level);
  level->width = image->width;
  level->height = image->height;
  level->flags = flags->data;
  level->chart = *chart;
  RC_TRY(RC_NEW(context, count, &level->pixels));
  RC_TRY(RC_NEW(context, count, &level->weight));
  RC_TRY(RC_NEW(context, count, &level->room));
  /* Each takes a tenth of a second or two in a large picture. */
  pack(image, gain, level->pixels);
  RC_TRY(rc_poll(context));
  rc_distance_inside(level->flags, RC_SOURCE, level->width, level->height, true, level->room);
  RC_TRY(rc_poll(context));
  set_weights(level, gamma);
  RC_TRY(rc_poll(context));
  find_box(level);
  for (int i = 0; i < RC_PATCH_LANES; i++)
    level->lane_offset[i] = rc_lane_y[i] * level->width + rc_lane_x[i];
  set_variance(level);
  RC_TRY(rc_poll(context));
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  RC_TRY(RC_NEW(context, box, &level->field));
  RC_TRY(RC_NEW(context, box, &level->cost));
  RC_TRY(RC_NEW_ZERO(context, box, &level->classes));
  RC_TRY(sort_sources(context, level));
  make_classes(level);
  if (ranges) level->ranges = *ranges;
  classify(level, extents);
  if (!ranges) set_ranges(level, extents);
  return RECEDE_OK;
}
