/* Whether a line stands alone, as a kerb or a rail does, or comes again beside itself, as joints of
 * bricks and boards do. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_ALONE_H
#define RECEDE_SYNTHESIS_STRUCTURE_ALONE_H

#include "synthesis/structure/lines.h"

/* Looks so many px to each side of either end for parallel lines of the plane that look the same.
 * periods: two by which the texture seems to come again, and then the line must not; NULL: it does
 * not seem to. All is of the same level. */
bool rc_stands_alone(const rc_seen *picture, const rc_chart *chart, const rc_crossing *line,
                     int reach_px, const rc_copy periods[2]);
/* The same of its end b alone. */
bool rc_end_stands_alone(const rc_seen *picture, const rc_chart *chart, const rc_crossing *line,
                         int reach_px);

#endif
