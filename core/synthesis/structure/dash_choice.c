#include <math.h>

#include "base/real.h"
#include "synthesis/structure/dash_row.h"
#include "synthesis/structure/dash_rows.h"

/* Copies may be so much too coarse, and nearer ones so much too fine; an octave of the former is so
 * much worse. */
#define MOST_COARSE 2.5
#define MOST_FINE 6.
#define PRICE_COARSE 3.f
/* Its own row's, which lean as it does, are preferred by so many octaves. */
#define PRICE_OF_OTHER_ROW 1.f
/* Where one is seen in part the copy must fit that, moved by up to so many px of the level: in the
 * mean of squares to this part of the contrast. Places along and across that are looked at, over so
 * much of its length and width. */
#define MOST_MOVED_PX 3
#define MOST_MISFIT .5
#define PLACES_ALONG 32
#define PLACES_ACROSS 12
#define LEAST_PLACES 12
#define PART_ALONG 1.2
#define PART_ACROSS 2.
/* A px farther must be so much better. */
#define PRICE_OF_MOVING .01

typedef struct chooser {
  const rc_dashes *dashes;
  const rc_mask *flags;
  const rc_ground *ground;
  int exponent;
} chooser;

static bool off_at(const chooser *c, double x, double y, uint8_t wanted, double *off) {
  int px = (int)floor(x + .5), py = (int)floor(y + .5);
  if (!rc_inside(c->flags->width, c->flags->height, px, py) ||
      !(*rc_flag(c->flags, px, py) & wanted))
    return false;
  *off = (double)c->dashes->off[(size_t)py * (size_t)c->flags->width + (size_t)px];
  return true;
}

/* Where the middle of the best dash that is seen lies, for a row's n-th. */
static bool best_dash(const rc_dash_rows *rows, const rc_dash_row *row, int n, double *u,
                      double *v) {
  float least = INFINITY;
  double x, y, w, there, t = rc_dash_place(row, n);
  if (!rc_ground_px(&rows->ground, 0, row->u + t * row->a, row->v + t * row->b, &x, &y, &w))
    return false;
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *from = &rows->rows[i];
    if (!rc_dashes_alike(row, from->length, from->a, from->b)) continue;
    for (int k = 0; k < from->seen_count; k++) {
      t = rc_dash_place(from, from->seen[k]);
      double from_u = from->u + t * from->a, from_v = from->v + t * from->b;
      if (!rc_ground_px(&rows->ground, 0, from_u, from_v, &x, &y, &there)) continue;
      if (there * MOST_COARSE < w || there > MOST_FINE * w) continue;
      float finer = rc_log2((float)(there / w));
      float price = (finer < 0 ? -PRICE_COARSE : 1.f) * finer;
      if (from != row) price += PRICE_OF_OTHER_ROW;
      if (price >= least) continue;
      least = price, *u = from_u, *v = from_v;
    }
  }
  return least < INFINITY;
}

typedef struct fit {
  double squares, seen, hidden; /* places */
} fit;

/* Of the n-th with one that lies (du, dv) away and is moved by so many px of the level. */
static fit fit_of(const chooser *c, const rc_dash_row *row, int n, double du, double dv, int right,
                  int down) {
  fit f = {0, 0, 0};
  for (int i = 0; i < PLACES_ALONG; i++)
    for (int k = 0; k < PLACES_ACROSS; k++) {
      double t = rc_dash_place(row, n) + PART_ALONG * row->length * ((i + .5) / PLACES_ALONG - .5);
      double side = PART_ACROSS * row->width * ((k + .5) / PLACES_ACROSS - .5);
      double u = row->u + t * row->a - side * row->b, v = row->v + t * row->b + side * row->a;
      double x, y, from_x, from_y, w, here, there, none;
      if (!rc_ground_px(c->ground, c->exponent, u, v, &x, &y, &w) ||
          !rc_ground_px(c->ground, c->exponent, u + du, v + dv, &from_x, &from_y, &w))
        continue;
      f.hidden += off_at(c, x, y, RC_TARGET, &none);
      if (!off_at(c, x, y, RC_SOURCE | RC_ALLOWED, &here) ||
          !off_at(c, from_x + right, from_y + down, RC_SOURCE | RC_ALLOWED, &there))
        continue;
      f.squares += (here - there) * (here - there), f.seen++;
    }
  return f;
}

/* Moves the copy to where it fits best. False: it does not. */
static bool move(const chooser *c, const rc_dash_row *row, int n, double u, double v,
                 rc_dash_laid *laid) {
  double t = rc_dash_place(row, n), du = u - row->u - t * row->a, dv = v - row->v - t * row->b;
  double x, y, w, least = INFINITY, misfit = 0;
  for (int down = -MOST_MOVED_PX; down <= MOST_MOVED_PX; down++)
    for (int right = -MOST_MOVED_PX; right <= MOST_MOVED_PX; right++) {
      fit f = fit_of(c, row, n, du, dv, right, down);
      bool told = f.seen >= LEAST_PLACES;
      double far = PRICE_OF_MOVING * hypot(right, down);
      double off = told ? f.squares / f.seen / (row->contrast * row->contrast) : 0;
      if (off + far >= least || !rc_ground_px(c->ground, c->exponent, u, v, &x, &y, &w) ||
          !rc_ground_place(c->ground, c->exponent, x + right, y + down, &laid->u, &laid->v, &w))
        continue;
      least = off + far, misfit = off;
    }
  return least < INFINITY && misfit < MOST_MISFIT * MOST_MISFIT;
}

void rc_dash_rows_choose(const rc_dashes *dashes, const rc_mask *flags, int exponent,
                         rc_dash_rows *rows) {
  chooser c = {dashes, flags, &rows->ground, exponent};
  for (int i = 0; i < rows->count; i++) {
    rc_dash_row *row = &rows->rows[i];
    row->laid_count = 0;
    for (int n = row->low; n <= row->high && row->laid_count < RC_MOST_IN_ROW; n++) {
      rc_dash_laid laid = {.number = n};
      double u = 0, v = 0;
      if (fit_of(&c, row, n, 0, 0, 0, 0).hidden > 0 && best_dash(rows, row, n, &u, &v) &&
          move(&c, row, n, u, v, &laid))
        row->laid[row->laid_count++] = laid;
    }
  }
}
