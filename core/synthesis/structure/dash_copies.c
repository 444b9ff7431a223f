#include <math.h>

#include "base/real.h"
#include "synthesis/structure/dash_row.h"
#include "synthesis/structure/dash_rows.h"

/* A dash is taken, and laid, so many times as wide and long as it is, and so many px of the finest
 * level (at least of the own level) more on each side: the join needs it. */
#define TIMES_WIDTH 1.3
#define TIMES_LENGTH 1.1
#define MARGIN_PX 4.
#define LEAST_MARGIN_PX 1.
/* Copies may be so much too coarse, and nearer ones so much too fine; an octave of the former is so
 * much worse. */
#define MOST_COARSE 2.5
#define MOST_FINE 6.
#define PRICE_COARSE 3.f
/* Its own row's are preferred by so many octaves. */
#define PRICE_OF_OTHER_ROW .1f

/* Which of a row's dashes a place is part of, or lies beside. False: none. */
static bool lies_in(const rc_dash_row *row, double u, double v, double w, double margin_px,
                    int *n) {
  if (rc_dash_across(row, u, v) > .5 * TIMES_WIDTH * row->width + margin_px / w) return false;
  double t = rc_dash_along(row, u, v);
  *n = rc_dash_number(row, t);
  return *n >= row->low && *n <= row->high &&
         fabs(t - rc_dash_place(row, *n)) <= .5 * TIMES_LENGTH * row->length + margin_px / (w * w);
}

void rc_dash_rows_take(const rc_dash_rows *rows, int exponent, const rc_mask *flags) {
  rc_chart here = rc_chart_coarser(rows->chart, exponent);
  double unit = (double)(1 << exponent), margin_px = fmax(MARGIN_PX, LEAST_MARGIN_PX * unit);
  int n;
  for (int y = 0; y < flags->height && rows->count; y++)
    for (int x = 0; x < flags->width; x++) {
      double px = (double)x - (double)here.x0, py = (double)y - (double)here.y0;
      double w = 1 + (double)here.lx * px + (double)here.ly * py;
      if (!(*rc_flag(flags, x, y) & RC_SOURCE) || !(w > 0)) continue;
      for (int i = 0; i < rows->count; i++)
        if (lies_in(&rows->rows[i], unit * px / w, unit * py / w, w, margin_px, &n))
          *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
    }
}

/* The move, in the plane, that takes a row's n-th dash from the best that is seen. */
static bool best_move(const rc_dash_rows *rows, const rc_dash_row *row, int n, double *a,
                      double *b) {
  const rc_chart *chart = &rows->chart;
  float least = INFINITY;
  double x, y, w, there;
  double u = row->u + rc_dash_place(row, n) * row->a, v = row->v + rc_dash_place(row, n) * row->b;
  if (!rc_dash_in_picture(chart, 1, u, v, &x, &y, &w)) return false;
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *from = &rows->rows[i];
    if (!rc_dashes_alike(row, from->length, from->a, from->b)) continue;
    for (int k = 0; k < from->seen_count; k++) {
      double t = rc_dash_place(from, from->seen[k]);
      double from_u = from->u + t * from->a, from_v = from->v + t * from->b;
      if (!rc_dash_in_picture(chart, 1, from_u, from_v, &x, &y, &there)) continue;
      if (there * MOST_COARSE < w || there > MOST_FINE * w) continue;
      float finer = rc_log2((float)(there / w));
      float price = (finer < 0 ? -PRICE_COARSE : 1.f) * finer;
      if (from != row) price += PRICE_OF_OTHER_ROW;
      if (price >= least) continue;
      least = price, *a = from_u - u, *b = from_v - v;
    }
  }
  return least < INFINITY;
}

bool rc_dash_rows_copy(const rc_dash_rows *rows, const rc_chart *chart, float x, float y,
                       rc_copy *copy) {
  const rc_chart *own = &rows->chart;
  float w = 1.f + own->lx * x + own->ly * y;
  double a = 0, b = 0;
  int n;
  for (int i = 0; i < rows->count && w > 0.f; i++) {
    const rc_dash_row *row = &rows->rows[i];
    if (!lies_in(row, (double)(x / w), (double)(y / w), (double)w, MARGIN_PX, &n) ||
        !best_move(rows, row, n, &a, &b))
      continue;
    rc_place from = rc_copy_place(own, (rc_copy){(float)a, (float)b, 0.f}, x, y);
    *copy = rc_copy_exact(chart, x, y, from.x, from.y);
    return !from.beyond;
  }
  return false;
}
