#include "synthesis/structure/dash_rows.h"

#include <math.h>

#include "base/cholesky.h"
#include "base/memory.h"
#include "base/spread.h"
#include "synthesis/structure/dash_lone.h"

/* Dashes lie where they are due within this part of the period, less strictly while the ground is
 * not known; far away, so many px of the level and at the most this part. */
#define OFF_PERIOD .1
#define OFF_WHILE_DRIFTING .16
#define OFF_PLACE_PX 1.5
#define MOST_OFF_PERIOD .3
#define SHORTEST_PERIOD 1.25 /* of a dash */
#define LONGEST_PERIOD 12.
/* A row is told by so many dashes, and for each that is missing where it could be seen there must
 * be so many more. One beside such a row, with its dashes and period, by a single one. */
#define LEAST_DASHES 3
#define DASHES_PER_MISSING 4
/* So many of a row tell where their line vanishes; corrected is to so much of w at the hole's ends,
 * in so many rounds. */
#define LEAST_DRIFTING 4
#define MOST_CORRECTION .25
#define CORRECTIONS 3
#define FARTHEST 64 /* dashes that are looked for to each side */

typedef struct finder {
  const rc_mask *flags;
  rc_dash_sight sight;
  bool drifts;  /* the ground is not known yet */
  double reach; /* half of the hole's longer side, px of the finest level */
} finder;

static bool lies_on(const rc_dash_row *row, const rc_dash *d) {
  return rc_dash_lies_on(row, d->u, d->v, d->w);
}

/* Whether it is wholly seen where the row's n-th is due. */
static bool is_one_of(const finder *f, const rc_dash_row *row, const rc_dash *d, int *n) {
  double t = rc_dash_along(row, d->u, d->v), x, y, due_x, due_y, w;
  if (!d->complete || !rc_dash_is_like(row, d) || !lies_on(row, d)) return false;
  *n = rc_dash_number(row, t);
  double due = rc_dash_place(row, *n), period = fabs(rc_dash_place(row, *n + 1) - due);
  if (!isfinite(due)) return false;
  if (fabs(t - due) <= (f->drifts ? OFF_WHILE_DRIFTING : OFF_PERIOD) * period) return true;
  return fabs(t - due) <= MOST_OFF_PERIOD * period &&
         rc_ground_px(&f->sight.ground, f->sight.exponent, d->u, d->v, &x, &y, &w) &&
         rc_dash_px(&f->sight.ground, f->sight.exponent, row, due, 0, &due_x, &due_y, &w) &&
         rc_distance(x - due_x, y - due_y) <= OFF_PLACE_PX;
}

static void gather(const finder *f, rc_dash_row *row) {
  row->seen_count = 0;
  for (int i = 0, n; i < f->sight.dashes.count && row->seen_count < RC_MOST_IN_ROW; i++) {
    if (!is_one_of(f, row, &f->sight.dashes.found[i], &n)) continue;
    bool again = false;
    for (int k = 0; k < row->seen_count; k++) again |= row->seen[k] == n;
    if (!again) row->seen[row->seen_count++] = n;
  }
}

/* How far the row goes. False: too many of its dashes are missing, or something lies between. */
static bool find_ends(const finder *f, rc_dash_row *row) {
  int first = row->seen_count ? row->seen[0] : 0, last = first, missing = 0;
  for (int i = 1; i < row->seen_count; i++) {
    first = row->seen[i] < first ? row->seen[i] : first;
    last = row->seen[i] > last ? row->seen[i] : last;
  }
  for (int n = first + 1; n < last; n++) missing += rc_dash_is_missing(&f->sight, row, n);
  if (DASHES_PER_MISSING * missing > row->seen_count) return false;
  if (!rc_dash_row_is_plain(&f->sight, row, first, last)) return false;
  row->low = first - FARTHEST, row->high = last + FARTHEST;
  row->ends[0] = row->ends[1] = false;
  /* Where it is seen to have ended, between here and there none is sure. */
  for (int n = 1; n <= FARTHEST; n++) {
    if (!row->ends[0] && rc_dash_is_missing(&f->sight, row, first - n))
      row->ends[0] = true, row->low = first;
    if (!row->ends[1] && rc_dash_is_missing(&f->sight, row, last + n))
      row->ends[1] = true, row->high = last;
  }
  return true;
}

