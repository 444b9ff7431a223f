#include "synthesis/paper/settings.h"

/* As printed: 8 x 8 RGBS neighbourhoods, several levels, nothing else. */
static const rc_paper_settings literal = {
    .levels = 3,
    .widths = {8},
    .width_count = 1,
    .patch = 2,
    .pca = true,
    .scale_channel = true,
    .tree_leaf = RC_TREE_BRANCHES,
    .exponent = .8,
    .histogram_gain = 1,
    .iterations = 8,
};

/* What it takes to look like the exemplar. Measured on fills of 130 px (six cases, mean score):
 * what reaches over the border voting 31 times instead of once is worth 59 -> 75. */
static const rc_paper_settings repaired = {
    .levels = 4,
    .widths = {16, 8},
    .width_count = 2,
    .patch = 2,
    .pca = true,
    .scale_apart = true,
    .coherence = true,
    .vote_first = true,
    .border_trust = 30,
    .tree_leaf = RC_TREE_BRANCHES,
    .exponent = .8,
    .histogram_gain = 10,
    .iterations = 8,
};

/* Texture optimization (2005), which the paper compares with. */
static const rc_paper_settings baseline = {
    .levels = 3,
    .widths = {32, 16, 8},
    .width_count = 3,
    .patch = 1,
    .tree_stop = .01,
    .tree_leaf = RC_TREE_BRANCHES,
    .exponent = .8,
    .iterations = 8,
};

rc_paper_settings rc_paper_settings_of(const recede_params *params) {
  bool kwatra = params->method == RECEDE_METHOD_KWATRA;
  rc_paper_settings s = kwatra ? baseline : params->paper_literal ? literal : repaired;
  s.exponent = params->paper_exponent;
  if (params->paper_iterations) s.iterations = params->paper_iterations;
  if (params->paper_levels) s.levels = params->paper_levels;
  if (kwatra) return s;
  if (params->paper_width) s.widths[s.width_count - 1] = params->paper_width;
  if (params->paper_width_coarse) {
    s.widths[1] = s.widths[s.width_count - 1];
    s.widths[0] = params->paper_width_coarse;
    s.width_count = s.widths[0] > s.widths[1] ? 2 : 1;
    if (s.width_count == 1) s.widths[0] = s.widths[1];
  }
  if (params->paper_coherence >= 0) s.coherence = params->paper_coherence != 0;
  if (params->paper_scale_in_pca >= 0) {
    s.scale_channel = params->paper_scale_in_pca != 0;
    s.scale_apart = !s.scale_channel;
  }
  if (params->paper_histogram_gain >= 0) s.histogram_gain = params->paper_histogram_gain;
  return s;
}
