#include "synthesis/composition/detail.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "synthesis/search/evaluate.h"

/* Two bands: what a 5-tap binomial takes away, and what the same with holes takes from the rest. */
#define BANDS 2
#define RAMP_PX 2
#define LEAST_GAIN .8f
#define MOST_GAIN 1.8f
#define LEAST_PIXELS 200
/* What is copied may have less detail than what lies around the hole, in squares. Of a texture it
 * has .6 and more, for what is smooth fits more, and gets what lies around; with .4 and less it is
 * another thing, bare sand among stones, and gets what it has itself. */
#define TEXTURE_FROM .6
#define OTHER_UP_TO .4
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

/* Squares of a band by class of w and side: in the hole, in known pixels, and those the hole is
 * copied from, in units of what known pixels of their class have. */
typedef struct energy {
  double sum;
  long count;
} energy;

typedef struct energies {
  energy hole[RC_ALL_CLASSES], known[RC_ALL_CLASSES], copied[RC_ALL_CLASSES];
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

/* Each strip of so many rows has sums of its own, which are then added in order: sums in another
 * order would have other last bits. */
#define STRIP_ROWS 16
#define HOLE 128 /* a class of pixels in the hole */
#define NONE 255

typedef struct measurement {
  const bands *bands;
  const rc_level *level;
  const float *fine, *coarse;
  size_t fine_row;  /* floats */
  uint8_t *group;   /* of each pixel of the box: its class, + HOLE in the hole; or NONE */
  energies *strips; /* each strip's */
  int strip_count;
  energies all;
} measurement;

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
  const measurement *m = user;
  const bands *b = m->bands;
  uint8_t *group = m->group + (size_t)y * (size_t)b->width;
  (void)thread;
  for (int x = 0; x < b->width; x++) group[x] = group_at(m->level, b->box.x0 + x, b->box.y0 + y);
}

/* x and y: in the box of the bands, here and below. */
static double square_at(const measurement *m, int x, int y) {
  int channels = m->bands->channels;
  size_t row = (size_t)m->bands->width * (size_t)channels, at = (size_t)x * (size_t)channels;
  const float *fine = m->fine + (size_t)y * m->fine_row + at;
  const float *coarse = m->coarse + (size_t)y * row + at;
  double sum = 0;
  for (int k = 0; k < channels; k++) {
    double d = (double)fine[k] - (double)coarse[k];
    sum += d * d;
  }
  return sum;
}

static bool enough(const energy *e) { return e->count >= LEAST_PIXELS; }
static double mean(const energy *e) { return e->sum / (double)e->count; }

static void add(energy *to, double square) {
  to->sum += square;
  to->count++;
}

static void add_hole_and_known(const measurement *m, energies *to, int x, int y) {
  int group = m->group[(size_t)y * (size_t)m->bands->width + (size_t)x];
  if (group == NONE) return;
  add(group & HOLE ? &to->hole[group & (HOLE - 1)] : &to->known[group], square_at(m, x, y));
}

static void add_copied(const measurement *m, energies *to, int x, int y) {
  const rc_level *level = m->level;
  const bands *b = m->bands;
  int group = m->group[(size_t)y * (size_t)b->width + (size_t)x], px = b->box.x0 + x,
      py = b->box.y0 + y;
  if (group == NONE || !(group & HOLE)) return;
  rc_copy copy = level->field[rc_level_at(level, px, py)];
  if (isnan(copy.a)) return;
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, px), rc_level_y(level, py));
  if (!rc_place_px(level, &place, &px, &py)) return;
  px -= b->box.x0, py -= b->box.y0;
  if (!rc_inside(b->width, b->height, px, py)) return;
  int there = m->group[(size_t)py * (size_t)b->width + (size_t)px];
  if (there & HOLE) return; /* or NONE */
  const energy *known = &m->all.known[there];
  if (enough(known) && known->sum > 0)
    add(&to->copied[group & (HOLE - 1)], square_at(m, px, py) / mean(known));
}

typedef void add_pixel(const measurement *m, energies *to, int x, int y);

static void add_strip(const measurement *m, int strip, add_pixel *add_one) {
  int end =
      (strip + 1) * STRIP_ROWS < m->bands->height ? (strip + 1) * STRIP_ROWS : m->bands->height;
  for (int y = strip * STRIP_ROWS; y < end; y++)
    for (int x = 0; x < m->bands->width; x++) add_one(m, &m->strips[strip], x, y);
}

static void measure_strip(void *user, int strip, int thread) {
  (void)thread;
  add_strip(user, strip, add_hole_and_known);
}

static void measure_copied_strip(void *user, int strip, int thread) {
  (void)thread;
  add_strip(user, strip, add_copied);
}

static void add_all(energy to[RC_ALL_CLASSES], const energy of_strip[RC_ALL_CLASSES]) {
  for (int c = 0; c < RC_ALL_CLASSES; c++)
    to[c].sum += of_strip[c].sum, to[c].count += of_strip[c].count;
}

