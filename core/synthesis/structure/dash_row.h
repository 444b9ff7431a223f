/* Where a row's dashes are. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_DASH_ROW_H
#define RECEDE_SYNTHESIS_STRUCTURE_DASH_ROW_H

#include <math.h>

#include "synthesis/structure/dash_rows.h"

/* More are told apart from none. */
#define RC_DASH_FARTHEST 1000

/* What makes dashes of one row, or of rows side by side, alike. */
#define RC_DASHES_MOST_LONGER 1.6
#define RC_DASHES_PARALLEL .99 /* cosine of 8 degrees */
/* Sine of what a dash's own direction may be off its row's, and so much of its width to its length
 * more: the longer it is the better it tells where its row leads. */
#define RC_DASHES_OFF_DIRECTION .035
#define RC_DASHES_OFF_BY_WIDTH .5
/* They lie on its line within this part of their length, and so many px of the finest level. */
#define RC_DASHES_OFF_LINE .1
#define RC_DASHES_OFF_LINE_PX 1.5
/* A copy may be so much too coarse. */
#define RC_DASHES_MOST_COARSE 2.5
/* A dash is laid so many times as wide and long as it is: the join needs it. */
#define RC_DASH_TIMES_LAID 1.3

/* Of a place in the plane, how far it lies along the row's line, and off it to its side. */
static inline double rc_dash_along(const rc_dash_row *row, double u, double v) {
  return (u - row->u) * row->a + (v - row->v) * row->b;
}
static inline double rc_dash_across(const rc_dash_row *row, double u, double v) {
  return (v - row->v) * row->a - (u - row->u) * row->b;
}
/* The px of a level at a place so far along the row's line and off it, and its w. False: there is
 * none. */
static inline bool rc_dash_px(const rc_ground *ground, int exponent, const rc_dash_row *row,
                              double along, double side, double *x, double *y, double *w) {
  double u = row->u + along * row->a - side * row->b, v = row->v + along * row->b + side * row->a;
  return rc_ground_px(ground, exponent, u, v, x, y, w);
}
/* Where along it the middle of the n-th is due, and which is due next to a place along it. */
static inline double rc_dash_place(const rc_dash_row *row, int n) {
  return (row->first + n * row->period) / (1 + n * row->drift);
}
static inline int rc_dash_number(const rc_dash_row *row, double t) {
  double n = (t - row->first) / (row->period - row->drift * t) + .5;
  return fabs(n) < RC_DASH_FARTHEST ? (int)floor(n) : RC_DASH_FARTHEST;
}

/* Whether dashes of this length and direction may be of the row, or of one beside it. */
static inline bool rc_dashes_alike(const rc_dash_row *row, double length, double a, double b) {
  return length < RC_DASHES_MOST_LONGER * row->length &&
         row->length < RC_DASHES_MOST_LONGER * length &&
         fabs(a * row->a + b * row->b) > RC_DASHES_PARALLEL;
}

/* How far a dash's own direction is off its row's, as a part of what may be. */
static inline double rc_dash_turn(const rc_dash_row *row, const rc_dash *d) {
  return fabs(d->a * row->b - d->b * row->a) /
         (RC_DASHES_OFF_DIRECTION + RC_DASHES_OFF_BY_WIDTH * d->width / d->length);
}

/* Whether it may be of the row, or of one beside it, and leads as that does. */
static inline bool rc_dash_is_like(const rc_dash_row *row, const rc_dash *d) {
  return rc_dashes_alike(row, d->length, d->a, d->b) && rc_dash_turn(row, d) <= 1;
}

static inline bool rc_dash_lies_on(const rc_dash_row *row, double u, double v, double w) {
  return fabs(rc_dash_across(row, u, v)) <
         RC_DASHES_OFF_LINE * row->length + RC_DASHES_OFF_LINE_PX / w;
}

/* A row through a dash, of dashes as another one is; its period is not known. */
static inline rc_dash_row rc_dash_row_like(const rc_dash *like, const rc_dash *d) {
  return (rc_dash_row){.u = d->u,
                       .v = d->v,
                       .a = like->a,
                       .b = like->b,
                       .length = like->length,
                       .width = like->width,
                       .contrast = d->contrast};
}

/* What is left of a dash of a row that the hole or the picture's end cuts. */
typedef struct rc_dash_rest {
  double u, v; /* its middle */
  double length, width;
  double towards; /* 1: it is cut farther along the row; -1: nearer */
} rc_dash_rest;

/* False: it is none of one of the row's. */
bool rc_dash_rest_of(const rc_dash_row *row, const rc_dash *dash, rc_dash_rest *rest);
/* Where the middle of the whole one lies. */
void rc_dash_rest_middle(const rc_dash_row *row, const rc_dash_rest *rest, double *u, double *v);
/* The row's dash that is seen next to it, or NULL. */
const rc_dash *rc_dash_next(const rc_dashes *dashes, const rc_dash_row *row,
                            const rc_dash_rest *rest);
/* A row of that dash alone, so long, towards the next one or, without one, as the rest lies: from
 * the end that is seen to where the other is due. False: too little of it may be copied. */
bool rc_dash_alone(const rc_dashes *dashes, const rc_ground *ground, const rc_mask *flags,
                   int exponent, const rc_dash_row *row, double length, const rc_dash_rest *rest,
                   const rc_dash *next, rc_dash_row *own);
/* A row's n-th alone, made of its own rest. False: there is none, or too little of it may be
 * copied. */
bool rc_dash_of_rest(const rc_dashes *dashes, const rc_dash_rows *rows, const rc_mask *flags,
                     int exponent, const rc_dash_row *row, int n, rc_dash_row *own);

/* Around a row's n-th, so many times as long and wide and a margin more, px of a level. */
rc_box rc_dash_box(const rc_ground *ground, const rc_dash_row *row, int n, int exponent,
                   double times_along, double times_across, double margin_px, rc_box within);
/* Whether the hole hides something of a row's n-th. */
bool rc_dash_is_hidden(const rc_ground *ground, const rc_mask *flags, int exponent,
                       const rc_dash_row *row, int n);
/* Whether the hole is there to take a row's n-th away. */
bool rc_dash_is_to_go(const rc_ground *ground, const rc_mask *flags, int exponent,
                      const rc_dash_row *row, int n);
/* Chooses what is laid into the hole, of rows that are found: dashes of a size that will do and, of
 * one that is seen in part, such that fit that. Where none does, a row of that one alone is added,
 * made of its rest. */
recede_status rc_dash_rows_choose(rc_context *context, const rc_dashes *dashes,
                                  const rc_mask *flags, int exponent, rc_dash_rows *rows);

#endif
