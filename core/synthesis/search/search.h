/* The search: better copies for every target pixel, by propagation and by chance. */
#ifndef RECEDE_SYNTHESIS_SEARCH_SEARCH_H
#define RECEDE_SYNTHESIS_SEARCH_SEARCH_H

#include "synthesis/search/evaluate.h"
#include "synthesis/structure/rails.h"

typedef struct rc_search {
  const rc_kernels *kernels;
  uint64_t key;           /* of the random numbers: seed, level, iteration, pass */
  int pass;               /* even: forward, odd: backward and the tiles shifted by half */
  bool recost;            /* the guide has changed since the costs were taken */
  float coherence;        /* price for each 4-neighbour with another copy, in variances */
  const float *usage;     /* price of each pixel as a source, or NULL */
  int local_radius;       /* largest radius of the local random candidates, px; 0 = none */
  int anywhere;           /* random candidates from all sources of the right scale */
  const rc_copy *periods; /* candidates to add to the pixel's copy (flat) */
  int period_count, period_tries;
  rc_rails rails;       /* candidates by chance keep to these if they run */
  float rail_tolerance; /* px, where w = 1 */
} rc_search;

/* One pass over the level's field. old is scratch of box_w * box_h. */
recede_status rc_search_pass(rc_context *context, rc_level *level, const rc_search *search,
                             rc_copy *old);

/* The copy that takes target (x, y) from (to_x, to_y) or the nearest point that the search may. */
static inline rc_copy rc_search_copy(const rc_search *search, const rc_level *level, float x,
                                     float y, float to_x, float to_y) {
  const rc_chart *chart = &level->chart;
  if (rc_has_lattice(&level->lattice))
    return rc_copy_on_lattice(&level->lattice, chart, x, y, to_x, to_y);
  if (rc_runs(&search->rails))
    return rc_copy_on_rails(&search->rails, chart, search->rail_tolerance, x, y, to_x, to_y);
  return rc_copy_between(chart, x, y, to_x, to_y);
}

#endif
