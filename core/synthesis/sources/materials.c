#include "synthesis/sources/materials.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"

/* So much of the square must be known. */
#define LEAST_KNOWN .4f
/* What a value differs by is the median from so many places to the next that share no pixel with
 * them, and this more, of white: even surfaces have hardly any. */
#define MOST_STEPS 4096
#define LEAST_STEP .002f

/* Of known pixels: how many, their colours, brightness and its square. Of those of the finer level
 * that have all neighbours: how many, and the squares of what those differ by. */
enum { KNOWN, RED, GREEN, BLUE, BRIGHT, SQUARE, FINER, ALONG, ACROSS, SUMS };

typedef struct finder {
  const rc_image *image, *finer;
  const rc_mask *flags, *finer_flags;
  int shift; /* 0: there is no finer level */
  int half_px;
  float (*sums)[SUMS]; /* of each pixel */
  rc_material *out;
} finder;

static bool is_known(const rc_mask *flags, int x, int y) {
  return rc_inside(flags->width, flags->height, x, y) && *rc_flag(flags, x, y) & RC_KNOWN;
}

static void add_grain(const finder *f, int x, int y, float sums[SUMS]) {
  const rc_mask *flags = f->finer_flags;
  if (!is_known(flags, x, y) || !is_known(flags, x - 1, y) || !is_known(flags, x + 1, y) ||
      !is_known(flags, x, y - 1) || !is_known(flags, x, y + 1))
    return;
  float along = rc_brightness_at(f->finer, x + 1, y) - rc_brightness_at(f->finer, x - 1, y);
  float across = rc_brightness_at(f->finer, x, y + 1) - rc_brightness_at(f->finer, x, y - 1);
  sums[FINER]++;
  sums[ALONG] += along * along;
  sums[ACROSS] += across * across;
}

static void sum_row(void *user, int y, int thread) {
  const finder *f = user;
  int width = f->image->width, n = 1 << f->shift;
  (void)thread;
  for (int x = 0; x < width; x++) {
    float *sums = f->sums[(size_t)y * (size_t)width + (size_t)x];
    if (is_known(f->flags, x, y)) {
      const float *v = rc_pixel(f->image, x, y);
      float bright = rc_brightness_at(f->image, x, y);
      sums[KNOWN] = 1;
      for (int k = 0; k < 3; k++) sums[RED + k] = v[f->image->channels == 1 ? 0 : k];
      sums[BRIGHT] = bright;
      sums[SQUARE] = bright * bright;
    }
    for (int j = 0; j < n; j++)
      for (int i = 0; i < n; i++) add_grain(f, x * n + i, y * n + j, sums);
  }
}

static void describe(const float sums[SUMS], int pixels, rc_material *out) {
  float known = sums[KNOWN], finer = fmaxf(sums[FINER], 1);
  float red = sums[RED] / known, green = sums[GREEN] / known, blue = sums[BLUE] / known;
  float bright = sums[BRIGHT] / known;
  out->value[0] = known < LEAST_KNOWN * (float)pixels ? NAN : bright;
  out->value[1] = red - green;
  out->value[2] = blue - (red + green) * .5f;
  out->value[3] = sqrtf(fmaxf(sums[SQUARE] / known - bright * bright, 0));
  out->value[4] = sqrtf(sums[ALONG] / finer);
  out->value[5] = sqrtf(sums[ACROSS] / finer);
}

static void describe_row(void *user, int y, int thread) {
  const finder *f = user;
  int width = f->image->width, height = f->image->height, half = f->half_px;
  int y0 = y < half ? 0 : y - half, y1 = y + half >= height ? height : y + half + 1;
  (void)thread;
  for (int x = 0; x < width; x++) {
    int x0 = x < half ? 0 : x - half, x1 = x + half >= width ? width : x + half + 1;
    float sums[SUMS] = {0};
    for (int j = y0; j < y1; j++)
      for (int i = x0; i < x1; i++)
        for (int k = 0; k < SUMS; k++) sums[k] += f->sums[(size_t)j * (size_t)width + (size_t)i][k];
    describe(sums, (x1 - x0) * (y1 - y0), &f->out[(size_t)y * (size_t)width + (size_t)x]);
  }
}

static bool is_told(const finder *f, int x, int y) {
  return rc_inside(f->image->width, f->image->height, x, y) &&
         *rc_flag(f->flags, x, y) & RC_SOURCE &&
         !isnan(f->out[(size_t)y * (size_t)f->image->width + (size_t)x].value[0]);
}

static float usual_step(const finder *f, int k, float steps[MOST_STEPS]) {
  int width = f->image->width, apart = 2 * f->half_px + 1, count = 0;
  int32_t pixels = width * f->image->height, every = pixels / (MOST_STEPS / 2) + 1;
  for (int32_t i = 0; i < pixels; i += every) {
    int x = i % width, y = i / width;
    if (!is_told(f, x, y)) continue;
    float here = f->out[i].value[k];
    if (is_told(f, x + apart, y)) steps[count++] = fabsf(here - f->out[i + apart].value[k]);
    if (is_told(f, x, y + apart)) steps[count++] = fabsf(here - f->out[i + apart * width].value[k]);
  }
  qsort(steps, (size_t)count, sizeof *steps, rc_by_value);
  return count ? steps[count / 2] : 0;
}

recede_status rc_materials_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                                int levels, int half_px, rc_material *materials) {
  int coarsest = levels - 1, finer = levels > 1 ? levels - 2 : 0;
  finder f = {.image = &images[coarsest],
              .finer = &images[finer],
              .flags = &flags[coarsest],
              .finer_flags = &flags[finer],
              .shift = coarsest - finer,
              .half_px = half_px,
              .out = materials};
  size_t pixels = (size_t)f.image->width * (size_t)f.image->height;
  float *steps, per_step[RC_MATERIAL];
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, pixels, &f.sums));
  RC_TRY(RC_NEW(context, MOST_STEPS, &steps));
  RC_TRY(rc_parallel(context, f.image->height, sum_row, &f));
  RC_TRY(rc_parallel(context, f.image->height, describe_row, &f));
  for (int k = 0; k < RC_MATERIAL; k++) per_step[k] = 1 / (usual_step(&f, k, steps) + LEAST_STEP);
  for (size_t i = 0; i < pixels; i++)
    for (int k = 0; k < RC_MATERIAL; k++) materials[i].value[k] *= per_step[k];
  rc_release(context, mark);
  return rc_poll(context);
}
