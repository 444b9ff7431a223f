/* The lattice of a texture that repeats in two directions: bricks, tiles, roofs. Laid by hand it
 * bends, and a horizon is seldom known exactly; so where a place is in it is told by two phases
 * that the known texture shows. Copies that keep them keep rows and joints where they belong. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_LATTICE_H
#define RECEDE_SYNTHESIS_STRUCTURE_LATTICE_H

#include "synthesis/copy.h"

/* How it bends is told at so many points, one period apart, to each side of the hole's middle. */
#define RC_BENDS_HALF 24
#define RC_BENDS (2 * RC_BENDS_HALF + 1)

typedef struct rc_bends {
  float cycles[RC_BENDS][RC_BENDS][2]; /* by which the phases differ from even ones, row by row */
} rc_bends;

typedef struct rc_lattice {
  rc_copy p, q;          /* two periods, px where w = 1; 0, 0: there is no lattice */
  float spacing;         /* of the points that tell how it bends, px where w = 1 */
  const rc_bends *bends; /* beyond them it bends as at their end */
} rc_lattice;

static inline bool rc_has_lattice(const rc_lattice *lattice) {
  return lattice->p.a != 0.f || lattice->p.b != 0.f;
}

/* The same lattice in the px of a level so many times finer. */
static inline rc_lattice rc_lattice_finer(rc_lattice lattice, float times) {
  lattice.p.a *= times, lattice.p.b *= times;
  lattice.q.a *= times, lattice.q.b *= times;
  lattice.spacing *= times;
  return lattice;
}

/* Periods from the origin to (a, b), px where w = 1: of an even lattice, and as it bends. */
void rc_lattice_even_phases(const rc_lattice *lattice, float a, float b, float phases[2]);
void rc_lattice_phases(const rc_lattice *lattice, float a, float b, float phases[2]);

/* The copy that takes target (x, y) from where in the lattice it is itself, near (to_x, to_y). */
rc_copy rc_copy_on_lattice(const rc_lattice *lattice, const rc_chart *chart, float x, float y,
                           float to_x, float to_y);

/* What a copy costs that is off by more than laying by hand, in units of the texture's variance.
 * phases: the target's; (x, y): the source, relative to the chart's origin. */
float rc_lattice_price(const rc_lattice *lattice, const rc_chart *chart, const float phases[2],
                       float x, float y);

#endif
