#include "synthesis/detail.h"

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
  const rc_image *residual;
  rc_box box;
  int width, height, channels;
  const float *in;
  float *out;
  int spacing;
  bool vertical;
} bands;

static void smooth_row(void *user, int y, int thread) {
  static const float tap[5] = {.0625f, .25f, .375f, .25f, .0625f};
  const bands *b = user;
  (void)thread;
  for (int x = 0; x < b->width; x++) {
    float sum[3] = {0, 0, 0};
    for (int i = -2; i <= 2; i++) {
      int sx = b->vertical ? x : x + i * b->spacing, sy = b->vertical ? y + i * b->spacing : y;
      sx = sx < 0 ? 0 : sx >= b->width ? b->width - 1 : sx;
      sy = sy < 0 ? 0 : sy >= b->height ? b->height - 1 : sy;
      const float *pixel =
          b->in + ((size_t)sy * (size_t)b->width + (size_t)sx) * (size_t)b->channels;
      for (int k = 0; k < b->channels; k++) sum[k] += tap[i + 2] * pixel[k];
    }
    memcpy(b->out + ((size_t)y * (size_t)b->width + (size_t)x) * (size_t)b->channels, sum,
           (size_t)b->channels * sizeof *sum);
  }
}

static recede_status smooth(rc_context *context, bands *b, const float *in, float *scratch,
                            float *out) {
  b->in = in, b->out = scratch, b->vertical = false;
  RC_TRY(rc_parallel(context, b->height, smooth_row, b));
  b->in = scratch, b->out = out, b->vertical = true;
  return rc_parallel(context, b->height, smooth_row, b);
}

/* Mean square of a band by class of w, in the hole and in known pixels. */
typedef struct energies {
  double hole[RC_MAX_CLASSES], known[RC_MAX_CLASSES];
  long hole_count[RC_MAX_CLASSES], known_count[RC_MAX_CLASSES];
} energies;

static int class_at(const rc_level *level, int x, int y, float *position) {
  float w = rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
  if (!(w > 1e-4f)) return -1;
  float octave = (rc_log2(w) - level->ranges.log2_w0) / RC_CLASS_OCTAVES;
  if (!(octave > -.5f && octave < (float)level->ranges.count + .5f)) return -1;
  *position = octave - .5f;
  int c = (int)octave;
  return c < 0 ? 0 : c >= level->ranges.count ? level->ranges.count - 1 : c;
}

static double band_square(const bands *b, const float *fine, const float *coarse, size_t i) {
  double sum = 0;
  for (int k = 0; k < b->channels; k++) {
    double d = (double)fine[i * (size_t)b->channels + (size_t)k] -
               (double)coarse[i * (size_t)b->channels + (size_t)k];
    sum += d * d;
  }
  return sum;
}

static void measure(const bands *b, const rc_level *level, const uint8_t *clear, const float *fine,
                    const float *coarse, energies *e) {
  memset(e, 0, sizeof *e);
  for (int y = 0; y < b->height; y++)
    for (int x = 0; x < b->width; x++) {
      float position;
      size_t i = (size_t)y * (size_t)b->width + (size_t)x;
      int px = b->box.x0 + x, py = b->box.y0 + y, c = class_at(level, px, py, &position);
      if (c < 0) continue;
      if (rc_level_is_target(level, px, py)) {
        e->hole[c] += band_square(b, fine, coarse, i);
        e->hole_count[c]++;
      } else if (clear[(size_t)py * (size_t)level->width + (size_t)px] > 2 * RAMP_PX) {
        e->known[c] += band_square(b, fine, coarse, i);
        e->known_count[c]++;
      }
    }
}

static void gains_of(const energies *e, int classes, float gains[RC_MAX_CLASSES]) {
  for (int c = 0; c < classes; c++) {
    gains[c] = 1.f;
    if (e->hole_count[c] < LEAST_PIXELS || e->known_count[c] < LEAST_PIXELS) continue;
    double hole = e->hole[c] / (double)e->hole_count[c];
    double known = e->known[c] / (double)e->known_count[c];
    float gain = hole > 0 ? (float)sqrt(known / hole) : 1.f;
    gains[c] = fminf(fmaxf(gain, LEAST_GAIN), MOST_GAIN);
  }
}

