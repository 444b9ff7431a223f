#include "synthesis/structure/dash_lone.h"

/* As long as one that is wholly seen, of at least this part of its contrast, and is not alone of
 * its kind: the nearest to the viewer, for far ones get longer by their blur. */
#define LEAST_OF_CONTRAST .5
/* The next one comes at least so many lengths on, and nothing stands out before. */
#define LEAST_PERIOD 2.
/* One that is so many lengths away, and no longer than by so much - it is blurred -, tells where it
 * leads; farther ones may be the next lane's. */
#define MOST_AWAY 10.
#define MOST_LONGER 3.

static bool stands_out_as(const rc_dash *of, const rc_dash *d) {
  return of->contrast > LEAST_OF_CONTRAST * d->contrast;
}

/* Others, of which a part may be hidden. */
static bool is_one_of_some(const rc_dashes *dashes, const rc_dash *of, const rc_dash *d) {
  rc_dash_row row = rc_dash_row_like(of, of);
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *other = &dashes->found[i];
    if (other != of && other != d && stands_out_as(other, d) &&
        rc_dashes_alike(&row, other->length, other->a, other->b))
      return true;
  }
  return false;
}

/* The dash whose rest this is, as the one that is returned shows; NULL: none does. */
static const rc_dash *whole_of(const rc_dashes *dashes, const rc_dash *d, rc_dash_row *row,
                               rc_dash_rest *rest) {
  const rc_dash *like = NULL;
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *of = &dashes->found[i];
    rc_dash_row whole = rc_dash_row_like(of, d);
    rc_dash_rest found;
    if (of->complete && stands_out_as(of, d) && (!like || of->w > like->w) &&
        fabs(of->a * d->a + of->b * d->b) > RC_DASHES_PARALLEL &&
        rc_dash_rest_of(&whole, d, &found) && is_one_of_some(dashes, of, d))
      like = of, *row = whole, *rest = found;
  }
  return like;
}

/* Turns a row through the rest of a dash towards another whose own direction fits best, and returns
 * that; NULL: none does. like: the dash that the row's are like, whose direction must fit, too. */
static const rc_dash *aim(const rc_dashes *dashes, const rc_dash *like, rc_dash_row *row) {
  const rc_dash *next = NULL;
  rc_dash_row best = *row;
  double least = 1;
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *d = &dashes->found[i];
    double du = d->u - row->u, dv = d->v - row->v, far = rc_distance(du, dv);
    if (!d->complete || far < row->length || far > MOST_AWAY * row->length) continue;
    rc_dash_row to = *row;
    double sign = du * row->a + dv * row->b < 0 ? -1 : 1;
    to.a = sign * du / far, to.b = sign * dv / far;
    double turn = fmax(rc_dash_turn(&to, d), rc_dash_turn(&to, like));
    if (turn < least && d->length * RC_DASHES_MOST_LONGER > row->length &&
        d->length < MOST_LONGER * row->length)
      least = turn, best = to, next = d;
  }
  *row = best;
  return next;
}

/* The other rest of the dash whose rest this is, if the hole hides its middle, or NULL; sets the
 * row's length to the whole one's. */
static const rc_dash *find_other(const rc_dashes *dashes, const rc_dash_rest *rest,
                                 rc_dash_row *row) {
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *d = &dashes->found[i];
    double far = rest->towards * rc_dash_along(row, d->u, d->v);
    rc_dash_rest other;
    if (d->complete || !(far > 0) || !rc_dash_lies_on(row, d->u, d->v, d->w) ||
        !rc_dash_rest_of(row, d, &other) || other.towards == rest->towards)
      continue;
    double length = far + (rest->length + other.length) / 2;
    if (length > RC_DASHES_MOST_LONGER * row->length) continue;
    row->length = length;
    return d;
  }
  return NULL;
}

/* Whether the hole cuts something longer than a dash on whose line it lies: then it is a piece of
 * that. */
static bool is_of_line(const rc_dashes *dashes, const rc_dash *d, const rc_dash_row *row) {
  for (int i = 0; i < dashes->count; i++) {
    const rc_dash *line = &dashes->found[i];
    rc_dash_row along = rc_dash_row_like(line, line);
    along.length = row->length;
    if (!line->complete && line->length > RC_DASHES_MOST_LONGER * row->length &&
        fabs(line->a * row->a + line->b * row->b) > RC_DASHES_PARALLEL &&
        rc_dash_lies_on(&along, d->u, d->v, d->w))
      return true;
  }
  return false;
}

/* Whether it is one of a row that was chosen from, or a part of one that lies alone. */
static bool is_known(const rc_dash_rows *rows, const rc_dash *d) {
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *row = &rows->rows[i];
    double off = fabs(rc_dash_along(row, d->u, d->v) - rc_dash_place(row, row->low));
    if (rc_dash_lies_on(row, d->u, d->v, d->w) &&
        (row->low < row->high || off < (row->length + d->length) / 2))
      return true;
  }
  return false;
}

/* Those that are as one is copied nowhere else, either. */
static void keep_in_place(const rc_dashes *dashes, const rc_dash *like, rc_dash_rows *rows) {
  rc_dash_row row = rc_dash_row_like(like, like);
  for (int i = 0; i < dashes->count && rows->alike_count < RC_MOST_DASHES; i++)
    if (dashes->found[i].complete && rc_dash_is_like(&row, &dashes->found[i]))
      rows->alike[rows->alike_count++] = dashes->found[i];
}

recede_status rc_dash_rows_add_lone(rc_context *context, const rc_dash_sight *sight,
                                    const rc_mask *flags, rc_dash_rows *rows) {
  const rc_dashes *dashes = &sight->dashes;
  for (int i = 0; i < dashes->count && rows->count < RC_MOST_DASH_ROWS; i++) {
    RC_TRY(rc_poll(context));
    const rc_dash *d = &dashes->found[i];
    rc_dash_row row, own;
    rc_dash_rest rest;
    const rc_dash *like =
        d->complete || is_known(rows, d) ? NULL : whole_of(dashes, d, &row, &rest);
    if (!like) continue;
    row.period = LEAST_PERIOD * row.length;
    const rc_dash *next = find_other(dashes, &rest, &row);
    if (!next) next = aim(dashes, like, &row);
    if (is_of_line(dashes, d, &row) || !rc_dash_row_is_plain(sight, &row, 0, 0) ||
        !rc_dash_is_on_plain(sight, &row, rest.length) ||
        !rc_dash_alone(dashes, &sight->ground, flags, sight->exponent, &row, row.length, &rest,
                       next, &own) ||
        !rc_dash_is_hidden(&sight->ground, flags, sight->exponent, &own, 0) ||
        rc_dash_is_to_go(&sight->ground, flags, sight->exponent, &own, 0))
      continue;
    rows->rows[rows->count++] = own;
    keep_in_place(dashes, like, rows);
  }
  return rc_poll(context);
}
