#include "synthesis/structure/ground.h"

#include <math.h>

#define LEAST_W 1e-6
#define FARTHEST_PX 1e6

/* A ray (x, y, f) meets the plane at P = (x, y, f) / w, times its distance. With p = X / w, for
 * which 1 / w = 1 - l . p, and o from the picture's middle to the origin of X, that is P = (p + o
 * (1 - l . p), f (1 - l . p)), linear in p: |dP|^2 = |dp|^2 - 2 (o . dp)(l . dp) + (o . o + f^2)(l
 * . dp)^2. a, b and c are this form's Cholesky factor. */
static void set_metric(rc_ground *g) {
  double square = g->from_x * g->from_x + g->from_y * g->from_y + g->focal_px * g->focal_px;
  double xx = 1 - 2 * g->from_x * g->lx + square * g->lx * g->lx;
  double xy = -g->from_x * g->ly - g->from_y * g->lx + square * g->lx * g->ly;
  double yy = 1 - 2 * g->from_y * g->ly + square * g->ly * g->ly;
  g->a = sqrt(xx), g->b = xy / g->a, g->c = sqrt(fmax(yy - g->b * g->b, 0));
}

rc_ground rc_ground_of(const rc_chart *chart, double from_x, double from_y, double focal_px) {
  rc_ground g = {.lx = (double)chart->lx,
                 .ly = (double)chart->ly,
                 .x0 = (double)chart->x0,
                 .y0 = (double)chart->y0,
                 .from_x = from_x,
                 .from_y = from_y,
                 .focal_px = focal_px};
  set_metric(&g);
  return g;
}

/* w (1 + by t) = 1 + l . X + by (along . M p) w. */
rc_ground rc_ground_turned(const rc_ground *ground, double by, double along_u, double along_v) {
  rc_ground g = *ground;
  g.lx += by * along_u * ground->a;
  g.ly += by * (along_u * ground->b + along_v * ground->c);
  set_metric(&g);
  return g;
}

rc_ground rc_ground_tilted(const rc_ground *ground, double times) {
  rc_ground g = *ground;
  g.lx *= times, g.ly *= times;
  set_metric(&g);
  return g;
}

bool rc_ground_place(const rc_ground *ground, int exponent, double x, double y, double *u,
                     double *v, double *w) {
  double unit = (double)(1 << exponent);
  double px = (x + .5) * unit - .5 - ground->x0, py = (y + .5) * unit - .5 - ground->y0;
  *w = 1 + ground->lx * px + ground->ly * py;
  if (!(*w > LEAST_W)) return false;
  *u = (ground->a * px + ground->b * py) / *w;
  *v = ground->c * py / *w;
  return true;
}

bool rc_ground_px(const rc_ground *ground, int exponent, double u, double v, double *x, double *y,
                  double *w) {
  double unit = (double)(1 << exponent), py = v / ground->c, px = (u - ground->b * py) / ground->a;
  double inverse = 1 - ground->lx * px - ground->ly * py;
  if (!(inverse > LEAST_W)) return false;
  *w = 1 / inverse;
  *x = (px * *w + ground->x0 + .5) / unit - .5;
  *y = (py * *w + ground->y0 + .5) / unit - .5;
  return fabs(*x) < FARTHEST_PX && fabs(*y) < FARTHEST_PX;
}
