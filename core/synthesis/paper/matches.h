/* The nearest-neighbour field: for each output neighbourhood of a grid, its z_p in the exemplar. */
#ifndef RECEDE_SYNTHESIS_PAPER_MATCHES_H
#define RECEDE_SYNTHESIS_PAPER_MATCHES_H

#include "synthesis/paper/neighbourhood.h"

/* Neighbourhoods of width px every step px; the last of a row or column ends with the picture. */
typedef struct rc_grid {
  int width, step, last_x, last_y, columns, rows;
} rc_grid;

typedef struct rc_matches {
  rc_grid grid;
  uint8_t *active;   /* the neighbourhood holds a TARGET pixel */
  rc_corner *corner; /* z_p; none: x < 0 */
  float *distance;   /* ||x_p - z_p||^2 */
  float *weight;     /* W_p, eq. 7; 0 where there is no match */
  float *known;      /* part of the neighbourhood's pixels that are KNOWN: 0..1 */
  int count;         /* active ones */
} rc_matches;

static inline int rc_grid_x(const rc_grid *grid, int column) {
  int x = column * grid->step;
  return x < grid->last_x ? x : grid->last_x;
}
static inline int rc_grid_y(const rc_grid *grid, int row) {
  int y = row * grid->step;
  return y < grid->last_y ? y : grid->last_y;
}

/* Step width / 4 (the baseline's Figure 5), no match anywhere. flags are the output's. */
recede_status rc_matches_new(rc_context *context, const rc_mask *flags, int width,
                             rc_matches *matches);
/* Takes the matches of another grid over: of the same picture (factor 1), or of the coarser pyramid
 * level (factor 2). Each neighbourhood moves with the old one nearest to it; where that leaves the
 * windows, with one beside it, else it has none. */
void rc_matches_take(const rc_matches *old, int factor, const rc_windows *windows,
                     rc_matches *matches);

#endif
