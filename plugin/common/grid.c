/* A plane drawn as one sees it. */
#include "grid.h"

#include <math.h>

#define CELL .06       /* a square's width at the hole, of the image's long side */
#define REACH 24       /* squares drawn to each side, and towards the viewer */
#define REACH_FAR 120  /* and towards the horizon */
#define FAR 1e6        /* squares, of a line that goes on to the vanishing point */
#define DENSEST_PX 4   /* lines closer than this on the screen are left out */
#define NEAREST_W 1e-3 /* of w at the hole: nothing is drawn nearer to the horizon */
#define MARGIN .06     /* around the image, as far as handles are shown */

/* The unit square's image: square (u, v) -> image, homogeneous. */
typedef struct {
  double m[3][3];
  double width, height; /* of the image: lines are cut off there */
} homography;

/* q: the images of (0,0), (1,0), (1,1), (0,1). */
static homography from_quad(const recede_plane *plane, const double q[8]) {
  double dx1 = q[2] - q[4], dx2 = q[6] - q[4], sx = q[0] - q[2] + q[4] - q[6];
  double dy1 = q[3] - q[5], dy2 = q[7] - q[5], sy = q[1] - q[3] + q[5] - q[7];
  double determinant = dx1 * dy2 - dx2 * dy1;
  double g = (sx * dy2 - dx2 * sy) / determinant, h = (dx1 * sy - sx * dy1) / determinant;
  return (homography){{{q[2] - q[0] + g * q[2], q[6] - q[0] + h * q[6], q[0]},
                       {q[3] - q[1] + g * q[3], q[7] - q[1] + h * q[7], q[1]},
                       {g, h, 1}},
                      plane->width,
                      plane->height};
}

static double depth(const homography *h, double u, double v) {
  return h->m[2][0] * u + h->m[2][1] * v + h->m[2][2];
}

static void project(const homography *h, double u, double v, double *x, double *y) {
  double w = depth(h, u, v);
  *x = (h->m[0][0] * u + h->m[0][1] * v + h->m[0][2]) / w;
  *y = (h->m[1][0] * u + h->m[1][1] * v + h->m[1][2]) / w;
}

/* The part of a line that lies within low..high, as shares of it. FALSE: nothing. */
static gboolean clip(const double at[2], const double step[2], const double low[2],
                     const double high[2], double *t0, double *t1) {
  for (int i = 0; i < 2; i++) {
    if (fabs(step[i]) < 1e-12) {
      if (at[i] < low[i] || at[i] > high[i]) return FALSE;
      continue;
    }
    double a = (low[i] - at[i]) / step[i], b = (high[i] - at[i]) / step[i];
    *t0 = fmax(*t0, fmin(a, b)), *t1 = fmin(*t1, fmax(a, b));
  }
  return *t0 < *t1;
}

/* Cairo's coordinates overflow far outside the picture, and then it draws nothing. */
static void clipped_line(cairo_t *cairo, const homography *h, double x0, double y0, double x1,
                         double y1) {
  double at[2] = {x0, y0}, step[2] = {x1 - x0, y1 - y0}, t0 = 0, t1 = 1;
  double low[2] = {-.5, -.5}, high[2] = {h->width - .5, h->height - .5};
  if (!clip(at, step, low, high, &t0, &t1)) return;
  cairo_move_to(cairo, x0 + t0 * step[0], y0 + t0 * step[1]);
  cairo_line_to(cairo, x0 + t1 * step[0], y0 + t1 * step[1]);
}

/* A straight line on the plane, cut off where it would come too near the horizon. */
static void line(cairo_t *cairo, const homography *h, double u0, double v0, double u1, double v1) {
  double w0 = depth(h, u0, v0), w1 = depth(h, u1, v1), t0 = 0, t1 = 1, x0, y0, x1, y1;
  if (w0 < NEAREST_W && w1 < NEAREST_W) return;
  if (w0 < NEAREST_W) t0 = (NEAREST_W - w0) / (w1 - w0);
  if (w1 < NEAREST_W) t1 = (NEAREST_W - w0) / (w1 - w0);
  project(h, u0 + (u1 - u0) * t0, v0 + (v1 - v0) * t0, &x0, &y0);
  project(h, u0 + (u1 - u0) * t1, v0 + (v1 - v0) * t1, &x1, &y1);
  clipped_line(cairo, h, x0, y0, x1, y1);
}

