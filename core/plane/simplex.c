#include "plane/simplex.h"

#include <math.h>

static rc_point try_point(rc_cost *cost, void *user, double x, double y) {
  return (rc_point){x, y, cost(user, x, y)};
}

static void sort3(rc_point p[3]) {
  for (int i = 1; i < 3; i++)
    for (int j = i; j > 0 && p[j].cost < p[j - 1].cost; j--) {
      rc_point held = p[j];
      p[j] = p[j - 1];
      p[j - 1] = held;
    }
}

/* Replaces the worst, p[2], by a better point along the line through the middle of the others, or
 * shrinks the triangle towards the best. */
static void step(rc_cost *cost, void *user, rc_point p[3]) {
  double mx = (p[0].x + p[1].x) / 2, my = (p[0].y + p[1].y) / 2, dx = p[2].x - mx, dy = p[2].y - my;
  rc_point tried = try_point(cost, user, mx - dx, my - dy);
  if (tried.cost < p[0].cost) {
    rc_point further = try_point(cost, user, mx - 2 * dx, my - 2 * dy);
    p[2] = further.cost < tried.cost ? further : tried;
    return;
  }
  if (tried.cost < p[1].cost) {
    p[2] = tried;
    return;
  }
  double side = tried.cost < p[2].cost ? -.5 : .5;
  rc_point inner = try_point(cost, user, mx + side * dx, my + side * dy);
  if (inner.cost < fmin(tried.cost, p[2].cost)) {
    p[2] = inner;
    return;
  }
  for (int i = 1; i < 3; i++)
    p[i] = try_point(cost, user, (p[0].x + p[i].x) / 2, (p[0].y + p[i].y) / 2);
}

rc_point rc_simplex(rc_cost *cost, void *user, double x, double y, double size, double tolerance,
                    int steps) {
  rc_point p[3] = {try_point(cost, user, x, y), try_point(cost, user, x + size, y),
                   try_point(cost, user, x, y + size)};
  for (int i = 0; i < steps; i++) {
    sort3(p);
    if (fabs(p[2].x - p[0].x) + fabs(p[2].y - p[0].y) < tolerance) break;
    step(cost, user, p);
  }
  sort3(p);
  return p[0];
}

void rc_points_to_front(rc_point *points, int count, int front) {
  for (int i = 0; i < front; i++)
    for (int j = i + 1; j < count; j++)
      if (points[j].cost < points[i].cost) {
        rc_point held = points[j];
        points[j] = points[i];
        points[i] = held;
      }
}
