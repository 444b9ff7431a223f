#include <math.h>

#include "synthesis/structure/dash_row.h"
#include "synthesis/structure/dash_rows.h"

/* A dash is laid so many px of the finest level (at least of the own level) wider on each side than
 * RC_DASH_TIMES_LAID. It is taken as it is, and as many more. */
#define MARGIN_PX 4.
#define LEAST_MARGIN_PX 1.

rc_box rc_dash_box(const rc_ground *ground, const rc_dash_row *row, int n, int exponent,
                   double times_along, double times_across, double margin_px, rc_box within) {
  double low_x = INFINITY, low_y = INFINITY, high_x = -INFINITY, high_y = -INFINITY;
  for (int k = 0; k < 4; k++) {
    double t = rc_dash_place(row, n) + (k & 1 ? .5 : -.5) * times_along * row->length, x, y, w;
    double side = (k & 2 ? .5 : -.5) * times_across * row->width;
    if (!rc_dash_px(ground, exponent, row, t, side, &x, &y, &w)) return (rc_box){0, 0, 0, 0};
    low_x = fmin(low_x, x), high_x = fmax(high_x, x);
    low_y = fmin(low_y, y), high_y = fmax(high_y, y);
  }
  return rc_box_common((rc_box){(int)floor(low_x - margin_px), (int)floor(low_y - margin_px),
                                (int)floor(high_x + margin_px) + 2,
                                (int)floor(high_y + margin_px) + 2},
                       within);
}

/* Whether a place, x, y in px of the finest level, is part of a row's n-th or lies beside it. */
static bool lies_in(const rc_ground *ground, const rc_dash_row *row, int n, double x, double y,
                    double times, double margin_px) {
  double u, v, w, dash_x, dash_y;
  if (!rc_ground_place(ground, 0, x, y, &u, &v, &w)) return false;
  double t = rc_dash_along(row, u, v), side = rc_dash_across(row, u, v);
  double most_side = .5 * times * row->width, most_off = .5 * times * row->length;
  /* The dash's place that is next to it. */
  double due = rc_dash_place(row, n);
  t = fmin(fmax(t, due - most_off), due + most_off);
  side = fmin(fmax(side, -most_side), most_side);
  return rc_dash_px(ground, 0, row, t, side, &dash_x, &dash_y, &w) &&
         (x - dash_x) * (x - dash_x) + (y - dash_y) * (y - dash_y) <= margin_px * margin_px;
}

static void take(const rc_ground *ground, const rc_dash_row *row, int n, int exponent,
                 const rc_mask *flags) {
  double unit = (double)(1 << exponent), margin_px = fmax(MARGIN_PX, LEAST_MARGIN_PX * unit);
  rc_box all = {0, 0, flags->width, flags->height};
  rc_box box = rc_dash_box(ground, row, n, exponent, 1, 1, margin_px / unit, all);
  for (int y = box.y0; y < box.y1; y++)
    for (int x = box.x0; x < box.x1; x++)
      if (lies_in(ground, row, n, (x + .5) * unit - .5, (y + .5) * unit - .5, 1, margin_px))
        *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
}

void rc_dash_rows_take(const rc_dash_rows *rows, int exponent, const rc_mask *flags) {
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *row = &rows->rows[i];
    for (int n = row->low; n <= row->high; n++) take(&rows->ground, row, n, exponent, flags);
  }
  for (int i = 0; i < rows->alike_count; i++) {
    rc_dash_row row = rc_dash_row_like(&rows->alike[i], &rows->alike[i]);
    take(&rows->ground, &row, 0, exponent, flags);
  }
}

rc_box rc_dash_laid_box(const rc_ground *ground, const rc_dash_row *row, const rc_dash_laid *laid,
                        rc_box within) {
  return rc_dash_box(ground, row, laid->number, 0, RC_DASH_TIMES_LAID, RC_DASH_TIMES_LAID,
                     MARGIN_PX, within);
}

/* Where what is laid at a place along a row comes from. A rest is laid from the end that is due
 * backwards, for only so the paint ends as it does where it is seen; and its farther half to and
 * fro where it is shorter than what is hidden. */
static double come_from(const rc_dash_row *row, const rc_dash_laid *laid, double along) {
  double from_end = .5 * row->length - along, half = .5 * laid->rest;
  if (from_end > half) from_end = half + fabs(remainder(from_end - half, 2 * half));
  return from_end - .5 * row->length;
}

bool rc_dash_laid_copy(const rc_ground *ground, const rc_dash_row *row, const rc_dash_laid *laid,
                       const rc_chart *chart, float x, float y, rc_copy *copy) {
  double at_x = (double)x + ground->x0, at_y = (double)y + ground->y0, from_x, from_y, u, v, w;
  if (!lies_in(ground, row, laid->number, at_x, at_y, RC_DASH_TIMES_LAID, MARGIN_PX) ||
      !rc_ground_place(ground, 0, at_x, at_y, &u, &v, &w))
    return false;
  if (laid->rest > 0) {
    double along = rc_dash_along(row, u, v), by = come_from(row, laid, along) - along;
    u += by * row->a, v += by * row->b;
  } else {
    double t = rc_dash_place(row, laid->number);
    u += laid->u - row->u - t * row->a, v += laid->v - row->v - t * row->b;
  }
  if (!rc_ground_px(ground, 0, u, v, &from_x, &from_y, &w)) return false;
  *copy = rc_copy_exact(chart, x, y, (float)(from_x - ground->x0), (float)(from_y - ground->y0));
  return true;
}

void rc_dash_rows_drop_lines(const rc_dash_rows *rows, rc_crossing *lines, int *count) {
  int kept = 0;
  for (int i = 0; i < *count; i++) {
    bool is_row = false;
    for (int k = 0; k < rows->count; k++) {
      const rc_dash_row *row = &rows->rows[k];
      double u[2], v[2], w[2];
      is_row |= rc_ground_place(&rows->ground, 0, (double)lines[i].ax, (double)lines[i].ay, &u[0],
                                &v[0], &w[0]) &&
                rc_ground_place(&rows->ground, 0, (double)lines[i].bx, (double)lines[i].by, &u[1],
                                &v[1], &w[1]) &&
                fabs(rc_dash_across(row, u[0], v[0])) < row->width + MARGIN_PX / w[0] &&
                fabs(rc_dash_across(row, u[1], v[1])) < row->width + MARGIN_PX / w[1];
    }
    if (!is_row) lines[kept++] = lines[i];
  }
  *count = kept;
}
