/* Nelder and Mead's simplex in two dimensions: needs no derivatives of what it minimises. */
#ifndef RECEDE_PLANE_SIMPLEX_H
#define RECEDE_PLANE_SIMPLEX_H

typedef struct rc_point {
  double x, y, cost;
} rc_point;

typedef double rc_cost(void *user, double x, double y);

/* The best point found from (x, y) in at most steps steps; size: of the first triangle. Stops when
 * the triangle is smaller than tolerance. */
rc_point rc_simplex(rc_cost *cost, void *user, double x, double y, double size, double tolerance,
                    int steps);

/* Sorts the front cheapest of count points before the others. */
void rc_points_to_front(rc_point *points, int count, int front);

#endif
