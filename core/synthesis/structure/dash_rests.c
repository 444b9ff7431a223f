#include <math.h>

#include "synthesis/structure/dash_row.h"

/* A dash that the hole cuts, and of which there is no like one near enough, is made whole of what
 * is left of it. */

/* The rest of a dash that the hole or the picture's end cuts off is not wider than so many times
 * the row's dashes, and they, blurred where they are far, not than it; of the whole one's length
 * it has at least so much, and is cut away from its middle by so much of its own. */
#define MOST_WIDER 1.6
#define MOST_NARROWER 6.
#define LEAST_REST .15
#define LEAST_TO_CUT .25
/* It is due within this part of the period. */
#define OFF_PERIOD .16
/* At least this part of the whole is copied. Places that are looked at. */
#define LEAST_COPIED .1
#define STEPS 64
/* A rest may turn from its row by so much: 8 degrees. */
#define MOST_TURN .14

bool rc_dash_rest_of(const rc_dash_row *row, const rc_dash *d, rc_dash_rest *rest) {
  double a = row->a, b = row->b;
  double length = sqrt(12 * fmax(a * a * d->uu + 2 * a * b * d->uv + b * b * d->vv, 0));
  double width = sqrt(12 * fmax(b * b * d->uu - 2 * a * b * d->uv + a * a * d->vv, 0));
  if (d->complete || width > MOST_WIDER * row->width || row->width > MOST_NARROWER * width ||
      length > RC_DASHES_MOST_LONGER * row->length || length < LEAST_REST * row->length)
    return false;
  double to_cut = (d->cut_u - d->u) * a + (d->cut_v - d->v) * b;
  if (fabs(to_cut) < LEAST_TO_CUT * length) return false; /* it is cut lengthwise */
  *rest = (rc_dash_rest){d->u, d->v, length, width, to_cut > 0 ? 1 : -1};
  return true;
}

/* So far along the row from a rest's middle lies that of the whole dash. */
static double to_middle(const rc_dash_row *row, const rc_dash_rest *rest) {
  return rest->towards * fmax(row->length - rest->length, 0) / 2;
}

void rc_dash_rest_middle(const rc_dash_row *row, const rc_dash_rest *rest, double *u, double *v) {
  *u = rest->u + to_middle(row, rest) * row->a, *v = rest->v + to_middle(row, rest) * row->b;
}

/* Whether the whole one would be the row's n-th. */
static bool is_of(const rc_dash_row *row, int n, const rc_dash *d, rc_dash_rest *rest) {
  double due = rc_dash_place(row, n);
  if (!rc_dash_rest_of(row, d, rest) || !rc_dash_lies_on(row, d->u, d->v, d->w)) return false;
  double t = rc_dash_along(row, d->u, d->v) + to_middle(row, rest);
  return fabs(t - due) < OFF_PERIOD * fabs(rc_dash_place(row, n + 1) - due);
}

static bool is_seen_in(const rc_dash_row *row, const rc_dash *d) {
  return d->complete && rc_dash_is_like(row, d) && rc_dash_lies_on(row, d->u, d->v, d->w);
}

const rc_dash *rc_dash_next(const rc_dashes *dashes, const rc_dash_row *row,
                            const rc_dash_rest *rest) {
  const rc_dash *next = NULL;
  double least = INFINITY, t = rc_dash_along(row, rest->u, rest->v);
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *d = &dashes->found[i];
    double off = fabs(rc_dash_along(row, d->u, d->v) - t);
    if (is_seen_in(row, d) && off > row->length && off < least) least = off, next = d;
  }
  return next;
}

/* The length of the nearest to the viewer of the rows' dashes: far ones get longer by their blur.
 */
static double length_of_nearest(const rc_dashes *dashes, const rc_dash_rows *rows,
                                const rc_dash_row *row) {
  double most = 0, length = row->length;
  for (int i = 0; i < rows->count; i++)
    for (int k = 0; k < dashes->count; k++) {
      const rc_dash *d = &dashes->found[k];
      if (d->w > most && is_seen_in(&rows->rows[i], d) &&
          rc_dashes_alike(row, d->length, d->a, d->b))
        most = d->w, length = d->length;
    }
  return length;
}

/* The two rests of a row's n-th: cut nearer along the row, and farther. Their lengths are 0 where
 * there is none. */
static void find_rests(const rc_dashes *dashes, const rc_dash_row *row, int n,
                       rc_dash_rest rests[2]) {
  rests[0].length = rests[1].length = 0;
  for (int i = 0; i < dashes->count; i++) {
    rc_dash_rest rest;
    if (is_of(row, n, &dashes->found[i], &rest) && rest.length > rests[rest.towards > 0].length)
      rests[rest.towards > 0] = rest;
  }
}

/* A row of a dash alone, so long, from the end that is seen, at -length / 2, to where it is due.
 * Its line runs through the rest and the next dash, if there is one: the row's may pass by half the
 * width of what is near. */
static rc_dash_row row_of(const rc_dash_row *row, double length, const rc_dash_rest *rest,
                          const rc_dash *next) {
  rc_dash_row own = *row;
  if (next) {
    double du = next->u - rest->u, dv = next->v - rest->v, far = rc_distance(du, dv);
    double sign = du * row->a + dv * row->b < 0 ? -1 : 1;
    own.a = sign * du / far, own.b = sign * dv / far;
  }
  own.length = length, own.width = rest->width;
  own.a *= rest->towards, own.b *= rest->towards;
  double on = fabs(to_middle(&own, rest));
  own.u = rest->u + on * own.a, own.v = rest->v + on * own.b;
  own.first = 0;
  own.low = own.high = 0, own.seen_count = own.laid_count = 0;
  return own;
}

