/* Coarse to fine: the only file that knows the order of the paper's steps. */
#ifndef RECEDE_SYNTHESIS_PAPER_LOOP_H
#define RECEDE_SYNTHESIS_PAPER_LOOP_H

#include "synthesis/paper/level.h"
#include "synthesis/paper/settings.h"

/* scale map -> pyramid -> start -> per level and neighbourhood width: tree, (search <-> update).
 * exemplar and output are the finest level's (colours only); same: they are one picture, a fill.
 * The unknown pixels of output->image are made. */
recede_status rc_paper_run(rc_context *context, const rc_paper_settings *settings, uint64_t seed,
                           const rc_side *exemplar, bool same, rc_side *output);

#endif
