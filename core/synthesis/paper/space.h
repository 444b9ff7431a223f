/* The space of the tree: a neighbourhood as a vector. */
#ifndef RECEDE_SYNTHESIS_PAPER_SPACE_H
#define RECEDE_SYNTHESIS_PAPER_SPACE_H

#include "synthesis/paper/level.h"
#include "synthesis/paper/neighbourhood.h"
#include "synthesis/paper/pca.h"

typedef struct rc_space {
  int width, channels;
  int block, side;    /* reduced: blocks of block x block px are averaged to side x side values */
  int inputs, stride; /* floats before the PCA; padded to whole lanes */
  bool reduced;       /* by the PCA */
  rc_pca pca;
  float scale_gain; /* factor of log2 S, appended to the components; 0: it is not */
  int dims;         /* of the vector, padded */
} rc_space;

/* The pixels themselves. */
void rc_space_raw(rc_space *space, int width, int channels);
/* Replaces them by the components that hold 95 % of the windows' variance. */
recede_status rc_space_reduce(rc_context *context, const rc_windows *windows, uint64_t key,
                              rc_space *space);
/* The neighbourhood before the PCA: stride floats. */
void rc_space_gather(const rc_space *space, const rc_image *image, rc_corner at, float *vector);
/* The neighbourhood's vector, dims floats; scratch holds stride floats. */
void rc_space_describe(const rc_space *space, const rc_side *side, rc_corner at, float *scratch,
                       float *vector);
/* log2 S at the neighbourhood's centre. */
float rc_window_log_scale(const rc_line *scale, rc_corner at, int width);

#endif
