/* How far a line reaches to both sides of where it is known. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_REACH_H
#define RECEDE_SYNTHESIS_STRUCTURE_REACH_H

#include "synthesis/structure/profile.h"

/* Makes reach_px, px where w = 1 to its left and right, no less than at this end: from what stands
 * out most in the line's middle on while it is not yet as the ground is, which is the same on both
 * sides. Where two grounds meet there is no such thing. An end so far away that a pixel blurs it
 * says nothing. ruler: along the line, of that chart. outwards: -1 or 1, where the hole is behind.
 * may_be_broad: if nothing is told a marking of twice the width is looked for. */
void rc_reach_measure(const rc_ruler *ruler, float outwards, float x, float y, bool may_be_broad,
                      float reach_px[2]);

#endif
