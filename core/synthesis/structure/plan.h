/* A plan: the plane from above, in square cells around the hole. Each cell holds sums of what the
 * picture shows there, and how much that counts. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_PLAN_H
#define RECEDE_SYNTHESIS_STRUCTURE_PLAN_H

#include "image/image.h"
#include "synthesis/copy.h"

/* So many cells are the hole's longer side, and a plan reaches as far to each side of its middle.
 */
#define RC_PLAN_HOLE 64
#define RC_PLAN_REACH 102
#define RC_PLAN_SIDE (2 * RC_PLAN_REACH + 1)
#define RC_PLAN_CELLS (RC_PLAN_SIDE * RC_PLAN_SIDE)

typedef struct rc_plan {
  float middle_x, middle_y; /* in the plane, px where w = 1 of the finest level */
  float cell;               /* the same px */
  float a, b;               /* a unit vector: the direction of its rows */
  int channels;
  float *sums; /* of each cell, row by row: channels sums and their weight */
} rc_plan;

static inline float *rc_plan_cell(const rc_plan *plan, int column, int row) {
  return plan->sums + ((size_t)row * RC_PLAN_SIDE + (size_t)column) * (size_t)(plan->channels + 1);
}
/* Where in the plan, in cells, pixel (x, y) of a level lies. False: beyond the horizon. */
bool rc_plan_at(const rc_plan *plan, const rc_chart *chart, int exponent, int x, int y,
                float *column, float *row);
/* Around the target of a level, rows to the right; sums is NULL. chart: of that level. */
recede_status rc_plan_place(rc_context *context, const rc_mask *flags, const rc_chart *chart,
                            int exponent, rc_plan *plan);
/* Sums a level's pixels that have the flag, and divides by their number: weights are 1 or 0. An
 * image of NULL: there is only the weight. */
recede_status rc_plan_gather(rc_context *context, const rc_image *image, const rc_mask *flags,
                             uint8_t flag, const rc_chart *chart, int exponent, rc_plan *plan);
/* Sums and weights, smoothed by three boxes that reach so many cells: almost a Gaussian of that
 * standard deviation. */
recede_status rc_plan_smooth(rc_context *context, const rc_plan *plan, int along, int across,
                             rc_plan *smooth);

#endif
