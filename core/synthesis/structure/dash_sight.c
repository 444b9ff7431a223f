#include "synthesis/structure/dash_sight.h"

#include <math.h>

/* Between a row's dashes, from so much of a dash's length from its middle, hardly anything stands
 * out by more than this part of what they do; and across their ends nothing does along most of
 * their length, as a wall's joints would. Places that are looked at. */
#define PART_OF_CONTRAST .33
#define GAP_FROM .75
#define MOST_PART_BETWEEN .25
#define ACROSS_FROM .4
#define ACROSS_TO .8
#define STEPS_ACROSS 12
#define LEAST_ACROSS .6
#define SAMPLES 32
/* To its sides, so many of its widths off its middle, the ground is as plain. */
#define BESIDE 1.5
#define MOST_PART_BESIDE .25
/* Shorter ones of the level could be missed. */
#define LEAST_SEEN_PX 4.

typedef struct looked {
  double seen, stands_out; /* places */
} looked;

/* Whether a row's n-th dash would be seen if it were there. */
static bool would_be_seen(const rc_dash_sight *s, const rc_dash_row *row, int n) {
  double x[3], y[3], w, off;
  for (int k = 0; k < 3; k++) {
    double t = rc_dash_place(row, n) + .5 * (k - 1) * row->length;
    if (!rc_dash_px(&s->ground, s->exponent, row, t, 0, &x[k], &y[k], &w) ||
        !rc_dashes_off(&s->dashes, x[k], y[k], &off))
      return false;
  }
  return rc_distance(x[2] - x[0], y[2] - y[0]) >= LEAST_SEEN_PX;
}

static bool is_there(const rc_dash_sight *s, const rc_dash_row *row, int n) {
  for (int i = 0; i < s->dashes.count; i++) {
    const rc_dash *d = &s->dashes.found[i];
    if (rc_dash_lies_on(row, d->u, d->v, d->w) &&
        fabs(rc_dash_along(row, d->u, d->v) - rc_dash_place(row, n)) <
            .5 * (row->length + d->length))
      return true;
  }
  return false;
}

bool rc_dash_is_missing(const rc_dash_sight *s, const rc_dash_row *row, int n) {
  return would_be_seen(s, row, n) && !is_there(s, row, n);
}

/* Counts what is seen, and stands out, at a place so far along the row and off it. */
static void look(const rc_dash_sight *s, const rc_dash_row *row, double t, double side, looked *l) {
  double x, y, w, off;
  if (!rc_dash_px(&s->ground, s->exponent, row, t, side, &x, &y, &w) ||
      !rc_dashes_off(&s->dashes, x, y, &off))
    return;
  l->seen++, l->stands_out += fabs(off) > PART_OF_CONTRAST * row->contrast;
}

/* At what lies between a dash and the next. */
static void look_between(const rc_dash_sight *s, const rc_dash_row *row, int n, looked *l) {
  double from = rc_dash_place(row, n) + GAP_FROM * row->length;
  double to = rc_dash_place(row, n + 1) - GAP_FROM * row->length;
  for (int k = 0; k < SAMPLES; k++) look(s, row, from + (to - from) * (k + .5) / SAMPLES, 0, l);
}

/* Whether something lies across an end of the n-th, as the joints of a wall do. */
static bool is_crossed(const rc_dash_sight *s, const rc_dash_row *row, int n, double end) {
  for (int i = 0; i < STEPS_ACROSS; i++) {
    double from_middle = ACROSS_FROM + (ACROSS_TO - ACROSS_FROM) * i / STEPS_ACROSS;
    looked l = {0, 0};
    for (int k = 0; k < SAMPLES; k++) {
      double side = row->length * ((k + .5) / SAMPLES - .5);
      if (fabs(side) > row->width)
        look(s, row, rc_dash_place(row, n) + end * from_middle * row->length, side, &l);
    }
    if (l.seen >= SAMPLES / 4 && l.stands_out > LEAST_ACROSS * l.seen) return true;
  }
  return false;
}

bool rc_dash_is_on_plain(const rc_dash_sight *s, const rc_dash_row *row, double length) {
  looked l = {0, 0};
  for (int k = 0; k < 2 * SAMPLES; k++)
    look(s, row, length * ((k / 2 + .5) / SAMPLES - .5), (k % 2 ? BESIDE : -BESIDE) * row->width,
         &l);
  return l.seen >= SAMPLES / 2 && l.stands_out <= MOST_PART_BESIDE * l.seen;
}

bool rc_dash_row_is_plain(const rc_dash_sight *s, const rc_dash_row *row, int first, int last) {
  looked l = {0, 0};
  int crossed = 0;
  for (int n = first - 1; n <= last; n++) look_between(s, row, n, &l);
  for (int i = 0; i < row->seen_count; i++)
    crossed += is_crossed(s, row, row->seen[i], -1) || is_crossed(s, row, row->seen[i], 1);
  return l.stands_out <= MOST_PART_BETWEEN * l.seen && 2 * crossed <= row->seen_count;
}
