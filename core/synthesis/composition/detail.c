#include "synthesis/composition/detail.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/distance.h"

/* Two bands: what a 5-tap binomial takes away, and what the same with holes takes from the rest. */
#define BANDS 2
#define RAMP_PX 2
#define LEAST_GAIN .8f
#define MOST_GAIN 1.8f
#define LEAST_PIXELS 200
/* The box is grown by this much, so that known pixels of each scale are measured too. */
#define SURROUNDINGS_PX 160

typedef struct bands {
  rc_box box;
  int width, height, channels;
  const float *in; /* rows of in_row floats */
  size_t in_row;
  float *out;
  int spacing;
} bands;

static const float tap[5] = {.0625f, .25f, .375f, .25f, .0625f};

static int within(int v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : v; }

static void smooth_along(void *user, int y, int thread) {
  const bands *b = user;
  size_t row = (size_t)b->width * (size_t)b->channels;
  float *restrict to = b->out + (size_t)y * row;
  const float *from[5];
  (void)thread;
  for (int i = 0; i < 5; i++)
    from[i] = b->in + (size_t)within(y + (i - 2) * b->spacing, b->height) * b->in_row;
  for (size_t x = 0; x < row; x++) {
    float sum = 0.f;
    for (int i = 0; i < 5; i++) sum += tap[i] * from[i][x];
    to[x] = sum;
  }
}

static void smooth_across(void *user, int y, int thread) {
  const bands *b = user;
  int channels = b->channels, reach = 2 * b->spacing;
  const float *from = b->in + (size_t)y * b->in_row;
  float *restrict to = b->out + (size_t)y * (size_t)b->width * (size_t)channels;
  (void)thread;
  for (int x = 0; x < b->width; x++) {
    if (x == reach && b->width > 2 * reach) { /* the inner ones, without looking for the borders */
      for (int at = reach * channels; at < (b->width - reach) * channels; at++) {
        float sum = 0.f;
        for (int i = 0; i < 5; i++) sum += tap[i] * from[at + (i - 2) * b->spacing * channels];
        to[at] = sum;
      }
      x = b->width - reach;
    }
    for (int k = 0; k < channels; k++) {
      float sum = 0.f;
      for (int i = 0; i < 5; i++)
        sum += tap[i] * from[within(x + (i - 2) * b->spacing, b->width) * channels + k];
      to[x * channels + k] = sum;
    }
  }
}

static recede_status smooth(rc_context *context, bands *b, const float *in, size_t in_row,
                            float *scratch, float *out) {
  size_t row = (size_t)b->width * (size_t)b->channels;
  b->in = in, b->in_row = in_row, b->out = scratch;
  RC_TRY(rc_parallel(context, b->height, smooth_across, b));
  b->in = scratch, b->in_row = row, b->out = out;
  return rc_parallel(context, b->height, smooth_along, b);
}

/* Mean square of a band by class of w and side, in the hole and in known pixels. */
typedef struct energies {
  double hole[RC_ALL_CLASSES], known[RC_ALL_CLASSES];
  long hole_count[RC_ALL_CLASSES], known_count[RC_ALL_CLASSES];
} energies;

/* position: between the middles of the classes of its side. */
static int class_at(const rc_level *level, int x, int y, float *position) {
  float w = rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
  if (!(w > 1e-4f)) return -1;
  float octave = (rc_log2(w) - level->ranges.log2_w0) / RC_CLASS_OCTAVES;
  if (!(octave > -.5f && octave < (float)level->ranges.count + .5f)) return -1;
  *position = octave - .5f;
  int c = (int)octave;
  return c < 0 ? 0 : c >= level->ranges.count ? level->ranges.count - 1 : c;
}

/* Squares are taken in strips of so many rows at once and then added pixel by pixel: sums in
 * another order would have other last bits. */
#define STRIP_ROWS 64
#define HOLE 128 /* a class of pixels in the hole */
#define NONE 255

