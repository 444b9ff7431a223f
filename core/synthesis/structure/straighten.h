/* The direction of a line that is seen at one end only. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_STRAIGHTEN_H
#define RECEDE_SYNTHESIS_STRUCTURE_STRAIGHTEN_H

#include "synthesis/structure/crossing.h"
#include "synthesis/structure/profile.h"

/* Turns a line around b until it lies where what looks like own, its profile there, does beyond b;
 * ruler: along the line, and turned with it. */
void rc_straighten(rc_ruler *ruler, const rc_profile *own, rc_crossing *line);

#endif
