/* Follows a line that crosses the hole to both sides of it, and says where to take it from. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_FOLLOW_H
#define RECEDE_SYNTHESIS_STRUCTURE_FOLLOW_H

#include "synthesis/structure/lines.h"
#include "synthesis/structure/profile.h"

/* Where a line's profile begins outside the hole. */
#define RC_PROFILE_FROM_PX 2.f
/* A line's own profile is that of so many px. */
#define RC_PROFILE_NEAR_PX 14

/* Moves the line's ends to where it meets the hole and sets its pieces' sources. False: it fades or
 * leaves the picture before the hole could be crossed; or, alone, no other vouching for it, it does
 * not go on for long. How far it reaches is told of faint ones, too. chart: of the same level. */
bool rc_follow(const rc_seen *picture, const rc_chart *chart, bool alone, rc_crossing *line);

#endif
