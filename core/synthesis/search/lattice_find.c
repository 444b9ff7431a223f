#include "synthesis/search/lattice_find.h"

#include <math.h>
#include <string.h>

#include "base/cholesky.h"
#include "base/memory.h"
#include "base/random.h"
#include "base/real.h"

/* Periods are looked for among so many, strongest first, each with its opposite. They must be so
 * long, px, or nothing tells them from the texture's grain, and span at least so much: sine of the
 * angle between them. */
#define STRONGEST 16
#define LEAST_PERIOD_PX 4.f
#define LEAST_SINE .5f
/* Phases are measured in cells of the plane one period apart, by all that lies within two cells,
 * weighted by a Gaussian of this many periods. */
#define SIGMA .8f
#define WITHIN 2
#define GRID RC_BENDS
#define HALF_GRID RC_BENDS_HALF
/* Cells that see less than this part of the pixels that the fullest does tell nothing. */
#define LEAST_FULL .3
/* About so many pixels are looked at, of scales near the hole's. */
#define MOST_PIXELS 100000
#define PIXELS_KEY 97
#define WIDEST_RATIO 2.5f
/* A cubic, without its constant, tells the trend of the bends. It costs so much of what the cells
 * say: where none are, lattices are even. */
#define TERMS 9
#define RIDGE .01
/* What cells show beyond the trend is kept, too, for a cubic follows no waves: they differ by what
 * their phases do and, which counts so much of it, as little as they can. That leads the bends
 * through the hole. Successive over-relaxation; a hole is seldom 20 cells wide. */
#define SMOOTH .1
#define OVER 1.8
#define SWEEPS 100
/* There is a lattice where so many pairs of cells or more, so far apart that they share no pixels,
 * agree about it as well as this, 1 being wholly: bricks and tiles .75 to 1, an old roof .66 to
 * .86; pebbles, waves, carpets and planks up to .6, and more only where there are few pairs. */
#define APART 4
#define LEAST_PAIRS 80
#define LEAST_AGREEING .65
/* And where beside the hole it shows as clearly as this part of what it does elsewhere: tiles
 * around a chimney .70 to .76, elsewhere .84 and more. */
#define LEAST_CLEAR .8
/* So many pairs of periods are tried. */
#define MOST_LATTICES 4

typedef struct cell {
  double pixels, value, phasor[2][2], bare[2][2];
  bool beside; /* in the hole or beside it */
} cell;

/* From a cell to the next: the cycles that a phase gains more than even ones and the trend. */
typedef struct link {
  double weight, cycles;
} link;

/* One pair of periods, and what the known pixels say of its phases. */
typedef struct survey {
  const rc_level *level;
  rc_lattice *lattice;
  double fullest;
  cell cells[GRID][GRID];
  double trend[2][TERMS];
  int x0, y0, x1, y1;        /* the cells that tell; beyond, the trend is as at their end */
  link links[2][GRID][GRID]; /* to the right and below */
  double off[GRID][GRID];    /* from the trend, cycles */
} survey;

/* cos and sin of so many turns, Taylor series on an eighth of one. */
static void turn(float turns, double phasor[2]) {
  double t = turns - rc_round(turns), quarter = rc_round((float)(4 * t));
  double v = (t - quarter / 4) * 6.283185307179586, s = v * v;
  double sine = v * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72))));
  double cosine = 1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56)));
  switch ((int)quarter & 3) {
    case 0: phasor[0] = cosine, phasor[1] = sine; break;
    case 1: phasor[0] = -sine, phasor[1] = cosine; break;
    case 2: phasor[0] = -cosine, phasor[1] = -sine; break;
    default: phasor[0] = sine, phasor[1] = -cosine;
  }
}

/* The angle of (c, s) in turns, -.5 .. .5. */
static double turns_of(double c, double s) {
  double x = fabs(c), y = fabs(s), z = y > x ? x / y : x > 0 ? y / x : 0, zz = z * z;
  double eighth = z * (.1591549 - zz * (.0530 - zz * (.0310 - zz * (.0181 - zz * .00566))));
  double turns = y > x ? .25 - eighth : eighth;
  if (c < 0) turns = .5 - turns;
  return s < 0 ? -turns : turns;
}

/* The unit of length is half of what the cells reach. */
static void terms_at(int x, int y, double terms[TERMS]) {
  double u = (x - HALF_GRID) / (.5 * HALF_GRID), v = (y - HALF_GRID) / (.5 * HALF_GRID);
  terms[0] = u, terms[1] = v;
  terms[2] = u * u, terms[3] = u * v, terms[4] = v * v;
  terms[5] = u * u * u, terms[6] = u * u * v, terms[7] = u * v * v, terms[8] = v * v * v;
}

