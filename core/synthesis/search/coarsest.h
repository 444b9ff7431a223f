/* The coarsest level, where chance decides: started several times, the best is kept. */
#ifndef RECEDE_SYNTHESIS_SEARCH_COARSEST_H
#define RECEDE_SYNTHESIS_SEARCH_COARSEST_H

#include "synthesis/search/iterate.h"

/* Finds periods, which *e keeps, and fills the level. */
recede_status rc_run_coarsest(rc_context *context, rc_descent *e, rc_level *level,
                              rc_workspace *scratch);

#endif
