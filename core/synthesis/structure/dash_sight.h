/* What is seen of a row of dashes, and what of it is not there. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_DASH_SIGHT_H
#define RECEDE_SYNTHESIS_STRUCTURE_DASH_SIGHT_H

#include "synthesis/structure/dash_row.h"

typedef struct rc_dash_sight {
  rc_ground ground;
  int exponent; /* of the level in which dashes were looked for */
  rc_dashes dashes;
} rc_dash_sight;

/* Whether a row's n-th dash is not where it would be seen. */
bool rc_dash_is_missing(const rc_dash_sight *sight, const rc_dash_row *row, int n);
/* Whether hardly anything stands out to both sides of a dash in the row's middle, of this length.
 */
bool rc_dash_is_on_plain(const rc_dash_sight *sight, const rc_dash_row *row, double length);
/* Whether paint is all that stands out in it, from the first to the last. */
bool rc_dash_row_is_plain(const rc_dash_sight *sight, const rc_dash_row *row, int first, int last);

#endif
