#include "synthesis/search/effort.h"

/* A cut through 12000 px takes .1 s, through 70000 one. More starts and more iterations than
 * normal's only find what fits ever better, and is bland: of drawn stones .066 are then chips and
 * .052 come again, .050 and .030 with normal's, .036 and .019 where seams are cut again. */
static const rc_effort efforts[] = {
    [RECEDE_QUALITY_DRAFT] = {2, 30, 6, 2, 0, 2, 8, 0, 0, {7, 24}},
    [RECEDE_QUALITY_NORMAL] = {6, 60, 12, 2, 2, 4, 16, 12000, 0, {22, 64}},
    [RECEDE_QUALITY_BEST] = {6, 60, 12, 2, 2, 4, 16, 12000, 70000, {22, 64}},
};

const rc_effort *rc_effort_of(const recede_params *params) { return &efforts[params->quality]; }
