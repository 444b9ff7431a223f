/* What each level of the descent does again and again: search and vote in turn. */
#ifndef RECEDE_SYNTHESIS_ITERATE_H
#define RECEDE_SYNTHESIS_ITERATE_H

#include "synthesis/compose.h"
#include "synthesis/descent.h"
#include "synthesis/search.h"

/* What the quality levels change. */
typedef struct rc_effort {
  int starts;            /* of the coarsest level; the best is kept */
  int start_tries;       /* random candidates per pixel of the start */
  int coarse_iterations; /* at the coarsest level; half as many with each finer one */
  int fine_iterations;   /* but at least these */
  int finest_iterations; /* and these at the finest; 0: only takes the coarser copies over */
  int anywhere;          /* random candidates per pixel from all sources, coarsest level */
  int local_radius;      /* largest radius of the random candidates nearby, px */
  int cut_px;            /* seams are led by cuts at the finest level, but the very finest, that has
                            no more px of hole; 0: nowhere */
  int cut_again_px;      /* and once more at each finer one that has no more */
  rc_join join;
} rc_effort;

/* Scratch of a level. */
typedef struct rc_workspace {
  rc_copy *old;
  float *usage; /* NULL: sources cost nothing here */
} rc_workspace;

/* Iterations that a stage has done, of how many: its progress. */
typedef struct rc_pace {
  int done, total;
} rc_pace;

const rc_effort *rc_effort_of(const recede_params *params);
int rc_iterations_at(const rc_descent *e, int exponent);
recede_status rc_workspace_new(rc_context *context, const rc_descent *e, int exponent,
                               const rc_level *level, rc_workspace *scratch);
/* Iterations from .. to - 1 of the trial; only the coarsest level has more than one trial. */
recede_status rc_iterate(rc_context *context, const rc_descent *e, int exponent, int trial,
                         int from, int to, rc_pace *p, rc_level *level, rc_workspace *scratch);
/* Propagation alone, with a higher price on incoherence: whole copies for the composition. */
recede_status rc_settle(rc_context *context, const rc_descent *e, rc_level *level,
                        rc_workspace *scratch);

#endif
