/* One level of the pyramid as the search sees it: bytes for pixels, what each pixel is and counts,
 * where sources of which scale lie, and the field of copies over the target's box. */
#ifndef RECEDE_SYNTHESIS_SEARCH_LEVEL_H
#define RECEDE_SYNTHESIS_SEARCH_LEVEL_H

#include "base/random.h"
#include "image/image.h"
#include "kernels/kernels.h"
#include "synthesis/copy.h"
#include "synthesis/search/traits.h"
#include "synthesis/sources/conditions.h"
#include "synthesis/structure/lattice.h"
#include "synthesis/structure/sides.h"

/* Target pixels are sorted by w into classes of .3 octave, each with its own range of scales. */
#define RC_CLASS_OCTAVES .3f
#define RC_MAX_CLASSES 24
/* Where there are two sides those of the second have classes of their own, after the first's. */
#define RC_MAX_SIDES 2
#define RC_ALL_CLASSES (RC_MAX_SIDES * RC_MAX_CLASSES)
/* Sources are sorted by w into bins this fine to draw random ones of a scale. */
#define RC_BINS_PER_OCTAVE 32
#define RC_MAX_BINS 512

/* Which ratios w(source) / w(target) a class of target pixels may copy from. */
typedef struct rc_ranges {
  float log2_w0; /* of the first class's lower end */
  int count;     /* of classes on each side */
  int sides;     /* 1 also where one of two has hardly any source */
  float low[RC_ALL_CLASSES], high[RC_ALL_CLASSES];
} rc_ranges;

/* By a line; by one that is no chance, which may be copied from what is RC_ALLOWED alone. */
enum { RC_LOCKED = 1, RC_LOCKED_SURELY = 2 };

typedef struct rc_level {
  int width, height;
  int cut_x, cut_y; /* columns and rows that are left out before the first */
  uint32_t *pixels; /* a byte for each component; in the target the current guide */
  /* What each component says of red, green and blue, but for one factor. */
  float colours[RC_COMPONENTS][3];
  bool principal;  /* the first component is what varies most, else it is red */
  uint8_t *flags;  /* RC_TARGET ... */
  uint8_t *weight; /* 0..RC_WEIGHT_ONE: how much the pixel counts in a target patch */
  uint8_t *room;   /* Chebyshev distance to the nearest pixel that is no source; 0 = is none */
  rc_chart chart;
  rc_box box; /* of the target */
  int box_w, box_h;
  rc_copy *field;   /* box_w * box_h, row by row; NAN a = none yet */
  float *cost;      /* of the field's copies without the price of incoherence */
  uint8_t *locked;  /* box pixels whose copy stays: RC_LOCKED or RC_LOCKED_SURELY; NULL = none */
  uint8_t *laid;    /* of the finest: box pixels of a dash, its number; or NULL */
  uint8_t *board;   /* of each pixel, modulo 256; NULL = there are none */
  uint8_t *classes; /* class of each box pixel */
  int32_t lane_offset[RC_PATCH_LANES]; /* of each lane of a patch, in pixels */
  rc_ranges ranges;
  rc_sides sides;
  rc_conditions conditions;
  float layers;       /* as rc_layers_find */
  rc_lattice lattice; /* which copies keep to, if there is one */
  float variance;     /* of sources, byte^2, summed over the components */
  /* Sources sorted by side and w: indices of pixels, bin b of side s at order[first[s][b]] ..
   * order[first[s][b + 1]]. NULL where nobody asks: the finer levels look nearby, and take the
   * coarsest one's ranges over. */
  int32_t *order;
  int32_t first[RC_MAX_SIDES][RC_MAX_BINS + 1];
  float bin_log2_w0;
  int bins;
} rc_level;

/* Of a pixel, whatever is left out. */
static inline uint64_t rc_level_random(const rc_level *level, uint64_t key, int x, int y,
                                       uint32_t n) {
  return rc_random(key, (uint32_t)(x + level->cut_x), (uint32_t)(y + level->cut_y), n);
}
static inline float rc_level_x(const rc_level *level, int x) { return (float)x - level->chart.x0; }
static inline float rc_level_y(const rc_level *level, int y) { return (float)y - level->chart.y0; }
static inline float rc_level_w(const rc_level *level, float x, float y) {
  return 1.f + level->chart.lx * x + level->chart.ly * y;
}
static inline size_t rc_level_at(const rc_level *level, int x, int y) {
  return (size_t)(y - level->box.y0) * (size_t)level->box_w + (size_t)(x - level->box.x0);
}
/* Things that are made up of boards are filled board by board. */
static inline bool rc_level_same_board(const rc_level *level, int x, int y, int other_x,
                                       int other_y) {
  size_t width = (size_t)level->width;
  return !level->board || level->board[(size_t)y * width + (size_t)x] ==
                              level->board[(size_t)other_y * width + (size_t)other_x];
}
/* Which side's classes and sources a place has. */
static inline int rc_level_side(const rc_level *level, float x, float y) {
  return level->ranges.sides > 1 && rc_is_other_side(&level->sides, &level->chart, x, y);
}
static inline bool rc_level_is_target(const rc_level *level, int x, int y) {
  return (level->flags[(size_t)y * (size_t)level->width + (size_t)x] & RC_TARGET) != 0;
}

/* What varies most, or brightness: what periods are told by. */
static inline float rc_level_trait(const rc_level *level, int i) {
  uint32_t pixel = level->pixels[i];
  if (level->principal) return (float)(pixel & 255);
  return .3f * (float)(pixel & 255) + .59f * (float)(pixel >> 8 & 255) +
         .11f * (float)(pixel >> 16 & 255);
}

/* What only composition asks for: room, box and an empty field. */
recede_status rc_level_new(rc_context *context, const rc_mask *flags, const rc_chart *chart,
                           rc_level *level);
/* And what a search does; sides must be set. traits: the pixels, which are the level's from then
 * on; where they have none the picture's colours are, byte = value * gain + 128. gamma: a target
 * pixel counts gamma times less for each px it is deeper in the hole; 1 = the same. The coarsest
 * level's ranges are made here from what sources there are, the others' must be set. */
recede_status rc_level_see(rc_context *context, const rc_image *image, const rc_traits *traits,
                           float gamma, float gain, bool coarsest, rc_level *level);
recede_status rc_level_sort_sources(rc_context *context, rc_level *level);
/* Of sorted sources those of w, above 0, are in this bin, or would be. */
int rc_level_bin(const rc_level *level, float w);
/* When a level is done: the next finer one asks for its field, costs, box, ranges and lattice. */
void rc_level_free_pixels(rc_context *context, rc_level *level);
/* A run of level->order, empty when there are none. */
typedef struct rc_sources {
  int begin, end;
} rc_sources;
/* A side's, smallest w first. */
static inline rc_sources rc_level_side_sources(const rc_level *level, int side) {
  return (rc_sources){level->first[side][0], level->first[side][level->bins]};
}
static inline rc_sources rc_level_all_sources(const rc_level *level) {
  return (rc_sources){0, level->first[RC_MAX_SIDES - 1][level->bins]};
}
/* Those of the right scale for a target pixel of relative position (x, y) and class. */
rc_sources rc_level_sources(const rc_level *level, float x, float y, int class_index);
/* A random one of a run that is not empty. */
void rc_level_random_source(const rc_level *level, rc_sources sources, uint64_t bits, int *x,
                            int *y);

#endif
