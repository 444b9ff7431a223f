/* The optimization phase: weights (eqs 5-9) and the pixels that minimise the weighted energy. */
#ifndef RECEDE_SYNTHESIS_PAPER_UPDATE_H
#define RECEDE_SYNTHESIS_PAPER_UPDATE_H

#include "synthesis/paper/level.h"
#include "synthesis/paper/matches.h"
#include "synthesis/paper/settings.h"

#define RC_HISTOGRAM_BINS 16

/* Eq. 9's divisor for each colour's bins: what a vote of that colour is divided by beyond 1. */
typedef struct rc_histogram_weight {
  bool on;
  float low[3], per_bin[3]; /* bin = (value - low) * per_bin */
  float excess[3][RC_HISTOGRAM_BINS];
} rc_histogram_weight;

/* gain * max[0, H_x(b) - H_z(b)], histograms as parts of 1; 0 switches it off. */
void rc_histogram_compare(const rc_paper_level *level, double gain, rc_histogram_weight *weight);
/* Bin 0 too for a value that is not a number: the range of huge floats overflows. */
static inline int rc_histogram_bin(const rc_histogram_weight *weight, int k, float value) {
  float bin = (value - weight->low[k]) * weight->per_bin[k];
  return !(bin > 0) ? 0 : bin >= RC_HISTOGRAM_BINS ? RC_HISTOGRAM_BINS - 1 : (int)bin;
}
/* 1 / (1 + sum over the colours), eq. 9 without w_p. */
static inline float rc_histogram_of(const rc_histogram_weight *weight, const float *colour,
                                    int colours) {
  float sum = 1;
  for (int k = 0; k < colours; k++)
    sum += weight->excess[k][rc_histogram_bin(weight, k, colour[k])];
  return 1 / sum;
}

/* W_p of eq. 7 from the distances; returns the energy of eqs 5 and 8. */
double rc_energy_weights(const rc_paper_settings *settings, float least_distance,
                         rc_matches *matches);
/* Each unknown pixel becomes the weighted mean of what the neighbourhoods that hold its patch say.
 */
recede_status rc_paper_update(rc_context *context, const rc_paper_settings *settings,
                              const rc_matches *matches, const rc_histogram_weight *histogram,
                              rc_paper_level *level);

#endif
