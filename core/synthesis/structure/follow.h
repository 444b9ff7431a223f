/* Follows a line that crosses the hole to both sides of it, and says where to take it from. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_FOLLOW_H
#define RECEDE_SYNTHESIS_STRUCTURE_FOLLOW_H

#include "synthesis/structure/lines.h"
#include "synthesis/structure/profile.h"

/* In how many windows a line must go on that no other vouches for. seen_coarser: than others are.
 */
int rc_windows_of(const rc_crossing *line, bool seen_coarser);
/* Moves the line's ends to where it meets the hole and sets its pieces' sources; of one that leaves
 * the picture, or recedes, all lie beyond b. False: it fades or leaves the picture before the hole
 * could be crossed, or does not go on in so many windows. How far it reaches is told of faint ones,
 * too. chart: of the same level. */
bool rc_follow(const rc_seen *picture, const rc_chart *chart, int windows, rc_crossing *line);
/* The same of one that ends inside, which is known at b alone; how far it reaches is not told. */
bool rc_follow_branch(const rc_seen *picture, const rc_chart *chart, int windows,
                      rc_crossing *branch);

#endif