static double trend_of(const survey *s, int i, const double terms[TERMS]) {
  double sum = 0;
  for (int n = 0; n < TERMS; n++) sum += s->trend[i][n] * terms[n];
  return sum;
}

/* The two that together are shortest, of those longer than *length, which becomes theirs. */
static bool next_periods(const rc_copy *periods, int count, float *length, rc_lattice *lattice) {
  float shortest = INFINITY;
  for (int i = 0; i < count && i < STRONGEST; i += 2)
    for (int j = 0; j < i; j += 2) {
      rc_copy p = periods[i], q = periods[j];
      float p_px = sqrtf(p.a * p.a + p.b * p.b), q_px = sqrtf(q.a * q.a + q.b * q.b);
      float area = fabsf(p.a * q.b - p.b * q.a), both = p_px + q_px;
      if (fminf(p_px, q_px) < LEAST_PERIOD_PX || area < LEAST_SINE * p_px * q_px) continue;
      if (both > *length && both < shortest) shortest = both, lattice->p = p, lattice->q = q;
    }
  *length = shortest;
  return shortest < INFINITY;
}

/* share: of the plane, in square px where w = 1. */
static void add_pixel(survey *s, float a, float b, double share, double value) {
  float phases[2], near[2][2 * WITHIN + 1];
  double phasor[2][2];
  int column = (int)rc_round(a / s->lattice->spacing), row = (int)rc_round(b / s->lattice->spacing);
  float unit = -.5f / (SIGMA * SIGMA);
  rc_lattice_even_phases(s->lattice, a, b, phases);
  for (int i = 0; i < 2; i++) turn(-phases[i], phasor[i]);
  for (int n = -WITHIN; n <= WITHIN; n++) {
    float across = a / s->lattice->spacing - (float)(column + n),
          along = b / s->lattice->spacing - (float)(row + n);
    near[0][n + WITHIN] = rc_exp(unit * across * across);
    near[1][n + WITHIN] = rc_exp(unit * along * along);
  }
  for (int j = -WITHIN; j <= WITHIN; j++)
    for (int i = -WITHIN; i <= WITHIN; i++) {
      int x = column + i + HALF_GRID, y = row + j + HALF_GRID;
      if (!rc_inside(GRID, GRID, x, y)) continue;
      double weight = share * near[0][i + WITHIN] * near[1][j + WITHIN];
      cell *c = &s->cells[y][x];
      c->pixels += weight, c->value += weight * value;
      for (int n = 0; n < 2; n++)
        for (int k = 0; k < 2; k++)
          c->bare[n][k] += weight * phasor[n][k], c->phasor[n][k] += weight * value * phasor[n][k];
    }
}

static void look_around(survey *s) {
  const rc_level *level = s->level;
  int pixels = level->width * level->height;
  uint64_t step = (uint64_t)pixels / MOST_PIXELS + 1;
  float edge = (HALF_GRID + WITHIN) * s->lattice->spacing;
  for (int i = 0; i < pixels; i++) {
    int column = i % level->width, row = i / level->width;
    if (!level->room[i]) continue;
    /* By chance: every n-th would have a lattice of its own. */
    if (rc_level_random(level, PIXELS_KEY, column, row, 0) % step) continue;
    float x = rc_level_x(level, column), y = rc_level_y(level, row), w = rc_level_w(level, x, y);
    if (!(w > 1 / WIDEST_RATIO && w < WIDEST_RATIO)) continue;
    if (fabsf(x / w) < edge && fabsf(y / w) < edge)
      add_pixel(s, x / w, y / w, 1 / (w * w * w), rc_level_trait(level, i));
  }
  for (int n = 0; n < GRID * GRID; n++) {
    cell *c = &s->cells[n / GRID][n % GRID];
    s->fullest = fmax(s->fullest, c->pixels);
    for (int i = 0; i < 2 && c->pixels > 0; i++)
      for (int k = 0; k < 2; k++) c->phasor[i][k] -= c->value / c->pixels * c->bare[i][k];
  }
}

static bool tells(const survey *s, int x, int y) {
  return s->cells[y][x].pixels >= LEAST_FULL * s->fullest;
}

/* What two cells say of phase i: from the first to the second it gains so many cycles more than
 * even ones. Weight 0: nothing. */
typedef struct pair {
  double weight, cycles, terms[TERMS]; /* and what the bends' terms gain */
} pair;