/* Whether a pixel of the level at a place along a row and off it, and those around it, may be
 * copied. */
static bool may_be_copied(const rc_ground *ground, const rc_mask *flags, int exponent,
                          const rc_dash_row *row, double along, double side) {
  double x, y, w;
  if (!rc_dash_px(ground, exponent, row, along, side, &x, &y, &w)) return false;
  int at_x = (int)floor(x + .5), at_y = (int)floor(y + .5);
  for (int px_y = at_y - 1; px_y <= at_y + 1; px_y++)
    for (int px_x = at_x - 1; px_x <= at_x + 1; px_x++)
      if (!rc_inside(flags->width, flags->height, px_x, px_y) ||
          (*rc_flag(flags, px_x, px_y) & (RC_TARGET | RC_ALLOWED)) != RC_ALLOWED)
        return false;
  return true;
}

/* How much of a rest, from the end that is seen, may be copied with what lies beside it; 0 if not
 * what lies beyond the end, or if it would be magnified too much. */
static double length_to_copy(const rc_ground *ground, const rc_mask *flags, int exponent,
                             const rc_dash_row *own, double length) {
  double end = .5 * own->length, from = -.5 * RC_DASH_TIMES_LAID * own->length, x, y, here, due;
  double to = length - end, step = (to - from) / STEPS;
  if (!rc_dash_px(ground, exponent, own, -end, 0, &x, &y, &here) ||
      !rc_dash_px(ground, exponent, own, end, 0, &x, &y, &due) ||
      here * RC_DASHES_MOST_COARSE < due)
    return 0;
  for (double t = from; t < to; t += step)
    for (int side = -1; side <= 1; side++)
      if (!may_be_copied(ground, flags, exponent, own, t,
                         .5 * side * RC_DASH_TIMES_LAID * own->width))
        return fmax(t - step + end, 0);
  return length;
}

/* Turns a row of a dash alone to where the part of it runs that may be copied: the middle across,
 * at places along that. A rest's moments lean with the hole's border. */
static void straighten(const rc_dashes *dashes, const rc_ground *ground, int exponent,
                       double length, rc_dash_row *own) {
  double weight = 0, mt = 0, ms = 0, tt = 0, ts = 0, end = .5 * own->length;
  for (int pass = 0; pass < 2; pass++)
    for (int k = 0; k < STEPS * STEPS; k++) {
      double t = length * (k % STEPS + .5) / STEPS - end, x, y, w, off;
      double side = 2 * own->width * ((k / STEPS + .5) / STEPS - .5);
      if (!rc_dash_px(ground, exponent, own, t, side, &x, &y, &w) ||
          !rc_dashes_off(dashes, x, y, &off) || !(off > 0))
        continue;
      if (pass)
        tt += off * (t - mt) * (t - mt), ts += off * (t - mt) * (side - ms);
      else
        weight += off, mt += off * (t - mt) / weight, ms += off * (side - ms) / weight;
    }
  if (!(tt > 0) || fabs(ts) > MOST_TURN * tt) return;
  double slope = ts / tt, long_by = sqrt(1 + slope * slope), a = own->a, b = own->b;
  own->u += mt * a - ms * b, own->v += mt * b + ms * a;
  own->a = (a - slope * b) / long_by, own->b = (b + slope * a) / long_by;
  own->u -= mt * own->a, own->v -= mt * own->b;
}

bool rc_dash_alone(const rc_dashes *dashes, const rc_ground *ground, const rc_mask *flags,
                   int exponent, const rc_dash_row *row, double length, const rc_dash_rest *rest,
                   const rc_dash *next, rc_dash_row *own) {
  *own = row_of(row, length, rest, next);
  double copied = length_to_copy(ground, flags, exponent, own, rest->length);
  if (!next && copied > 0) {
    straighten(dashes, ground, exponent, copied, own);
    copied = length_to_copy(ground, flags, exponent, own, rest->length);
  }
  if (copied < LEAST_COPIED * length) return false;
  own->laid[0] = (rc_dash_laid){.number = 0, .rest = copied};
  own->laid_count = 1;
  return true;
}

bool rc_dash_of_rest(const rc_dashes *dashes, const rc_dash_rows *rows, const rc_mask *flags,
                     int exponent, const rc_dash_row *row, int n, rc_dash_row *own) {
  rc_dash_rest rests[2];
  double length = length_of_nearest(dashes, rows, row), most = 0;
  find_rests(dashes, row, n, rests);
  if (rests[0].length > 0 && rests[1].length > 0) /* both its ends are seen */
    length = (rests[0].length + rests[1].length) / 2 +
             rc_distance(rests[1].u - rests[0].u, rests[1].v - rests[0].v);
  for (int i = 0; i < 2; i++) {
    rc_dash_row alone;
    if (!(rests[i].length > 0) ||
        !rc_dash_alone(dashes, &rows->ground, flags, exponent, row, length, &rests[i],
                       rc_dash_next(dashes, row, &rests[i]), &alone) ||
        alone.laid[0].rest < most)
      continue;
    most = alone.laid[0].rest;
    *own = alone;
  }
  return most > 0;
}
