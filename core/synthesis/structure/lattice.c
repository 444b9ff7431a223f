#include "synthesis/structure/lattice.h"

#include "base/real.h"
#include "synthesis/structure/rails.h"

/* Two copies may be off by twice that to each other, a joint's width: by .12 drawn tiles that bend
 * have double joints, by .08 some. */
#define TOLERANCE .04f
/* In units of the texture's variance, per square of the cycles by which a copy is off by more: a
 * copy whose tiles lean in another way is followed until it is. By 6 rows break, 96 is as 24. */
#define PRICE 24.f

void rc_lattice_even_phases(const rc_lattice *l, float a, float b, float phases[2]) {
  float area = l->p.a * l->q.b - l->p.b * l->q.a;
  phases[0] = (a * l->q.b - b * l->q.a) / area;
  phases[1] = (l->p.a * b - l->p.b * a) / area;
}

static float bend_column(float px, float spacing, int *column) {
  float at = fminf(fmaxf(px / spacing + RC_BENDS_HALF, 0.f), (float)(RC_BENDS - 1));
  *column = (int)fminf(at, (float)(RC_BENDS - 2));
  return at - (float)*column;
}

void rc_lattice_phases(const rc_lattice *lattice, float a, float b, float phases[2]) {
  int x, y;
  float s = bend_column(a, lattice->spacing, &x), t = bend_column(b, lattice->spacing, &y);
  const float(*above)[2] = &lattice->bends->cycles[y][x];
  const float(*below)[2] = &lattice->bends->cycles[y + 1][x];
  rc_lattice_even_phases(lattice, a, b, phases);
  for (int i = 0; i < 2; i++) {
    float upper = above[0][i] + s * (above[1][i] - above[0][i]);
    float lower = below[0][i] + s * (below[1][i] - below[0][i]);
    phases[i] += upper + t * (lower - upper);
  }
}

/* Cycles from one place's phases to another's but for whole ones. */
static void off_lattice(const float from[2], const float to[2], float off[2]) {
  for (int i = 0; i < 2; i++) off[i] = to[i] - from[i] - rc_round(to[i] - from[i]);
}

rc_copy rc_copy_on_lattice(const rc_lattice *lattice, const rc_chart *chart, float x, float y,
                           float to_x, float to_y) {
  rc_chart flat = rc_chart_flat(*chart);
  float w = 1.f + chart->lx * x + chart->ly * y, here[2], there[2], off[2];
  rc_copy move = rc_copy_between(&flat, x, y, to_x, to_y);
  rc_lattice_phases(lattice, x / w, y / w, here);
  rc_lattice_phases(lattice, x / w + move.a, y / w + move.b, there);
  off_lattice(here, there, off);
  return rc_copy_of_move(chart, x, y, move.a - off[0] * lattice->p.a - off[1] * lattice->q.a,
                         move.b - off[0] * lattice->p.b - off[1] * lattice->q.b);
}

float rc_lattice_price(const rc_lattice *lattice, const rc_chart *chart, const float phases[2],
                       float x, float y) {
  float w = 1.f + chart->lx * x + chart->ly * y, there[2], off[2], sum = 0;
  rc_lattice_phases(lattice, x / w, y / w, there);
  off_lattice(phases, there, off);
  for (int i = 0; i < 2; i++) {
    float too_far = fmaxf(fabsf(off[i]) - TOLERANCE, 0.f);
    sum += too_far * too_far;
  }
  return PRICE * sum;
}