/* The line that its dashes lie on, a px of the picture being worth the same everywhere. */
static void fit_line(const finder *f, rc_dash_row *row) {
  double weight = 0, mu = 0, mv = 0, uu = 0, uv = 0, vv = 0;
  for (int pass = 0, n; pass < 2; pass++)
    for (int i = 0; i < f->sight.dashes.count; i++) {
      const rc_dash *d = &f->sight.dashes.found[i];
      if (!is_one_of(f, row, d, &n)) continue;
      double q = d->w * d->w, du = d->u - mu, dv = d->v - mv;
      if (pass)
        uu += q * du * du, uv += q * du * dv, vv += q * dv * dv;
      else
        weight += q, mu += q * du / weight, mv += q * dv / weight;
    }
  rc_spread spread;
  if (!rc_spread_of(uu, uv, vv, &spread)) return;
  double sign = spread.x * row->a + spread.y * row->b < 0 ? -1 : 1;
  double shift = rc_dash_along(row, mu, mv); /* the new point's place along the old line */
  row->first -= shift, row->period -= shift * row->drift;
  row->u = mu, row->v = mv, row->a = sign * spread.x, row->b = sign * spread.y;
}

/* And where they are due along it: of the n-th of places t, t (1 + n drift) = first + n period. */
static void fit_places(const finder *f, rc_dash_row *row) {
  int unknown = f->drifts && row->seen_count >= LEAST_DRIFTING ? 3 : 2;
  double m[9] = {0}, v[3] = {0}, scale = row->period;
  for (int i = 0, n; i < f->sight.dashes.count; i++) {
    const rc_dash *d = &f->sight.dashes.found[i];
    if (!is_one_of(f, row, d, &n)) continue;
    double t = rc_dash_along(row, d->u, d->v) / scale, weight = d->w * d->w * d->w * d->w;
    double terms[3] = {1, n, -n * t};
    for (int k = 0; k < unknown; k++) {
      for (int j = 0; j < unknown; j++) m[k * unknown + j] += weight * terms[k] * terms[j];
      v[k] += weight * terms[k] * t;
    }
  }
  if (!rc_factor(unknown, m)) return;
  rc_substitute(unknown, m, v);
  row->first = v[0] * scale, row->period = v[1] * scale, row->drift = v[2];
}

/* Takes in what it comes to explain. */
static void grow(const finder *f, rc_dash_row *row) {
  int before;
  gather(f, row);
  do {
    before = row->seen_count;
    rc_dash_row old = *row;
    fit_places(f, row);
    fit_line(f, row);
    gather(f, row);
    if (row->seen_count < before) *row = old;
  } while (row->seen_count > before);
}

static rc_dash_row row_between(const rc_dash *p, const rc_dash *q) {
  double du = q->u - p->u, dv = q->v - p->v, period = sqrt(du * du + dv * dv);
  return (rc_dash_row){.u = p->u,
                       .v = p->v,
                       .a = du / period,
                       .b = dv / period,
                       .period = period,
                       .length = (p->length + q->length) / 2,
                       .width = fmax(p->width, q->width),
                       .contrast = fmin(p->contrast, q->contrast)};
}

static bool is_taken(const rc_dash_rows *rows, const rc_dash *d) {
  for (int i = 0; i < rows->count; i++)
    if (lies_on(&rows->rows[i], d)) return true;
  return false;
}

/* The row of most dashes among those that lie in none yet. */
static recede_status find_longest(rc_context *context, const finder *f, const rc_dash_rows *rows,
                                  rc_dash_row *best) {
  best->seen_count = LEAST_DASHES - 1;
  for (int i = 0; i < f->sight.dashes.count; i++) {
    RC_TRY(rc_poll(context));
    for (int k = i + 1; k < f->sight.dashes.count; k++) {
      const rc_dash *p = &f->sight.dashes.found[i], *q = &f->sight.dashes.found[k];
      if (!p->complete || !q->complete || is_taken(rows, p) || is_taken(rows, q)) continue;
      rc_dash_row row = row_between(p, q);
      if (!rc_dash_is_like(&row, p) || !rc_dash_is_like(&row, q) ||
          row.period < SHORTEST_PERIOD * row.length || row.period > LONGEST_PERIOD * row.length)
        continue;
      grow(f, &row);
      if (row.seen_count > best->seen_count && find_ends(f, &row)) *best = row;
    }
  }
  return RECEDE_OK;
}

/* Where its middle lies, or that of the one of which it is the rest. False: it is unlike the row's.
 */
static bool middle_of(const rc_dash_row *row, const rc_dash *d, double *u, double *v) {
  rc_dash_rest rest;
  *u = d->u, *v = d->v;
  if (d->complete) return rc_dash_is_like(row, d);
  if (!rc_dash_rest_of(row, d, &rest)) return false;
  rc_dash_rest_middle(row, &rest, u, v);
  return true;
}

/* Turns a row to where the rest of its only dash runs. */
static void follow_rest(const finder *f, const rc_dash *d, rc_dash_row *row) {
  rc_dash_rest rest;
  rc_dash_row own;
  if (!rc_dash_rest_of(row, d, &rest) ||
      !rc_dash_alone(&f->sight.dashes, &f->sight.ground, f->flags, f->sight.exponent, row,
                     row->length, &rest, rc_dash_next(&f->sight.dashes, row, &rest), &own))
    return;
  row->u = own.u, row->v = own.v;
  row->a = own.a * rest.towards, row->b = own.b * rest.towards;
}

