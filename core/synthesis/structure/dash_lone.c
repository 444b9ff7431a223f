#include "synthesis/structure/dash_lone.h"

/* As long as one that is wholly seen, of at least this part of its contrast, and is not alone of
 * its kind: the nearest to the viewer, for far ones get longer by their blur. */
#define LEAST_OF_CONTRAST .5
/* Nothing stands out before the next would come, so many lengths on at the least. */
#define LEAST_PERIOD 2.

static bool is_model(const rc_dash *of, const rc_dash *d) {
  return of->complete && of->contrast > LEAST_OF_CONTRAST * d->contrast;
}

/* A row through a dash, of dashes as another one is. */
static rc_dash_row row_like(const rc_dash *like, const rc_dash *d) {
  return (rc_dash_row){.u = d->u,
                       .v = d->v,
                       .a = like->a,
                       .b = like->b,
                       .period = LEAST_PERIOD * like->length,
                       .length = like->length,
                       .width = like->width,
                       .contrast = d->contrast};
}

static bool is_one_of_some(const rc_dashes *dashes, const rc_dash *of, const rc_dash *d) {
  rc_dash_row row = row_like(of, of);
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *other = &dashes->found[i];
    if (other != of && is_model(other, d) &&
        rc_dashes_alike(&row, other->length, other->a, other->b))
      return true;
  }
  return false;
}

/* The dash that this is a rest of, by others, and the one that it is like; NULL: there is none. */
static const rc_dash *whole_of(const rc_dashes *dashes, const rc_dash *d, rc_dash_row *row,
                               rc_dash_rest *rest) {
  const rc_dash *like = NULL;
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *of = &dashes->found[i];
    rc_dash_row whole = row_like(of, d);
    rc_dash_rest found;
    if ((!like || of->w > like->w) && is_model(of, d) &&
        fabs(of->a * d->a + of->b * d->b) > RC_DASHES_PARALLEL &&
        rc_dash_rest_of(&whole, d, &found) && is_one_of_some(dashes, of, d))
      like = of, *row = whole, *rest = found;
  }
  return like;
}

/* Turns a row through the rest of a dash to the one that leads to it best, and returns that; NULL:
 * none does. like: that leads as it does. */
static const rc_dash *aim(const rc_dashes *dashes, const rc_dash *like, rc_dash_row *row) {
  const rc_dash *next = NULL;
  rc_dash_row best = *row;
  double least = 1;
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *d = &dashes->found[i];
    double du = d->u - row->u, dv = d->v - row->v, far = rc_distance(du, dv);
    if (!d->complete || far < row->length) continue;
    rc_dash_row to = *row;
    double sign = du * row->a + dv * row->b < 0 ? -1 : 1;
    to.a = sign * du / far, to.b = sign * dv / far;
    double turn = fmax(rc_dash_turn(&to, d), rc_dash_turn(&to, like));
    if (turn < least && d->length * RC_DASHES_MOST_LONGER > row->length)
      least = turn, best = to, next = d;
  }
  *row = best;
  return next;
}

/* Whether the hole cuts something longer than a dash on its line: then it is a piece of that. */
static bool is_of_line(const rc_dashes *dashes, const rc_dash_row *row) {
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *d = &dashes->found[i];
    if (!d->complete && d->length > RC_DASHES_MOST_LONGER * row->length &&
        fabs(d->a * row->a + d->b * row->b) > RC_DASHES_PARALLEL &&
        rc_dash_lies_on(row, d->u, d->v, d->w))
      return true;
  }
  return false;
}

/* Whether a dash that is laid, or that somebody took away, lies there. */
static bool is_known(const rc_dash_rows *rows, const rc_dash *d) {
  for (int i = 0; i < rows->count; i++)
    if (rc_dash_lies_on(&rows->rows[i], d->u, d->v, d->w)) return true;
  return false;
}

recede_status rc_dash_rows_add_lone(rc_context *context, const rc_dash_sight *sight,
                                    const rc_mask *flags, rc_dash_rows *rows) {
  const rc_dashes *dashes = &sight->dashes;
  for (int i = 0; i < dashes->count && rows->count < RC_MOST_DASH_ROWS; i++) {
    const rc_dash *d = &dashes->found[i];
    rc_dash_row row, own;
    rc_dash_rest rest;
    const rc_dash *like =
        d->complete || is_known(rows, d) ? NULL : whole_of(dashes, d, &row, &rest);
    if (!like) continue;
    const rc_dash *next = aim(dashes, like, &row);
    if (is_of_line(dashes, &row) || !rc_dash_row_is_plain(sight, &row, 0, 0) ||
        !rc_dash_is_on_plain(sight, &row, rest.length) ||
        !rc_dash_alone(dashes, &sight->ground, flags, sight->exponent, &row, row.length, &rest,
                       next, &own) ||
        !rc_dash_is_hidden(&sight->ground, flags, sight->exponent, &own, 0) ||
        rc_dash_is_to_go(&sight->ground, flags, sight->exponent, &own, 0))
      continue;
    rows->rows[rows->count++] = own;
  }
  return rc_poll(context);
}
