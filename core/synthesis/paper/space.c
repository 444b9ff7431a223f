/* What the tree compares: neighbourhoods as they are (the baseline), or their principal components
 * (the paper), with S beside them where it is kept apart from the PCA. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "synthesis/paper/scale_channel.h"
#include "synthesis/paper/space.h"

/* The paper's part of the variance. */
#define VARIANCE_KEPT .95
/* The eigenvectors of 256 numbers take 22 ms, of 768 (RGB, 16 x 16) most of a second. What holds 95
 * % of a wide neighbourhood's variance is smooth, so that wider ones are averaged to this side
 * first. */
#define PCA_SIDE 8
/* Neighbourhoods that the components are made from. */
#define PCA_SAMPLE 2048

void rc_space_raw(rc_space *space, int width, int channels) {
  int inputs = width * width * channels;
  *space = (rc_space){.width = width,
                      .channels = channels,
                      .block = 1,
                      .side = width,
                      .inputs = inputs,
                      .stride = rc_padded(inputs),
                      .dims = rc_padded(inputs)};
}

/* One block's average, in units that keep ||x_p - z_p||^2 of smooth neighbourhoods. */
static void average_block(const rc_space *space, const rc_image *image, rc_corner at, int bx,
                          int by, float *out) {
  int x1 = bx + space->block < space->width ? bx + space->block : space->width;
  int y1 = by + space->block < space->width ? by + space->block : space->width;
  float pixels = (float)((x1 - bx) * (y1 - by));
  for (int k = 0; k < space->channels; k++) out[k] = 0;
  for (int y = by; y < y1; y++)
    for (int x = bx; x < x1; x++) {
      const float *pixel = rc_pixel(image, at.x + x, at.y + y);
      for (int k = 0; k < space->channels; k++) out[k] += pixel[k];
    }
  for (int k = 0; k < space->channels; k++) out[k] /= sqrtf(pixels);
}

void rc_space_gather(const rc_space *space, const rc_image *image, rc_corner at, float *vector) {
  size_t row = (size_t)space->side * (size_t)space->channels;
  for (int y = 0; y < space->side; y++) {
    float *out = vector + (size_t)y * row;
    if (space->block == 1) {
      memcpy(out, rc_pixel(image, at.x, at.y + y), row * sizeof *out);
      continue;
    }
    for (int x = 0; x < space->side; x++)
      average_block(space, image, at, x * space->block, y * space->block,
                    out + (size_t)x * (size_t)space->channels);
  }
  memset(vector + space->inputs, 0, (size_t)(space->stride - space->inputs) * sizeof *vector);
}

float rc_window_log_scale(const rc_line *scale, rc_corner at, int width) {
  double centre = .5 * (width - 1);
  return rc_log2(rc_scale(scale, at.x + centre, at.y + centre));
}

void rc_space_describe(const rc_space *space, const rc_side *side, rc_corner at, float *scratch,
                       float *vector) {
  if (!space->reduced) {
    rc_space_gather(space, &side->image, at, vector);
    return;
  }
  rc_space_gather(space, &side->image, at, scratch);
  rc_pca_project(&space->pca, scratch, vector);
  int used = space->pca.components;
  if (space->scale_gain > 0)
    vector[used++] = space->scale_gain * rc_window_log_scale(&side->scale, at, space->width);
  memset(vector + used, 0, (size_t)(space->dims - used) * sizeof *vector);
}

recede_status rc_space_reduce(rc_context *context, const rc_windows *windows, uint64_t key,
                              rc_space *space) {
  float *vectors;
  rc_corner *corners;
  int count;
  space->block = (space->width + PCA_SIDE - 1) / PCA_SIDE;
  space->side = (space->width + space->block - 1) / space->block;
  space->inputs = space->side * space->side * space->channels;
  space->stride = rc_padded(space->inputs);
  space->reduced = true;
  RC_TRY(rc_windows_sample(context, windows, PCA_SAMPLE, key, &corners, &count));
  RC_TRY(RC_NEW(context, (size_t)count * (size_t)space->stride, &vectors));
  for (int i = 0; i < count; i++)
    rc_space_gather(space, windows->image, corners[i], vectors + (size_t)i * (size_t)space->stride);
  RC_TRY(rc_pca_find(context, vectors, count, space->inputs, VARIANCE_KEPT, &space->pca));
  RC_FREE(context, &vectors);
  RC_FREE(context, &corners);
  space->dims = rc_padded(space->pca.components + (space->scale_gain > 0));
  return RECEDE_OK;
}
