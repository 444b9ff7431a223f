/* The composition: every target pixel sampled from the unblurred source by its own copy, and the
 * copies joined in the gradient domain. */
#ifndef RECEDE_SYNTHESIS_COMPOSE_H
#define RECEDE_SYNTHESIS_COMPOSE_H

#include "image/sampling.h"
#include "synthesis/level.h"

/* How far from a seam a copy takes its neighbours' tone on, and by how many sweeps, a multiple of
 * 8, that is solved: 3 for each px leave 1 to 2 % of the error. */
typedef struct rc_join {
  float reach_px;
  int sweeps;
} rc_join;

/* level is the finest; residual holds known pixels and receives the target's. mips: residual and
 * its coarser copies, for sources finer than needed. join NULL: the copies as they are. */
recede_status rc_compose(rc_context *context, const rc_level *level, const rc_sampler *sampler,
                         const rc_image *mips, int mip_count, const rc_join *join,
                         rc_image *residual);

#endif
