/* What the paper's method, its repair and the baseline differ in: numbers, not code. */
#ifndef RECEDE_SYNTHESIS_PAPER_SETTINGS_H
#define RECEDE_SYNTHESIS_PAPER_SETTINGS_H

#include <stdbool.h>

#include "recede.h"

#define RC_PAPER_MAX_LEVELS 10
#define RC_TREE_BRANCHES 4 /* k of the k-means tree */
/* Neighbourhoods in the tree, at most: more cost time and memory, and coherence reaches the others.
 * Without PCA their vectors are long. */
#define RC_MOST_MEMBERS 24576
#define RC_MOST_RAW_MEMBERS 8192

typedef struct rc_paper_settings {
  int levels;    /* pyramid levels, the finest included */
  int widths[3]; /* neighbourhoods of one level in the order of their sweeps, px */
  int width_count;
  int patch;             /* pixels updated together, patch x patch: 2 in the paper, else 1 */
  bool pca;              /* search in the principal components */
  bool scale_channel;    /* S is a channel of the neighbourhood: RGBS */
  bool scale_apart;      /* log2 S is one number beside the components */
  bool coherence;        /* try the neighbours' matches, shifted */
  double border_trust;   /* a neighbourhood of known pixels only would vote 1 + this times */
  bool vote_first;       /* vote from the coarser level's matches before searching */
  double tree_stop;      /* a node of fewer than this part of all neighbourhoods is a leaf ... */
  int tree_leaf;         /* ... or of fewer than this many */
  double exponent;       /* r of eq. 5 */
  double histogram_gain; /* factor of eq. 9's sum; 0: no histogram weight */
  int iterations;        /* of one sweep, at most; it ends when the matches no longer change */
} rc_paper_settings;

/* The three methods, changed by the developers' parameters. */
rc_paper_settings rc_paper_settings_of(const recede_params *params);

#endif