typedef struct strip {
  const bands *bands;
  const rc_level *level;
  const float *fine, *coarse;
  size_t fine_row; /* floats */
  int first;
  double *square; /* of each pixel of the strip */
  uint8_t *group; /* of each pixel of the box: its class, + HOLE in the hole; or NONE */
} strip;

static int side_at(const rc_level *level, int x, int y) {
  return rc_level_side(level, rc_level_x(level, x), rc_level_y(level, y));
}

static uint8_t group_at(const rc_level *level, int x, int y) {
  float position;
  size_t at = (size_t)y * (size_t)level->width + (size_t)x;
  bool hole = (level->flags[at] & RC_TARGET) != 0;
  if (!hole && level->room[at] <= 2 * RAMP_PX) return NONE;
  int c = class_at(level, x, y, &position);
  if (c < 0) return NONE;
  c += level->ranges.count * side_at(level, x, y);
  return (uint8_t)(hole ? HOLE + c : c);
}

static void group_row(void *user, int y, int thread) {
  const strip *s = user;
  const bands *b = s->bands;
  uint8_t *group = s->group + (size_t)y * (size_t)b->width;
  (void)thread;
  for (int x = 0; x < b->width; x++) group[x] = group_at(s->level, b->box.x0 + x, b->box.y0 + y);
}

static void measure_row(void *user, int item, int thread) {
  const strip *s = user;
  const bands *b = s->bands;
  int y = s->first + item;
  const float *fine = s->fine + (size_t)y * s->fine_row;
  const float *coarse = s->coarse + (size_t)y * (size_t)b->width * (size_t)b->channels;
  (void)thread;
  for (int x = 0; x < b->width; x++) {
    double sum = 0;
    for (int k = 0; k < b->channels; k++) {
      double d = (double)*fine++ - (double)*coarse++;
      sum += d * d;
    }
    s->square[(size_t)item * (size_t)b->width + (size_t)x] = sum;
  }
}

static recede_status measure(rc_context *context, strip *s, energies *e) {
  const bands *b = s->bands;
  memset(e, 0, sizeof *e);
  for (s->first = 0; s->first < b->height; s->first += STRIP_ROWS) {
    int rows = b->height - s->first < STRIP_ROWS ? b->height - s->first : STRIP_ROWS;
    RC_TRY(rc_parallel(context, rows, measure_row, s));
    const uint8_t *group = s->group + (size_t)s->first * (size_t)b->width;
    for (size_t i = 0; i < (size_t)rows * (size_t)b->width; i++) {
      int c = group[i] & (HOLE - 1);
      if (group[i] == NONE) continue;
      if (group[i] & HOLE)
        e->hole[c] += s->square[i], e->hole_count[c]++;
      else
        e->known[c] += s->square[i], e->known_count[c]++;
    }
  }
  return RECEDE_OK;
}

static bool enough(const energies *e, int c) {
  return e->hole_count[c] >= LEAST_PIXELS && e->known_count[c] >= LEAST_PIXELS;
}

static float gain_of(const energies *e, int c) {
  double hole = e->hole[c] / (double)e->hole_count[c];
  double known = e->known[c] / (double)e->known_count[c];
  float gain = hole > 0 ? (float)sqrt(known / hole) : 1.f;
  return fminf(fmaxf(gain, LEAST_GAIN), MOST_GAIN);
}

/* Where a path is as wide as the hole nothing of its own scale is known: it has the gain of its
 * side's nearest class. */
static void gains_of(const energies *e, const rc_ranges *ranges, float gains[RC_ALL_CLASSES]) {
  for (int c = 0; c < ranges->count * ranges->sides; c++) {
    int first = c / ranges->count * ranges->count, end = first + ranges->count;
    gains[c] = enough(e, c) ? gain_of(e, c) : 1.f;
    bool found = enough(e, c) || ranges->sides == 1;
    for (int off = 1; off < ranges->count && !found; off++)
      for (int other = c - off; other <= c + off && !found; other += 2 * off) {
        found = other >= first && other < end && enough(e, other);
        if (found) gains[c] = gain_of(e, other);
      }
  }
}

