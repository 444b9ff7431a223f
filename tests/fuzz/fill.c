/* Fuzz: fills of tiny pictures with any pixels, mask, type, plane and method. A fill that succeeds
 * must leave the pixels outside the mask alone and write finite values only; one that fails must
 * leave all and say why. */
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "recede.h"

#define MOST_PX 24

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The input, read byte by byte; zeros after its end. */
typedef struct input {
  const uint8_t *data;
  size_t left;
} input;

static uint8_t next(input *in) {
  if (!in->left) return 0;
  in->left--;
  return *in->data++;
}

static int one_of(input *in, int count) { return next(in) % count; }

static size_t bytes_of(recede_type type) {
  return type == RECEDE_U8 ? 1 : type == RECEDE_FLOAT ? 4 : 2;
}

static void choose(input *in, recede_params *params, int width, int height) {
  recede_params_init(params);
  params->method = (recede_method)one_of(in, 3);
  params->surface = (recede_surface)one_of(in, 3);
  params->quality = RECEDE_QUALITY_DRAFT;
  params->paper_literal = one_of(in, 2);
  params->orientation = (recede_orientation_source)one_of(in, 5);
  params->slant_deg = one_of(in, 180);
  params->tilt_deg = one_of(in, 2) ? one_of(in, 181) : -one_of(in, 181);
  for (int i = 0; i < 4; i++) params->horizon[i] = (int8_t)next(in);
  for (int i = 0; i < 8; i++) params->quad[i] = one_of(in, i & 1 ? height + 4 : width + 4);
}

static recede_view view_new(int width, int height, int channels, recede_type type) {
  size_t stride = (size_t)width * (size_t)channels * bytes_of(type);
  recede_view view = {malloc(stride * (size_t)height), stride, width, height, channels, type};
  if (!view.data) abort();
  return view;
}

static void read_into(input *in, const recede_view *view) {
  uint8_t *bytes = view->data;
  for (size_t i = 0; i < view->stride_bytes * (size_t)view->height; i++) bytes[i] = next(in);
}

/* Says what was found, for of a run elsewhere only that line is kept. */
static void broken(const char *format, ...) {
  va_list args;
  va_start(args, format);
  fputs("SUMMARY: ", stderr);
  vfprintf(stderr, format, args);
  fputs("\n", stderr);
  va_end(args);
  abort();
}

/* Pixels beyond the horizon stay as they were. */
static void check_finite(const recede_view *image, const uint8_t *before) {
  const float *old = (const void *)before, *made = image->data;
  if (image->type != RECEDE_FLOAT) return;
  for (size_t i = 0; i < image->stride_bytes / sizeof *made * (size_t)image->height; i++)
    if (!isfinite(made[i]) && memcmp(&made[i], &old[i], sizeof *made) != 0)
      broken("value %zu was %g and is %g", i, (double)old[i], (double)made[i]);
}

static void check(const recede_view *image, const recede_view *mask, const uint8_t *before,
                  recede_status status) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  size_t pixel = image->stride_bytes / (size_t)image->width;
  const uint8_t *after = image->data, *marked = mask->data;
  for (size_t i = 0; i < pixels; i++)
    if ((status != RECEDE_OK || !marked[i]) &&
        memcmp(before + i * pixel, after + i * pixel, pixel) != 0)
      broken("pixel %zu changed, mask %d, status %d", i, marked[i], (int)status);
  check_finite(image, before);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static const recede_type types[] = {RECEDE_U8, RECEDE_U16, RECEDE_HALF, RECEDE_FLOAT};
  input in = {data, size};
  int width = 1 + one_of(&in, MOST_PX), height = 1 + one_of(&in, MOST_PX);
  int channels = 1 + one_of(&in, 4);
  recede_view image = view_new(width, height, channels, types[one_of(&in, 4)]);
  recede_view mask = view_new(width, height, 1, RECEDE_U8);
  recede_host host;
  recede_params params;
  recede_host_init(&host);
  host.threads = 1;
  choose(&in, &params, width, height);
  read_into(&in, &mask);
  read_into(&in, &image);
  size_t bytes = image.stride_bytes * (size_t)height;
  uint8_t *before = malloc(bytes);
  recede_job *job = recede_job_new(&host);
  if (!before || !job) abort();
  memcpy(before, image.data, bytes);
  recede_job_set_image(job, &image);
  recede_job_set_mask(job, &mask);
  recede_status status = recede_job_set_params(job, &params);
  if (status == RECEDE_OK) status = recede_job_fill(job, &image);
  if (status != RECEDE_OK && !recede_job_message(job)[0])
    broken("status %d without a message", (int)status);
  check(&image, &mask, before, status);
  recede_job_free(&job);
  free(before);
  free(mask.data);
  free(image.data);
  return 0;
}
