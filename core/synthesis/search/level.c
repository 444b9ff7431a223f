#include "synthesis/search/level.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/distance.h"

/* Ratios of s = ratio^1.5 in .9 .. 1.2: wider ones score the same on flat patterns but lean and
 * stretch real stones. */
#define NARROW_LOW .932f
#define NARROW_HIGH 1.129f
/* A class's range is widened until it holds this many times its target's pixels in sources. */
#define ENOUGH_SOURCE 2.0
#define LEAST_SOURCE_PIXELS 64
/* A side has sources of its own if it has so many: a path that runs into depth has 24 to 38. */
#define LEAST_OF_SIDE 16
#define WIDEN_BY 1.3f
/* Each single depth needs at least these; more would widen ordinary holes at the coarsest level,
 * where a row of the picture has few pixels. */
#define LEAST_REACHED 8
#define REACH_BY 1.05f
#define WIDEST 8.f
/* Sources are sorted in bands of so many rows at once. */
#define BAND_ROWS 64

static uint32_t encode(float value, float gain) {
  float byte = value * gain + 128.5f;
  return byte < 0.f ? 0u : byte >= 255.f ? 255u : (uint32_t)byte;
}

/* Sums, sums of squares and the number. */
#define MOMENTS (2 * RC_COMPONENTS + 1)

/* What the rows of a level are made from. */
typedef struct making {
  const rc_image *image;
  rc_level *level;
  float gain;
  uint8_t trust[256];           /* by the distance from the hole's border */
  uint64_t (*moments)[MOMENTS]; /* of each row's sources */
} making;

static void pack_row(void *user, int y, int thread) {
  const making *m = user;
  size_t count = (size_t)m->image->width;
  const float *v = rc_pixel(m->image, 0, y);
  uint32_t *pixels = m->level->pixels + (size_t)y * count;
  (void)thread;
  if (m->image->channels == 1)
    for (size_t i = 0; i < count; i++) pixels[i] = encode(v[i], m->gain) * 0x010101u;
  else
    for (size_t i = 0; i < count; i++)
      pixels[i] = encode(v[3 * i], m->gain) | encode(v[3 * i + 1], m->gain) << 8 |
                  encode(v[3 * i + 2], m->gain) << 16;
}

static void set_trust(float gamma, uint8_t trust[256]) {
  for (int i = 0; i < 256; i++) {
    float weight = RC_WEIGHT_ONE * rc_exp2(-(float)i * rc_log2(gamma));
    trust[i] = weight < 1.f ? 1 : (uint8_t)(weight + .5f);
  }
}

/* The weights hold the distances before. */
static void weigh_row(void *user, int y, int thread) {
  const making *m = user;
  const rc_level *level = m->level;
  uint64_t *moments = m->moments[y];
  (void)thread;
  memset(moments, 0, sizeof m->moments[y]);
  for (int x = 0; x < level->width; x++) {
    size_t i = (size_t)y * (size_t)level->width + (size_t)x;
    uint8_t flags = level->flags[i];
    level->weight[i] = flags & RC_TARGET  ? m->trust[level->weight[i]]
                       : flags & RC_KNOWN ? RC_WEIGHT_ONE
                                          : 0;
    if (!(flags & RC_SOURCE)) continue;
    for (int k = 0; k < RC_COMPONENTS; k++) {
      uint32_t v = level->pixels[i] >> 8 * k & 255;
      moments[k] += v, moments[RC_COMPONENTS + k] += v * v;
    }
    moments[MOMENTS - 1]++;
  }
}

static void set_variance(const making *m) {
  rc_level *level = m->level;
  double sum[MOMENTS] = {0}, total = 0;
  for (int y = 0; y < level->height; y++)
    for (int k = 0; k < MOMENTS; k++) sum[k] += (double)m->moments[y][k];
  double count = sum[MOMENTS - 1];
  for (int k = 0; k < RC_COMPONENTS && count > 0; k++)
    total += sum[RC_COMPONENTS + k] / count - sum[k] / count * (sum[k] / count);
  level->variance = fmaxf((float)total, 1.f);
}

/* A counting sort of the sources by log2 w, bands of rows at a time. */
typedef struct sorting {
  rc_level *level;
  /* Of each band and side: sources in a bin, then where the next goes. */
  int32_t (*next)[RC_MAX_SIDES][RC_MAX_BINS];
} sorting;