/* Beside a row that is told, with one dash that is seen or more, or the rest of one. */
static void find_beside(const finder *f, rc_dash_rows *rows) {
  int told = rows->count;
  for (int i = 0; i < told; i++)
    for (int k = 0; k < f->sight.dashes.count && rows->count < RC_MOST_DASH_ROWS; k++) {
      const rc_dash *d = &f->sight.dashes.found[k];
      rc_dash_row row = rows->rows[i];
      if (is_taken(rows, d) || !middle_of(&row, d, &row.u, &row.v)) continue;
      row.first = 0;
      gather(f, &row);
      if (!row.seen_count) follow_rest(f, d, &row);
      if (find_ends(f, &row)) rows->rows[rows->count++] = row;
    }
}

/* Dashes that come again tell where their line vanishes better than the horizon that was given:
 * turns the ground until they do not drift. False: it stays. */
static bool correct(const finder *f, const rc_dash_row *row, rc_ground *ground) {
  double from = row->u * row->a + row->v * row->b;
  double by = -row->drift / (row->period + row->drift * from);
  if (row->drift == 0 || !(fabs(by) * f->reach < MOST_CORRECTION)) return false;
  *ground = rc_ground_turned(ground, by, row->a, row->b);
  return true;
}

static recede_status find_rows(rc_context *context, const finder *f, rc_dash_rows *rows) {
  rows->ground = f->sight.ground;
  for (rows->count = 0; rows->count < RC_MOST_DASH_ROWS; rows->count++) {
    rc_dash_row *next = &rows->rows[rows->count];
    RC_TRY(find_longest(context, f, rows, next));
    if (next->seen_count < LEAST_DASHES) break;
  }
  return RECEDE_OK;
}

static int seen_in(const rc_dash_rows *rows) {
  int sum = 0;
  for (int i = 0; i < rows->count; i++) sum += rows->rows[i].seen_count;
  return sum;
}

/* The horizon may be higher or lower than was said: where it is, more dashes lie in rows. The
 * finder's are those of what was said. */
static recede_status try_horizons(rc_context *context, finder *f, rc_dash_rows *rows, bool *any) {
  static const double farther[] = {0, -.05, .05, -.1, .1, -.15, .15};
  int most = 0;
  const rc_ground said = f->sight.ground;
  const rc_dashes seen = f->sight.dashes;
  rc_ground best = said;
  for (size_t i = 0; i < sizeof farther / sizeof *farther; i++) {
    f->sight.ground = rc_ground_tilted(&said, 1 + farther[i]);
    rc_dashes_move(&seen, &said, &f->sight.ground, &f->sight.dashes);
    RC_TRY(find_rows(context, f, rows));
    if (seen_in(rows) > most) most = seen_in(rows), best = f->sight.ground;
  }
  f->sight.ground = best;
  *any = most > 0;
  if (!*any) rows->count = 0;
  return RECEDE_OK;
}

recede_status rc_dash_rows_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                                const rc_ground *ground, int exponent, rc_dash_rows *rows) {
  finder f = {.flags = flags, .sight = {.ground = *ground, .exponent = exponent}, .drifts = true};
  f.reach = (double)(rc_longer_side(rc_box_of(flags, RC_TARGET)) << exponent) / 2;
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_dashes_find(context, image, flags, ground, exponent, &f.sight.dashes));
  const rc_dashes said = f.sight.dashes;
  bool any = false, again;
  RC_TRY(try_horizons(context, &f, rows, &any));
  again = any;
  for (int i = 0; i <= CORRECTIONS && any; i++) {
    f.drifts = i < CORRECTIONS;
    rc_release(context, mark);
    RC_TRY(rc_dashes_find(context, image, flags, &f.sight.ground, exponent, &f.sight.dashes));
    RC_TRY(find_rows(context, &f, rows));
    any = rows->count > 0;
    if (f.drifts && any && !correct(&f, rows->rows, &f.sight.ground)) i = CORRECTIONS - 1;
  }
  if (!any) { /* the ground that was said stands */
    f.sight.ground = rows->ground = *ground;
    f.sight.dashes = said;
    if (again) rc_release(context, mark);
    if (again) RC_TRY(rc_dashes_find(context, image, flags, ground, exponent, &f.sight.dashes));
  }
  find_beside(&f, rows);
  RC_TRY(rc_dash_rows_choose(context, &f.sight.dashes, flags, exponent, rows));
  rows->told = rows->count;
  RC_TRY(rc_dash_rows_add_lone(context, &f.sight, flags, rows));
  rc_release(context, mark);
  return rc_poll(context);
}
