/* The one table of what the quality levels change. */
#ifndef RECEDE_SYNTHESIS_SEARCH_EFFORT_H
#define RECEDE_SYNTHESIS_SEARCH_EFFORT_H

#include "recede.h"

/* How far from a seam a copy takes its neighbours' tone on, and by how many sweeps, a multiple of
 * 8, that is solved: 3 for each px leave 1 to 2 % of the error. */
typedef struct rc_join {
  float reach_px;
  int sweeps;
} rc_join;

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

const rc_effort *rc_effort_of(const recede_params *params);

#endif
