/* Eq. 9: votes for colours that the output already has too much of weigh less. */
#include <float.h>
#include <string.h>

#include "synthesis/paper/update.h"

static bool counted(const rc_side *side, uint8_t flag, int x, int y) {
  return (*rc_flag(&side->flags, x, y) & flag) != 0;
}

static void find_range(const rc_paper_level *level, rc_histogram_weight *weight) {
  const rc_side *side = &level->exemplar;
  float low[3] = {FLT_MAX, FLT_MAX, FLT_MAX}, high[3] = {-FLT_MAX, -FLT_MAX, -FLT_MAX};
  for (int y = 0; y < side->image.height; y++)
    for (int x = 0; x < side->image.width; x++)
      for (int k = 0; k < level->colours && counted(side, RC_SOURCE, x, y); k++) {
        float v = rc_pixel(&side->image, x, y)[k];
        low[k] = v < low[k] ? v : low[k];
        high[k] = v > high[k] ? v : high[k];
      }
  for (int k = 0; k < level->colours; k++) {
    weight->low[k] = low[k];
    weight->per_bin[k] = high[k] > low[k] ? RC_HISTOGRAM_BINS / (high[k] - low[k]) : 0;
  }
}

static void count_pixels(const rc_side *side, uint8_t flag, int colours,
                         const rc_histogram_weight *weight,
                         double histogram[3][RC_HISTOGRAM_BINS]) {
  double pixels = 0;
  memset(histogram, 0, 3 * sizeof *histogram);
  for (int y = 0; y < side->image.height; y++)
    for (int x = 0; x < side->image.width; x++) {
      if (!counted(side, flag, x, y)) continue;
      const float *pixel = rc_pixel(&side->image, x, y);
      pixels++;
      for (int k = 0; k < colours; k++) histogram[k][rc_histogram_bin(weight, k, pixel[k])]++;
    }
  for (int k = 0; k < colours && pixels > 0; k++)
    for (int b = 0; b < RC_HISTOGRAM_BINS; b++) histogram[k][b] /= pixels;
}

void rc_histogram_compare(const rc_paper_level *level, double gain, rc_histogram_weight *weight) {
  double of_output[3][RC_HISTOGRAM_BINS], of_exemplar[3][RC_HISTOGRAM_BINS];
  memset(weight, 0, sizeof *weight);
  if (!(gain > 0)) return;
  weight->on = true;
  find_range(level, weight);
  count_pixels(&level->output, RC_TARGET, level->colours, weight, of_output);
  count_pixels(&level->exemplar, RC_SOURCE, level->colours, weight, of_exemplar);
  for (int k = 0; k < level->colours; k++)
    for (int b = 0; b < RC_HISTOGRAM_BINS; b++) {
      double more = of_output[k][b] - of_exemplar[k][b];
      weight->excess[k][b] = more > 0 ? (float)(gain * more) : 0;
    }
}