/* Lines across, from the hole outwards, until they crowd; returns how far they went. */
static int lines_across(cairo_t *cairo, const homography *h, int step, int last, double zoom) {
  double x, y, before_x, before_y;
  project(h, .5, 0, &before_x, &before_y);
  for (int v = step; v != last; v += step) {
    if (depth(h, .5, v) < NEAREST_W) return v - step;
    project(h, .5, v, &x, &y);
    if (hypot(x - before_x, y - before_y) * zoom < DENSEST_PX) return v - step;
    line(cairo, h, -REACH, v, REACH, v);
    before_x = x, before_y = y;
  }
  return last;
}

static void stroke_twice(cairo_t *cairo, double zoom, double red, double green, double blue,
                         double width) {
  cairo_set_line_width(cairo, (width + 1.5) / zoom);
  cairo_set_source_rgba(cairo, 0, 0, 0, .35);
  cairo_stroke_preserve(cairo);
  cairo_set_line_width(cairo, width / zoom);
  cairo_set_source_rgba(cairo, red, green, blue, .85);
  cairo_stroke(cairo);
}

static void squares(cairo_t *cairo, const homography *h, double zoom) {
  line(cairo, h, -REACH, 0, REACH, 0);
  int up = lines_across(cairo, h, 1, REACH_FAR, zoom);
  int down = lines_across(cairo, h, -1, -REACH_FAR, zoom);
  for (int u = -REACH; u <= REACH; u++) {
    gboolean on = u % 4 == 0; /* some go on to the vanishing point */
    line(cairo, h, u, on ? -FAR : down, u, on ? FAR : up);
  }
  stroke_twice(cairo, zoom, .3, 1, 1, 1);
}

/* The middle square filled, with an arrow to where the plane recedes. */
static void arrow(const recede_plane *plane, cairo_t *cairo, const homography *h, double zoom) {
  double x0, y0, x1, y1, slant_deg, tilt_deg, fov_deg;
  recede_plane_angles(plane, &slant_deg, &tilt_deg, &fov_deg);
  if (slant_deg < .5) return;
  project(h, .5, .5, &x0, &y0);
  double tilt = tilt_deg * G_PI / 180, length = 46 / zoom, head = 11 / zoom;
  x1 = x0 + length * sin(tilt), y1 = y0 - length * cos(tilt);
  cairo_move_to(cairo, x0, y0);
  cairo_line_to(cairo, x1, y1);
  for (int side = -1; side <= 1; side += 2) {
    double turn = tilt + side * .45;
    cairo_move_to(cairo, x1, y1);
    cairo_line_to(cairo, x1 - head * sin(turn), y1 + head * cos(turn));
  }
  stroke_twice(cairo, zoom, 1, .85, .1, 3);
}

gboolean rp_grid_horizon(const recede_plane *plane, double ends[4]) {
  double line_ends[4], t0 = -1e6, t1 = 1e6;
  if (!recede_plane_horizon(plane, line_ends)) return FALSE;
  double x = line_ends[0], y = line_ends[1], dx = line_ends[2] - x, dy = line_ends[3] - y;
  double margin = MARGIN * fmax(plane->width, plane->height);
  double low[2] = {-margin, -margin}, high[2] = {plane->width + margin, plane->height + margin};
  double at[2] = {x, y}, step[2] = {dx, dy};
  if (!clip(at, step, low, high, &t0, &t1)) return FALSE;
  ends[0] = x + t0 * dx, ends[1] = y + t0 * dy;
  ends[2] = x + t1 * dx, ends[3] = y + t1 * dy;
  return TRUE;
}

static void horizon(const recede_plane *plane, cairo_t *cairo, double zoom) {
  double ends[4];
  if (!rp_grid_horizon(plane, ends)) return;
  cairo_move_to(cairo, ends[0], ends[1]);
  cairo_line_to(cairo, ends[2], ends[3]);
  stroke_twice(cairo, zoom, 1, .25, .2, 2);
}

void rp_grid_draw(const recede_plane *plane, cairo_t *cairo, double x, double y, double zoom,
                  gboolean with_squares) {
  double quad[8], size = CELL * fmax(plane->width, plane->height);
  for (int tries = 0; tries < 6; tries++, size /= 2) {
    if (!recede_plane_quad(plane, x, y, size, quad)) continue; /* it reaches the horizon */
    homography h = from_quad(plane, quad);
    if (with_squares) squares(cairo, &h, zoom);
    arrow(plane, cairo, &h, zoom);
    break;
  }
  horizon(plane, cairo, zoom);
}
