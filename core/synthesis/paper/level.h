/* One pyramid level of the paper's synthesis: what is copied from, what is made. */
#ifndef RECEDE_SYNTHESIS_PAPER_LEVEL_H
#define RECEDE_SYNTHESIS_PAPER_LEVEL_H

#include "synthesis/problem.h"

/* One side of it, exemplar or output. image has colours channels and, where S is a channel of the
 * neighbourhood, S as one more. In a fill both sides are one picture. */
typedef struct rc_side {
  rc_image image;
  rc_mask flags;
  rc_line scale;
} rc_side;

typedef struct rc_paper_level {
  rc_side exemplar; /* flags: SOURCE may be copied */
  rc_side output;   /* flags: all but KNOWN pixels are made */
  int colours;
} rc_paper_level;

static inline bool rc_unknown(const rc_side *output, int x, int y) {
  return !(*rc_flag(&output->flags, x, y) & RC_KNOWN);
}

/* A copy of the picture with S (a channel of RGBS) behind its colours. */
recede_status rc_side_with_scale(rc_context *context, const rc_side *side, rc_side *with);
/* Unknown pixels of fine from the coarser level's, bilinear. */
void rc_side_upsample(const rc_side *coarse, int colours, rc_side *fine);
/* The paper's start: each unknown pixel takes a random exemplar pixel of its own scale, within
 * RC_SCALE_TOLERANCE. A fixed choice would repeat one pixel along each line of equal scale. */
#define RC_SCALE_TOLERANCE .02f
#define RC_SCALE_CANDIDATES 32 /* at least; the tolerance widens until there are so many */
recede_status rc_paper_start(rc_context *context, rc_paper_level *level, uint64_t seed);

#endif
