/* Dashes that the hole cuts and that lie in no row that is found: too few are seen of theirs. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_DASH_LONE_H
#define RECEDE_SYNTHESIS_STRUCTURE_DASH_LONE_H

#include "synthesis/structure/dash_sight.h"

/* Adds a row of each alone, made of its rest, as long as those that are wholly seen. After the
 * dashes of the other rows are chosen. */
recede_status rc_dash_rows_add_lone(rc_context *context, const rc_dash_sight *sight,
                                    const rc_mask *flags, rc_dash_rows *rows);

#endif
