/* The cheapest cut through a grid of pixels that are joined to their four neighbours and to two
 * ends, source and sink (Boykov and Kolmogorov 2004: trees grow from both ends, and what an
 * augmentation breaks off is adopted again). */
#ifndef RECEDE_SYNTHESIS_SEARCH_MINCUT_H
#define RECEDE_SYNTHESIS_SEARCH_MINCUT_H

#include "base/context.h"

typedef struct rc_cut_grid {
  int width, height;  /* a frame of 1 px around it must have no capacities */
  int32_t *end;       /* > 0: capacity from the source, < 0: to the sink; what is left of it */
  int32_t *beside[4]; /* capacities to the pixel at the left, right, above, below; what is left */
  /* Scratch. */
  uint8_t *tree;
  int8_t *parent;
  int32_t *next, *distance, *time;
} rc_cut_grid;

recede_status rc_grid_new(rc_context *context, int width, int height, rc_cut_grid *grid);
/* at_sink: pixels that the cut leaves on the sink's side. */
recede_status rc_grid_cut(rc_context *context, rc_cut_grid *grid, uint8_t *at_sink);

#endif