int rc_level_bin(const rc_level *level, float w) {
  int bin = (int)((rc_log2(w) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE);
  return bin < 0 ? 0 : bin >= level->bins ? level->bins - 1 : bin;
}

static void for_each_source(const sorting *s, int band, bool place) {
  const rc_level *level = s->level;
  int end = (band + 1) * BAND_ROWS < level->height ? (band + 1) * BAND_ROWS : level->height;
  for (int y = band * BAND_ROWS; y < end; y++)
    for (int x = 0; x < level->width; x++) {
      size_t i = (size_t)y * (size_t)level->width + (size_t)x;
      if (level->room[i] <= RC_PATCH_RADIUS + 1) continue;
      float rx = rc_level_x(level, x), ry = rc_level_y(level, y), w = rc_level_w(level, rx, ry);
      if (!(w > 0.f)) continue;
      int32_t *next = s->next[band][rc_level_side(level, rx, ry)];
      int bin = rc_level_bin(level, w);
      if (place) level->order[next[bin]] = (int32_t)i;
      next[bin]++;
    }
}

static void count_band(void *user, int band, int thread) {
  (void)thread;
  for_each_source(user, band, false);
}
static void place_band(void *user, int band, int thread) {
  (void)thread;
  for_each_source(user, band, true);
}

static void set_bins(rc_level *level) {
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
}

/* Where the sources of each band go. */
static void set_first(const sorting *s, int bands) {
  rc_level *level = s->level;
  int32_t at = 0;
  for (int side = 0; side < RC_MAX_SIDES; side++)
    for (int b = 0; b <= level->bins; b++) {
      level->first[side][b] = at;
      for (int band = 0; band < bands && b < level->bins; band++) {
        int32_t count = s->next[band][side][b];
        s->next[band][side][b] = at;
        at += count;
      }
    }
}

recede_status rc_level_sort_sources(rc_context *context, rc_level *level) {
  sorting s = {level, NULL};
  int bands = (level->height + BAND_ROWS - 1) / BAND_ROWS;
  set_bins(level);
  RC_TRY(RC_NEW_ZERO(context, bands, &s.next));
  RC_TRY(rc_parallel(context, bands, count_band, &s));
  set_first(&s, bands);
  RC_TRY(RC_NEW(context, rc_level_all_sources(level).end + 1, &level->order));
  RC_TRY(rc_parallel(context, bands, place_band, &s));
  RC_FREE(context, &s.next);
  return RECEDE_OK;
}

/* By sides that look different, unless one has hardly any source. */
static recede_status sort_by_sides(rc_context *context, rc_level *level) {
  level->ranges.sides = level->sides.apart ? RC_MAX_SIDES : 1;
  RC_TRY(rc_level_sort_sources(context, level));
  for (int side = 0; side < level->ranges.sides; side++) {
    rc_sources own = rc_level_side_sources(level, side);
    if (level->ranges.sides == 1 || own.end - own.begin >= LEAST_OF_SIDE) continue;
    level->ranges.sides = 1;
    RC_FREE(context, &level->order);
    return rc_level_sort_sources(context, level);
  }
  return RECEDE_OK;
}

/* A side's sources with w in low..high: a run of level->order. */
static void bins_between(const rc_level *level, int side, float low, float high, int *begin,
                         int *end) {
  int from = rc_floor((rc_log2(low) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE);
  int to = rc_floor((rc_log2(high) - level->bin_log2_w0) * RC_BINS_PER_OCTAVE) + 1;
  from = from < 0 ? 0 : from > level->bins ? level->bins : from;
  to = to < from ? from : to > level->bins ? level->bins : to;
  *begin = level->first[side][from];
  *end = level->first[side][to];
}

static float log2_w_at(const rc_level *level, int x, int y) {
  return rc_log2(fmaxf(rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y)), 1e-4f));
}

/* What a class holds: target pixels, and their smallest and largest log2 w. */
typedef struct class_extent {
  double count;
  float least, most;
} class_extent;

static void classify(rc_level *level, class_extent extents[RC_ALL_CLASSES]) {
  for (int c = 0; c < RC_ALL_CLASSES; c++) extents[c] = (class_extent){0, 1e9f, -1e9f};
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      float v = log2_w_at(level, x, y);
      int c = (int)((v - level->ranges.log2_w0) / RC_CLASS_OCTAVES);
      c = c < 0 ? 0 : c >= level->ranges.count ? level->ranges.count - 1 : c;
      c += level->ranges.count * rc_level_side(level, rc_level_x(level, x), rc_level_y(level, y));
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
  level->ranges.count = 0;
  if (most < least) return;
  int count = (int)((most - least) / RC_CLASS_OCTAVES) + 1;
  level->ranges.count = count > RC_MAX_CLASSES ? RC_MAX_CLASSES : count;
}

/* Widens a range until a target of this w has some source well inside it: a class's nearest and
 * farthest pixels are not its middle, and a footprint needs more room the more it is scaled. */