static pair pair_of(const survey *s, int i, int x, int y, int to_x, int to_y) {
  pair p = {.weight = 0};
  double there[TERMS];
  if (!rc_inside(GRID, GRID, to_x, to_y)) return p;
  const cell *c = &s->cells[y][x], *d = &s->cells[to_y][to_x];
  if (!tells(s, x, y) || !tells(s, to_x, to_y)) return p;
  double re = c->phasor[i][0] * d->phasor[i][0] + c->phasor[i][1] * d->phasor[i][1];
  double im = c->phasor[i][0] * d->phasor[i][1] - c->phasor[i][1] * d->phasor[i][0];
  p.weight = sqrt(re * re + im * im) / (c->pixels * d->pixels);
  p.cycles = turns_of(re, im);
  terms_at(x, y, p.terms);
  terms_at(to_x, to_y, there);
  for (int n = 0; n < TERMS; n++) p.terms[n] = there[n] - p.terms[n];
  return p;
}

/* How phase i bends, more exactly than so far: cells so far apart gain less than half a cycle more
 * or less than is known. */
static void fit(survey *s, int i, int apart) {
  double product[TERMS * TERMS] = {0}, value[TERMS] = {0}, most = 0;
  for (int n = 0; n < 2 * GRID * GRID; n++) {
    int x = n / 2 % GRID, y = n / 2 / GRID;
    pair p = pair_of(s, i, x, y, x + apart * (n % 2), y + apart * !(n % 2));
    double cycles = p.cycles - trend_of(s, i, p.terms);
    cycles -= rc_round((float)cycles);
    for (int j = 0; j < TERMS; j++) {
      value[j] += p.weight * p.terms[j] * cycles;
      for (int k = 0; k <= j; k++) product[j * TERMS + k] += p.weight * p.terms[j] * p.terms[k];
    }
  }
  for (int j = 0; j < TERMS; j++) most = fmax(most, product[j * TERMS + j]);
  for (int j = 0; j < TERMS; j++) product[j * TERMS + j] += RIDGE * most;
  if (!(most > 0) || !rc_factor(TERMS, product)) return;
  rc_substitute(TERMS, product, value);
  for (int j = 0; j < TERMS; j++) s->trend[i][j] += value[j];
}

/* How far cells agree about phase i, -1 .. 1; 0 where there are too few. */
static double agreeing(const survey *s, int i) {
  double agreed = 0, weight = 0, phasor[2];
  int pairs = 0;
  for (int n = 0; n < 2 * GRID * GRID; n++) {
    int x = n / 2 % GRID, y = n / 2 / GRID;
    pair p = pair_of(s, i, x, y, x + APART * (n % 2), y + APART * !(n % 2));
    turn((float)(p.cycles - trend_of(s, i, p.terms)), phasor);
    agreed += p.weight * phasor[0], weight += p.weight, pairs += p.weight > 0;
  }
  return pairs < LEAST_PAIRS ? 0 : agreed / weight;
}

static void find_ends(survey *s) {
  s->x0 = s->y0 = GRID - 1, s->x1 = s->y1 = 0;
  for (int y = 0; y < GRID; y++)
    for (int x = 0; x < GRID; x++) {
      if (!tells(s, x, y)) continue;
      s->x0 = x < s->x0 ? x : s->x0, s->x1 = x > s->x1 ? x : s->x1;
      s->y0 = y < s->y0 ? y : s->y0, s->y1 = y > s->y1 ? y : s->y1;
    }
}

static void make_links(survey *s, int i) {
  double sum = 0;
  int count = 0;
  for (int n = 0; n < 2 * GRID * GRID; n++) {
    int x = n / 2 % GRID, y = n / 2 / GRID, below = n % 2;
    pair p = pair_of(s, i, x, y, x + !below, y + below);
    double cycles = p.cycles - trend_of(s, i, p.terms);
    s->links[below][y][x] = (link){p.weight, cycles - rc_round((float)cycles)};
    sum += p.weight, count += p.weight > 0;
  }
  for (int n = 0; n < 2 * GRID * GRID; n++)
    s->links[n % 2][n / 2 / GRID][n / 2 % GRID].weight *= count / sum;
}

static void pull(const link *l, double other, double gain, double *value, double *weight) {
  *value += (l->weight + SMOOTH) * other + l->weight * gain;
  *weight += l->weight + SMOOTH;
}

/* How far phase i is off the trend, cell by cell. */
static void relax(survey *s, int i) {
  make_links(s, i);
  memset(s->off, 0, sizeof s->off);
  for (int n = 0; n < SWEEPS * GRID * GRID; n++) {
    int x = n % GRID, y = n / GRID % GRID;
    double value = 0, weight = 0, (*off)[GRID] = s->off;
    const link(*right)[GRID] = s->links[0], (*below)[GRID] = s->links[1];
    if (x > 0) pull(&right[y][x - 1], off[y][x - 1], right[y][x - 1].cycles, &value, &weight);
    if (y > 0) pull(&below[y - 1][x], off[y - 1][x], below[y - 1][x].cycles, &value, &weight);
    if (x < GRID - 1) pull(&right[y][x], off[y][x + 1], -right[y][x].cycles, &value, &weight);
    if (y < GRID - 1) pull(&below[y][x], off[y + 1][x], -below[y][x].cycles, &value, &weight);
    off[y][x] += OVER * (value / weight - off[y][x]);
  }
}

