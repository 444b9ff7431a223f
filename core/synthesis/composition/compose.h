/* The composition: every target pixel sampled from the unblurred source by its own copy, and the
 * copies joined in the gradient domain. */
#ifndef RECEDE_SYNTHESIS_COMPOSITION_COMPOSE_H
#define RECEDE_SYNTHESIS_COMPOSITION_COMPOSE_H

#include "image/sampling.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/level.h"

/* level is the finest; residual holds known pixels and receives the target's. mips: residual and
 * its coarser copies, for sources finer than needed. join NULL: the copies as they are. */
recede_status rc_compose(rc_context *context, const rc_level *level, const rc_sampler *sampler,
                         const rc_image *mips, int mip_count, const rc_join *join,
                         rc_image *residual);

#endif
