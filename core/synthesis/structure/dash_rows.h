/* Rows of dashes that come again along a straight line of the plane: a road's lanes. A patch sees
 * one dash at the most, and seams may pass between any two. So rows are found around the hole, what
 * lies in them is copied nowhere else, and in the hole each dash of a row is a copy of one that is
 * seen, or is made whole of its own rest. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_DASH_ROWS_H
#define RECEDE_SYNTHESIS_STRUCTURE_DASH_ROWS_H

#include "synthesis/structure/crossing.h"
#include "synthesis/structure/dashes.h"

#define RC_MOST_DASH_ROWS 8
#define RC_MOST_IN_ROW 24

/* A dash in the hole: which, and where the middle of the one that is copied lies. Or it is made of
 * its own rest, and that says nothing. */
typedef struct rc_dash_laid {
  int number;
  double u, v;
  double rest; /* 0, or so much of it may be copied, from its end at -length / 2 */
} rc_dash_laid;

/* Places and lengths as those of a dash. */
typedef struct rc_dash_row {
  double u, v, a, b;    /* a point of its line, and the line's direction, a unit vector */
  double first, period; /* its n-th dash's middle is first + n period from (u, v) along it; */
  double drift;         /* while the ground is not known, that over 1 + n drift */
  double length, width; /* of its dashes */
  double contrast;
  int low, high;            /* which dashes there are, seen or not */
  bool ends[2];             /* there it is seen to have ended, at low and at high */
  int seen[RC_MOST_IN_ROW]; /* those wholly seen */
  int seen_count;
  rc_dash_laid laid[RC_MOST_IN_ROW];
  int laid_count;
} rc_dash_row;

typedef struct rc_dash_rows {
  rc_ground ground; /* turned by what they show */
  rc_dash_row rows[RC_MOST_DASH_ROWS];
  int count, told;               /* all; those of more than a dash that lies alone, the first */
  rc_dash alike[RC_MOST_DASHES]; /* that lie in no row, but are as one that lies alone was */
  int alike_count;
} rc_dash_rows;

/* image and flags: a level 2^exponent times coarser than the finest. */
recede_status rc_dash_rows_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                                const rc_ground *ground, int exponent, rc_dash_rows *rows);
/* Takes RC_SOURCE from a level's pixels that are part of rows' dashes, or lie beside them. */
void rc_dash_rows_take(const rc_dash_rows *rows, int exponent, const rc_mask *flags);
/* Around a dash that is laid, with what lies beside it, px of the finest level. */
rc_box rc_dash_laid_box(const rc_ground *ground, const rc_dash_row *row, const rc_dash_laid *laid,
                        rc_box within);
/* The copy of a pixel of the finest level, relative to the chart's origin. False: it is no part of
 * the dash and lies not beside it. */
bool rc_dash_laid_copy(const rc_ground *ground, const rc_dash_row *row, const rc_dash_laid *laid,
                       const rc_chart *chart, float x, float y, rc_copy *copy);
/* Takes out lines that run along a row: it says what they show in the hole. */
void rc_dash_rows_drop_lines(const rc_dash_rows *rows, rc_crossing *lines, int *count);

#endif