static void reach_source(const rc_level *level, int side, float w, float *low, float *high) {
  int begin, end;
  for (;;) {
    bins_between(level, side, w * *low * REACH_BY, w * *high / REACH_BY, &begin, &end);
    if (end - begin >= LEAST_REACHED || *high > WIDEST) return;
    *low /= REACH_BY, *high *= REACH_BY;
  }
}

/* Starts narrow and widens a class's range while it holds too little source. */
static void set_ranges(rc_level *level, const class_extent extents[RC_ALL_CLASSES]) {
  for (int c = 0; c < level->ranges.count * level->ranges.sides; c++) {
    float low = NARROW_LOW, high = NARROW_HIGH;
    int side = c / level->ranges.count, scale = c % level->ranges.count;
    float w = rc_exp2(level->ranges.log2_w0 + ((float)scale + .5f) * RC_CLASS_OCTAVES);
    for (;;) {
      int begin, end;
      bins_between(level, side, w * low, w * high, &begin, &end);
      if (end - begin >= fmax(ENOUGH_SOURCE * extents[c].count, LEAST_SOURCE_PIXELS) ||
          high > WIDEST)
        break;
      low /= WIDEN_BY, high *= WIDEN_BY;
    }
    if (extents[c].count > 0) {
      reach_source(level, side, rc_exp2(extents[c].least), &low, &high);
      reach_source(level, side, rc_exp2(extents[c].most), &low, &high);
    }
    level->ranges.low[c] = low;
    level->ranges.high[c] = high;
  }
}

rc_sources rc_level_sources(const rc_level *level, float x, float y, int class_index) {
  rc_sources sources;
  float w = rc_level_w(level, x, y);
  int side = class_index / level->ranges.count;
  bins_between(level, side, w * level->ranges.low[class_index], w * level->ranges.high[class_index],
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

void rc_level_free_pixels(rc_context *context, rc_level *level) {
  RC_FREE(context, &level->pixels);
  RC_FREE(context, &level->weight);
  RC_FREE(context, &level->room);
  RC_FREE(context, &level->order);
}

recede_status rc_level_new(rc_context *context, const rc_mask *flags, const rc_chart *chart,
                           rc_level *level) {
  size_t count = (size_t)flags->width * (size_t)flags->height;
  memset(level, 0, sizeof *level);
  level->width = flags->width;
  level->height = flags->height;
  level->flags = flags->data;
  level->chart = *chart;
  RC_TRY(RC_NEW(context, count, &level->room));
  rc_distance_inside(level->flags, RC_SOURCE, level->width, level->height, true, level->room);
  RC_TRY(rc_poll(context));
  level->box = rc_box_of(flags, RC_TARGET);
  level->box_w = level->box.x1 - level->box.x0;
  level->box_h = level->box.y1 - level->box.y0;
  for (int i = 0; i < RC_PATCH_LANES; i++)
    level->lane_offset[i] = rc_lane_y[i] * level->width + rc_lane_x[i];
  RC_TRY(rc_poll(context));
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  RC_TRY(RC_NEW(context, box, &level->field));
  return RC_NEW(context, box, &level->cost);
}

static recede_status take_pixels(rc_context *context, const rc_traits *traits, making *m) {
  rc_level *level = m->level;
  if (traits->pixels) {
    level->pixels = traits->pixels;
    memcpy(level->colours, traits->colours, sizeof level->colours);
    level->principal = true;
    return RECEDE_OK;
  }
  for (int k = 0; k < 3; k++) level->colours[k][k] = 1;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &level->pixels));
  return rc_parallel(context, level->height, pack_row, m);
}

recede_status rc_level_see(rc_context *context, const rc_image *image, const rc_traits *traits,
                           float gamma, float gain, bool coarsest, rc_level *level) {
  class_extent extents[RC_ALL_CLASSES];
  making m = {.image = image, .level = level, .gain = gain};
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &level->weight));
  RC_TRY(RC_NEW(context, level->height, &m.moments));
  RC_TRY(take_pixels(context, traits, &m));
  rc_distance_inside(level->flags, RC_TARGET, level->width, level->height, false, level->weight);
  RC_TRY(rc_poll(context));
  set_trust(gamma, m.trust);
  RC_TRY(rc_parallel(context, level->height, weigh_row, &m));
  set_variance(&m);
  RC_FREE(context, &m.moments);
  RC_TRY(RC_NEW_ZERO(context, (size_t)level->box_w * (size_t)level->box_h, &level->classes));
  if (coarsest) {
    RC_TRY(sort_by_sides(context, level));
    make_classes(level);
  }
  classify(level, extents);
  if (coarsest) set_ranges(level, extents);
  return rc_poll(context);
}