static int within(int value, int least, int most) {
  return value < least ? least : value > most ? most : value;
}

static void tell_bends(survey *s, rc_bends *bends) {
  double terms[TERMS];
  for (int i = 0; i < 2; i++) {
    relax(s, i);
    for (int y = 0; y < GRID; y++)
      for (int x = 0; x < GRID; x++) {
        terms_at(within(x, s->x0, s->x1), within(y, s->y0, s->y1), terms);
        bends->cycles[y][x][i] = (float)(trend_of(s, i, terms) + s->off[y][x]);
      }
  }
}

/* The amplitude of phase i's wave. */
static double clearness(const cell *c, int i) {
  return sqrt(c->phasor[i][0] * c->phasor[i][0] + c->phasor[i][1] * c->phasor[i][1]) / c->pixels;
}

static void mark_hole(survey *s) {
  const rc_level *level = s->level;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      float px = rc_level_x(level, x), py = rc_level_y(level, y), w = rc_level_w(level, px, py);
      if (!rc_level_is_target(level, x, y) || !(w > 1 / WIDEST_RATIO)) continue;
      int column = (int)rc_round(px / w / s->lattice->spacing) + HALF_GRID;
      int row = (int)rc_round(py / w / s->lattice->spacing) + HALF_GRID;
      for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
          if (rc_inside(GRID, GRID, column + i, row + j))
            s->cells[row + j][column + i].beside = true;
    }
}

/* How clearly cells beside the hole show phase i, in units of what all do. */
static double clear_beside(const survey *s, int i) {
  double beside = 0, all = 0, beside_count = 0, count = 0;
  for (int n = 0; n < GRID * GRID; n++) {
    const cell *c = &s->cells[n / GRID][n % GRID];
    if (!tells(s, n % GRID, n / GRID)) continue;
    all += clearness(c, i), count++;
    if (c->beside) beside += clearness(c, i), beside_count++;
  }
  return beside_count > 0 ? beside / beside_count * count / all : 0;
}

/* Of all periods that span the same lattice the shortest show most: takes from the longer one what
 * it has of the other. */
static void reduce(rc_lattice *lattice) {
  for (int n = 0; n < 4; n++) {
    rc_copy *p = &lattice->p, *q = &lattice->q;
    if (p->a * p->a + p->b * p->b > q->a * q->a + q->b * q->b) p = &lattice->q, q = &lattice->p;
    float times = rc_round((p->a * q->a + p->b * q->b) / (p->a * p->a + p->b * p->b));
    q->a -= times * p->a, q->b -= times * p->b;
  }
}

/* How it bends, its periods being chosen; and how far the known texture agrees. */
static double look_for(survey *s, rc_lattice *lattice) {
  double least = 1, clear = 1;
  float p_px = sqrtf(lattice->p.a * lattice->p.a + lattice->p.b * lattice->p.b);
  float q_px = sqrtf(lattice->q.a * lattice->q.a + lattice->q.b * lattice->q.b);
  memset(s->cells, 0, sizeof s->cells);
  memset(s->trend, 0, sizeof s->trend);
  s->lattice = lattice, lattice->spacing = fmaxf(p_px, q_px), s->fullest = 0;
  look_around(s);
  find_ends(s);
  mark_hole(s);
  for (int i = 0; i < 2; i++) {
    for (int apart = 1; apart <= APART; apart *= 2) fit(s, i, apart);
    least = fmin(least, agreeing(s, i)), clear = fmin(clear, clear_beside(s, i));
  }
  return clear < LEAST_CLEAR ? 0 : least;
}

recede_status rc_lattice_find(rc_context *context, const rc_level *level, const rc_copy *periods,
                              int period_count, rc_bends *bends, rc_lattice *lattice) {
  survey *s;
  float length = 0;
  double most = LEAST_AGREEING;
  *lattice = (rc_lattice){.spacing = 1};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &s));
  s->level = level;
  for (int n = 0; n < MOST_LATTICES; n++) {
    rc_lattice tried = {.bends = bends};
    if (!next_periods(periods, period_count, &length, &tried)) break;
    reduce(&tried);
    double agreed = look_for(s, &tried);
    if (agreed > most) {
      most = agreed, *lattice = tried;
      tell_bends(s, bends);
    }
    RC_TRY(rc_poll(context));
  }
  rc_release(context, mark);
  return rc_poll(context);
}
