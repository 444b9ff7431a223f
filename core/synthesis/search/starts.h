/* Trials of the coarsest level, beside each other: each starts in its own way, and that which fits
 * best is kept. */
#ifndef RECEDE_SYNTHESIS_SEARCH_STARTS_H
#define RECEDE_SYNTHESIS_SEARCH_STARTS_H

#include "synthesis/search/trial.h"

/* Some of all trials: starts by patches first, then those of few whole copies, which are these
 * moves or, where there are none, chance ones. */
typedef struct rc_starts {
  int first, first_whole, end;
  const rc_copy *moves;
  int move_count;
} rc_starts;

/* All trials get a third of their iterations, the better half of them the rest. Of two both get
 * all: a third of a draft's few says too little. How many that are. */
int rc_work_of_starts(int trials, int iterations);
/* Keeps the start that fits best, which the level then holds, and what it costs: its misfit, and
 * the lines that it breaks. */
recede_status rc_try_starts(rc_context *context, const rc_descent *e, const rc_starts *s,
                            rc_pace *p, rc_level *level, rc_workspace *scratch, rc_trial *best,
                            double *least);

#endif
