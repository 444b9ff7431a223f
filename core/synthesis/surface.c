#include "synthesis/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Gradients are gathered over cells this wide: enough of them for one tensor, small enough for one
 * lean. */
#define CELL_PX 24
#define LEAST_FILLED .6
#define LEAST_CELLS 12
/* Root mean square of the plane's lean below which nothing can be told. */
#define LEAST_LEAN .06
/* One contrasty object may not outvote the texture. */
#define MOST_TIMES_MEDIAN 3.0

/* The structure tensor of one cell, p across the tilt and q along it, and the lean that a flat
 * texture would have there. */
typedef struct cell {
  double pp, pq, pixels, lean;
} cell;

typedef struct frame {
  double across_x, across_y, along_x, along_y, steepness;
} frame;

static frame frame_of(const recede_plane *plane) {
  const double *n = plane->normal;
  double sine = hypot(n[0], n[1]);
  if (sine < 1e-9) return (frame){0, 0, 0, 0, 0};
  double dx = -n[0] / sine, dy = -n[1] / sine;
  return (frame){-dy, dx, dx, dy, sine / plane->focal_px};
}

static bool all_source(const rc_mask *flags, int x, int y) {
  return (*rc_flag(flags, x, y) & *rc_flag(flags, x - 1, y) & *rc_flag(flags, x + 1, y) &
          *rc_flag(flags, x, y - 1) & *rc_flag(flags, x, y + 1) & RC_SOURCE) != 0;
}

static void gather(const rc_image *image, const rc_mask *flags, const frame *f, int x0, int y0,
                   cell *c) {
  for (int y = y0 < 1 ? 1 : y0; y < y0 + CELL_PX && y + 1 < image->height; y++)
    for (int x = x0 < 1 ? 1 : x0; x < x0 + CELL_PX && x + 1 < image->width; x++) {
      if (!all_source(flags, x, y)) continue;
      double gx = rc_brightness_at(image, x + 1, y) - rc_brightness_at(image, x - 1, y);
      double gy = rc_brightness_at(image, x, y + 1) - rc_brightness_at(image, x, y - 1);
      double p = gx * f->across_x + gy * f->across_y, q = gx * f->along_x + gy * f->along_y;
      c->pp += p * p, c->pq += p * q, c->pixels++;
    }
}

/* At (p, q) the plane's lines towards the vanishing point have slope dp/dq = -p |l| / w, and
 * gradients across them pq / pp = p |l| / w. */
static bool set_lean(const rc_problem *problem, const frame *f, int exponent, double x, double y,
                     cell *c) {
  const recede_plane *plane = &problem->plane;
  double unit = 1 << exponent;
  double px = problem->origin_x + (x + .5) * unit - .5 - (plane->width - 1) / 2.;
  double py = problem->origin_y + (y + .5) * unit - .5 - (plane->height - 1) / 2.;
  double w = (plane->normal[0] * px + plane->normal[1] * py) / plane->focal_px + plane->normal[2];
  if (w <= 0) return false;
  c->lean = (px * f->across_x + py * f->across_y) * f->steepness / w;
  return fabs(c->lean) < 2;
}

static int by_value(const void *a, const void *b) {
  double p = *(const double *)a, q = *(const double *)b;
  return (p > q) - (p < q);
}

/* Least squares of pq / pp against the plane's lean, with an intercept, weighted by pp; returns the
 * slope and in *error its standard error. */
static double regress(const cell *cells, int count, double cap, double *error) {
  double n = 0, s = 0, r = 0, ss = 0, sr = 0, rr = 0, nn = 0;
  for (int i = 0; i < count; i++) {
    double weight = fmin(cells[i].pp / cells[i].pixels, cap), ratio = cells[i].pq / cells[i].pp;
    n += weight, nn += weight * weight, s += weight * cells[i].lean, r += weight * ratio;
    ss += weight * cells[i].lean * cells[i].lean, sr += weight * cells[i].lean * ratio;
    rr += weight * ratio * ratio;
  }
  double spread = ss / n - s / n * (s / n), shared = sr / n - s / n * (r / n);
  double scatter = rr / n - r / n * (r / n), effective = n * n / nn;
  if (!(spread > LEAST_LEAN * LEAST_LEAN)) return NAN;
  double slope = shared / spread;
  *error = sqrt(fmax(scatter - slope * shared, 0) / (spread * effective));
  return slope;
}

recede_status rc_measure_lean(rc_context *context, const rc_problem *problem, const rc_image *image,
                              const rc_mask *flags, int exponent, double *lean, double *error) {
  frame f = frame_of(&problem->plane);
  int columns = image->width / CELL_PX + 1, rows = image->height / CELL_PX + 1, count = 0;
  cell *cells;
  double *energies;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, columns * rows, &cells));
  RC_TRY(RC_NEW(context, columns * rows, &energies));
  for (int j = 0; j < rows; j++)
    for (int i = 0; i < columns; i++) {
      cell c = {0, 0, 0, 0};
      gather(image, flags, &f, i * CELL_PX, j * CELL_PX, &c);
      if (c.pixels < LEAST_FILLED * CELL_PX * CELL_PX || !(c.pp > 0)) continue;
      if (!set_lean(problem, &f, exponent, (i + .5) * CELL_PX, (j + .5) * CELL_PX, &c)) continue;
      energies[count] = c.pp / c.pixels;
      cells[count++] = c;
    }
  *lean = NAN;
  if (f.steepness > 0 && count >= LEAST_CELLS) {
    qsort(energies, (size_t)count, sizeof *energies, by_value);
    *lean = regress(cells, count, MOST_TIMES_MEDIAN * energies[count / 2], error);
  }
  rc_release(context, mark);
  return rc_poll(context);
}