static recede_status measure(rc_context *context, measurement *m) {
  memset(&m->all, 0, sizeof m->all);
  memset(m->strips, 0, (size_t)m->strip_count * sizeof *m->strips);
  RC_TRY(rc_parallel(context, m->strip_count, measure_strip, m));
  for (int n = 0; n < m->strip_count; n++) {
    add_all(m->all.hole, m->strips[n].hole);
    add_all(m->all.known, m->strips[n].known);
  }
  RC_TRY(rc_parallel(context, m->strip_count, measure_copied_strip, m));
  for (int n = 0; n < m->strip_count; n++) add_all(m->all.copied, m->strips[n].copied);
  return RECEDE_OK;
}

static bool comparable(const energies *e, int c) {
  return enough(&e->hole[c]) && enough(&e->known[c]);
}

static float gain_of(const energies *e, int c) {
  if (!(e->hole[c].sum > 0)) return 1.f;
  double square = mean(&e->known[c]) / mean(&e->hole[c]);
  double copied = enough(&e->copied[c]) ? mean(&e->copied[c]) : 1;
  if (copied < OTHER_UP_TO)
    square *= copied;
  else if (copied < TEXTURE_FROM)
    square *= 1 - (1 - copied) * (TEXTURE_FROM - copied) / (TEXTURE_FROM - OTHER_UP_TO);
  else if (copied > 1 && square < 1) /* what has more than lies around is not weakened for that */
    square = fmin(square * copied, 1);
  return fminf(fmaxf((float)sqrt(square), LEAST_GAIN), MOST_GAIN);
}

/* Where a path is as wide as the hole nothing of its own scale is known: it has the gain of its
 * side's nearest class. */
static void gains_of(const energies *e, const rc_ranges *ranges, float gains[RC_ALL_CLASSES]) {
  for (int c = 0; c < ranges->count * ranges->sides; c++) {
    int first = c / ranges->count * ranges->count, end = first + ranges->count;
    gains[c] = comparable(e, c) ? gain_of(e, c) : 1.f;
    bool found = comparable(e, c) || ranges->sides == 1;
    for (int off = 1; off < ranges->count && !found; off++)
      for (int other = c - off; other <= c + off && !found; other += 2 * off) {
        found = other >= first && other < end && comparable(e, other);
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
  const uint8_t *depth; /* in the hole, px, of each pixel of the box */
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
    float depth = (float)a->depth[(size_t)y * (size_t)b->width + (size_t)x];
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

/* The box reaches beyond the hole, or ends where the picture does: what lies farther tells nothing.
 */
static recede_status find_depth(rc_context *context, const bands *b, const rc_level *level,
                                uint8_t *depth) {
  size_t width = (size_t)b->width;
  uint8_t *flags;
  RC_TRY(RC_NEW(context, width * (size_t)b->height, &flags));
  for (int y = 0; y < b->height; y++)
    memcpy(flags + (size_t)y * width,
           level->flags + (size_t)(b->box.y0 + y) * (size_t)level->width + (size_t)b->box.x0,
           width);
  rc_distance_inside(flags, RC_TARGET, b->width, b->height, false, depth);
  RC_FREE(context, &flags);
  return rc_poll(context);
}

recede_status rc_match_detail(rc_context *context, const rc_level *level, rc_image *residual) {
  bands b = {.box = rc_box_grown(level->box, SURROUNDINGS_PX, level->width, level->height),
             .channels = residual->channels};
  application a = {.bands = &b, .level = level, .residual = residual};
  measurement m = {.bands = &b, .level = level};
  float *scratch;
  uint8_t *depth;
  rc_block *mark = rc_mark(context);
  b.width = b.box.x1 - b.box.x0, b.height = b.box.y1 - b.box.y0;
  size_t row = (size_t)b.width * (size_t)b.channels, values = row * (size_t)b.height;
  m.strip_count = (b.height + STRIP_ROWS - 1) / STRIP_ROWS;
  RC_TRY(RC_NEW(context, (size_t)b.width * (size_t)b.height, &depth));
  RC_TRY(find_depth(context, &b, level, depth));
  RC_TRY(RC_NEW(context, values, &scratch));
  RC_TRY(RC_NEW(context, m.strip_count, &m.strips));
  RC_TRY(RC_NEW(context, (size_t)b.height * (size_t)b.width, &m.group));
  RC_TRY(rc_parallel(context, b.height, group_row, &m));
  m.fine = rc_pixel(residual, b.box.x0, b.box.y0);
  m.fine_row = (size_t)residual->width * (size_t)b.channels;
  for (int n = 0; n < BANDS; n++) {
    RC_TRY(RC_NEW(context, values, &a.layers[n]));
    b.spacing = 1 << n;
    RC_TRY(smooth(context, &b, m.fine, m.fine_row, scratch, a.layers[n]));
    m.coarse = a.layers[n];
    RC_TRY(measure(context, &m));
    gains_of(&m.all, &level->ranges, a.gains[n]);
    m.fine = a.layers[n], m.fine_row = row;
  }
  a.depth = depth;
  RC_TRY(rc_parallel(context, b.height, apply_row, &a));
  rc_release(context, mark);
  return RECEDE_OK;
}
