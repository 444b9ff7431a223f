#include <math.h>

#include "synthesis/structure/dash_row.h"
#include "synthesis/structure/dash_rows.h"

/* A dash is laid so many times as wide and long as it is, and so many px of the finest level (at
 * least of the own level) more on each side: the join needs it. It is taken as it is, and as many
 * more. */
#define TIMES_LAID 1.3
#define MARGIN_PX 4.
#define LEAST_MARGIN_PX 1.

/* Which of a row's dashes a place, x, y in px of the finest level, is part of or lies beside.
 * False: none. */
static bool lies_in(const rc_ground *ground, const rc_dash_row *row, double x, double y,
                    double times, double margin_px, int *n) {
  double u, v, w, dash_x, dash_y;
  if (!rc_ground_place(ground, 0, x, y, &u, &v, &w)) return false;
  double t = rc_dash_along(row, u, v), side = rc_dash_across(row, u, v);
  double most_side = .5 * times * row->width, most_off = .5 * times * row->length;
  *n = rc_dash_number(row, t);
  if (*n < row->low || *n > row->high || side > most_side + row->length) return false;
  /* The dash's place that is next to it. */
  double due = rc_dash_place(row, *n),
         sign = (v - row->v) * row->a < (u - row->u) * row->b ? -1 : 1;
  t = fmin(fmax(t, due - most_off), due + most_off), side = sign * fmin(side, most_side);
  return rc_ground_px(ground, 0, row->u + t * row->a - side * row->b,
                      row->v + t * row->b + side * row->a, &dash_x, &dash_y, &w) &&
         hypot(x - dash_x, y - dash_y) <= margin_px;
}

static const rc_dash_laid *find_laid(const rc_dash_row *row, int n) {
  for (int i = 0; i < row->laid_count; i++)
    if (row->laid[i].number == n) return &row->laid[i];
  return NULL;
}

/* Wholly or in part. */
static bool is_seen(const rc_dash_row *row, int n) {
  for (int i = 0; i < row->seen_count; i++)
    if (row->seen[i] == n) return true;
  return find_laid(row, n) != NULL;
}

void rc_dash_rows_take(const rc_dash_rows *rows, int exponent, const rc_mask *flags) {
  double unit = (double)(1 << exponent), margin_px = fmax(MARGIN_PX, LEAST_MARGIN_PX * unit);
  int n;
  for (int y = 0; y < flags->height && rows->count; y++)
    for (int x = 0; x < flags->width; x++)
      for (int i = 0; i < rows->count && *rc_flag(flags, x, y) & RC_SOURCE; i++)
        if (lies_in(&rows->ground, &rows->rows[i], (x + .5) * unit - .5, (y + .5) * unit - .5, 1,
                    margin_px, &n) &&
            is_seen(&rows->rows[i], n))
          *rc_flag(flags, x, y) &= (uint8_t)~RC_SOURCE;
}

bool rc_dash_rows_copy(const rc_dash_rows *rows, const rc_chart *chart, float x, float y,
                       rc_copy *copy) {
  const rc_ground *ground = &rows->ground;
  double at_x = (double)x + ground->x0, at_y = (double)y + ground->y0, from_x, from_y, u, v, w;
  int n;
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *row = &rows->rows[i];
    if (!lies_in(ground, row, at_x, at_y, TIMES_LAID, MARGIN_PX, &n)) continue;
    const rc_dash_laid *laid = find_laid(row, n);
    if (!laid || !rc_ground_place(ground, 0, at_x, at_y, &u, &v, &w)) continue;
    double t = rc_dash_place(row, n);
    u += laid->u - row->u - t * row->a, v += laid->v - row->v - t * row->b;
    if (!rc_ground_px(ground, 0, u, v, &from_x, &from_y, &w)) return false;
    *copy = rc_copy_exact(chart, x, y, (float)(from_x - ground->x0), (float)(from_y - ground->y0));
    return true;
  }
  return false;
}

void rc_dash_rows_drop_lines(const rc_dash_rows *rows, rc_crossing lines[RC_MOST_LINES],
                             int *count) {
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
                rc_dash_across(row, u[0], v[0]) < row->width + MARGIN_PX / w[0] &&
                rc_dash_across(row, u[1], v[1]) < row->width + MARGIN_PX / w[1];
    }
    if (!is_row) lines[kept++] = lines[i];
  }
  *count = kept;
}