static float gain_at(const float *gains, int classes, float position) {
  if (position <= 0.f) return gains[0];
  if (position >= (float)(classes - 1)) return gains[classes - 1];
  int c = (int)position;
  float t = position - (float)c;
  return gains[c] * (1.f - t) + gains[c + 1] * t;
}

static void apply(const bands *b, const rc_level *level, const uint8_t *depth,
                  float gains[BANDS][RC_MAX_CLASSES], float *const layers[BANDS + 1],
                  rc_image *residual) {
  for (int y = 0; y < b->height; y++)
    for (int x = 0; x < b->width; x++) {
      float position;
      int px = b->box.x0 + x, py = b->box.y0 + y;
      size_t i = ((size_t)y * (size_t)b->width + (size_t)x) * (size_t)b->channels;
      if (!rc_level_is_target(level, px, py) || class_at(level, px, py, &position) < 0) continue;
      float ramp = fminf(
          (float)depth[(size_t)py * (size_t)level->width + (size_t)px] / (RAMP_PX + 1.f), 1.f);
      float *pixel = rc_pixel(residual, px, py);
      for (int n = 0; n < BANDS; n++) {
        float more = ramp * (gain_at(gains[n], level->ranges.count, position) - 1.f);
        for (int k = 0; k < b->channels; k++)
          pixel[k] += more * (layers[n][i + (size_t)k] - layers[n + 1][i + (size_t)k]);
      }
    }
}

static rc_box grown(const rc_level *level) {
  rc_box box = level->box;
  box.x0 = box.x0 < SURROUNDINGS_PX ? 0 : box.x0 - SURROUNDINGS_PX;
  box.y0 = box.y0 < SURROUNDINGS_PX ? 0 : box.y0 - SURROUNDINGS_PX;
  box.x1 = box.x1 + SURROUNDINGS_PX > level->width ? level->width : box.x1 + SURROUNDINGS_PX;
  box.y1 = box.y1 + SURROUNDINGS_PX > level->height ? level->height : box.y1 + SURROUNDINGS_PX;
  return box;
}

recede_status rc_match_detail(rc_context *context, const rc_level *level, rc_image *residual) {
  bands b = {.residual = residual, .box = grown(level), .channels = residual->channels};
  float *layers[BANDS + 1], *scratch, gains[BANDS][RC_MAX_CLASSES];
  uint8_t *depth;
  energies e;
  rc_block *mark = rc_mark(context);
  b.width = b.box.x1 - b.box.x0, b.height = b.box.y1 - b.box.y0;
  size_t values = (size_t)b.width * (size_t)b.height * (size_t)b.channels;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &depth));
  RC_TRY(RC_NEW(context, values, &scratch));
  for (int n = 0; n <= BANDS; n++) RC_TRY(RC_NEW(context, values, &layers[n]));
  for (int y = 0; y < b.height; y++)
    memcpy(layers[0] + (size_t)y * (size_t)b.width * (size_t)b.channels,
           rc_pixel(residual, b.box.x0, b.box.y0 + y),
           (size_t)b.width * (size_t)b.channels * sizeof(float));
  for (int n = 0; n < BANDS; n++) {
    b.spacing = 1 << n;
    RC_TRY(smooth(context, &b, layers[n], scratch, layers[n + 1]));
    measure(&b, level, level->room, layers[n], layers[n + 1], &e);
    gains_of(&e, level->ranges.count, gains[n]);
    RC_TRY(rc_poll(context));
  }
  rc_distance_inside(level->flags, RC_TARGET, level->width, level->height, false, depth);
  RC_TRY(rc_poll(context));
  apply(&b, level, depth, gains, layers, residual);
  rc_release(context, mark);
  return RECEDE_OK;
}
