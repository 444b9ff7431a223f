/* The lattice of a texture that repeats in two directions: bricks, tiles, roofs. Laid by hand it
 * bends, and a horizon is seldom known exactly; so where a place is in it is told by two phases
 * that the known texture shows. Copies that keep them keep rows and joints where they belong. */
#ifndef RECEDE_SYNTHESIS_LATTICE_H
#define RECEDE_SYNTHESIS_LATTICE_H

#include "synthesis/level.h"

/* Terms of a cubic without its constant. */
#define RC_BENDS 9

typedef struct rc_lattice {
  rc_copy p, q;         /* two periods, px where w = 1; 0, 0: there is no lattice */
  float reach;          /* in the terms of the bends the unit of length, px where w = 1 */
  float a0, b0, a1, b1; /* the part of the plane that tells of bends, px where w = 1; beyond it they
                           are as at its end */
  float bend[2][RC_BENDS]; /* cycles by which the phases along p and q differ from even ones */
} rc_lattice;

static inline bool rc_has_lattice(const rc_lattice *lattice) {
  return lattice->p.a != 0.f || lattice->p.b != 0.f;
}

/* The same lattice in the px of a level so many times finer. */
static inline rc_lattice rc_lattice_finer(rc_lattice lattice, float times) {
  lattice.p.a *= times, lattice.p.b *= times;
  lattice.q.a *= times, lattice.q.b *= times;
  lattice.reach *= times;
  lattice.a0 *= times, lattice.b0 *= times, lattice.a1 *= times, lattice.b1 *= times;
  return lattice;
}

/* From the periods, as rc_find_periods tells them, and the known pixels of this, the coarsest
 * level. */
recede_status rc_lattice_find(rc_context *context, const rc_level *level, const rc_copy *periods,
                              int period_count, rc_lattice *lattice);

/* The copy that takes target (x, y) from (to_x, to_y) or, where that is elsewhere in the lattice by
 * more than the tolerance, in cycles, from the nearest point that is not. */
rc_copy rc_copy_on_lattice(const rc_lattice *lattice, const rc_chart *chart, float tolerance,
                           float x, float y, float to_x, float to_y);

#endif
