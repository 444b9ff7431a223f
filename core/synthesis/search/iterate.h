/* What each level of the descent does again and again: search and vote in turn. */
#ifndef RECEDE_SYNTHESIS_SEARCH_ITERATE_H
#define RECEDE_SYNTHESIS_SEARCH_ITERATE_H

#include <stdatomic.h>

#include "synthesis/search/descent.h"

/* Scratch of a level. */
typedef struct rc_workspace {
  rc_copy *old;
  float *usage; /* NULL: sources cost nothing here */
} rc_workspace;

/* Iterations that a stage has done, of how many: its progress. */
typedef struct rc_pace {
  atomic_int done;
  int total;
} rc_pace;

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