static float gain_at(const float *gains, int classes, float position) {
  if (position <= 0.f) return gains[0];
  if (position >= (float)(classes - 1)) return gains[classes - 1];
  int c = (int)position;
  float t = position - (float)c;
  return gains[c] * (1.f - t) + gains[c + 1] * t;
}

typedef struct application {
  const bands *bands;
  const rc_level *level;
  const uint8_t *depth;
  float gains[BANDS][RC_ALL_CLASSES];
  float *layers[BANDS]; /* smoothed once, twice */
  rc_image *residual;
} application;

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  const bands *b = a->bands;
  const rc_level *level = a->level;
  (void)thread;
  for (int x = 0; x < b->width; x++) {
    float position;
    int px = b->box.x0 + x, py = b->box.y0 + y;
    size_t i = ((size_t)y * (size_t)b->width + (size_t)x) * (size_t)b->channels;
    if (!rc_level_is_target(level, px, py) || class_at(level, px, py, &position) < 0) continue;
    float depth = (float)a->depth[(size_t)py * (size_t)level->width + (size_t)px];
    int first = level->ranges.count * side_at(level, px, py);
    float ramp = fminf(depth / (RAMP_PX + 1.f), 1.f), more[BANDS];
    float *pixel = rc_pixel(a->residual, px, py);
    for (int n = 0; n < BANDS; n++)
      more[n] = ramp * (gain_at(a->gains[n] + first, level->ranges.count, position) - 1.f);
    for (int k = 0; k < b->channels; k++, i++) {
      float finer = pixel[k];
      for (int n = 0; n < BANDS; finer = a->layers[n++][i])
        pixel[k] += more[n] * (finer - a->layers[n][i]);
    }
  }
}

recede_status rc_match_detail(rc_context *context, const rc_level *level, rc_image *residual) {
  bands b = {.box = rc_box_grown(level->box, SURROUNDINGS_PX, level->width, level->height),
             .channels = residual->channels};
  application a = {.bands = &b, .level = level, .residual = residual};
  strip s = {.bands = &b, .level = level};
  float *scratch;
  uint8_t *depth;
  energies e;
  rc_block *mark = rc_mark(context);
  b.width = b.box.x1 - b.box.x0, b.height = b.box.y1 - b.box.y0;
  size_t row = (size_t)b.width * (size_t)b.channels, values = row * (size_t)b.height;
  size_t strip_rows = b.height < STRIP_ROWS ? (size_t)b.height : STRIP_ROWS;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &depth));
  RC_TRY(RC_NEW(context, values, &scratch));
  RC_TRY(RC_NEW(context, strip_rows * (size_t)b.width, &s.square));
  RC_TRY(RC_NEW(context, (size_t)b.height * (size_t)b.width, &s.group));
  RC_TRY(rc_parallel(context, b.height, group_row, &s));
  s.fine = rc_pixel(residual, b.box.x0, b.box.y0);
  s.fine_row = (size_t)residual->width * (size_t)b.channels;
  for (int n = 0; n < BANDS; n++) {
    RC_TRY(RC_NEW(context, values, &a.layers[n]));
    b.spacing = 1 << n;
    RC_TRY(smooth(context, &b, s.fine, s.fine_row, scratch, a.layers[n]));
    s.coarse = a.layers[n];
    RC_TRY(measure(context, &s, &e));
    gains_of(&e, &level->ranges, a.gains[n]);
    s.fine = a.layers[n], s.fine_row = row;
  }
  rc_distance_inside(level->flags, RC_TARGET, level->width, level->height, false, depth);
  a.depth = depth;
  RC_TRY(rc_parallel(context, b.height, apply_row, &a));
  rc_release(context, mark);
  return RECEDE_OK;
}
