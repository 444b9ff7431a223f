#include "synthesis/structure/plan.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Nearer to the horizon a pixel is thousands of px long in the plane, and says nothing of a cell.
 */
#define LEAST_W .02f
#define BOXES 3

static bool in_plane(const rc_chart *chart, int exponent, int x, int y, float *u, float *v) {
  float px = (float)x - chart->x0, py = (float)y - chart->y0, unit = (float)(1 << exponent);
  float w = 1.f + chart->lx * px + chart->ly * py;
  if (!(w > LEAST_W)) return false;
  *u = unit * px / w, *v = unit * py / w;
  return true;
}

bool rc_plan_at(const rc_plan *plan, const rc_chart *chart, int exponent, int x, int y,
                float *column, float *row) {
  float u, v;
  if (!in_plane(chart, exponent, x, y, &u, &v)) return false;
  u = (u - plan->middle_x) / plan->cell, v = (v - plan->middle_y) / plan->cell;
  *column = RC_PLAN_REACH + (u * plan->a + v * plan->b);
  *row = RC_PLAN_REACH + (v * plan->a - u * plan->b);
  return true;
}

recede_status rc_plan_place(rc_context *context, const rc_mask *flags, const rc_chart *chart,
                            int exponent, rc_plan *plan) {
  float low_u = INFINITY, high_u = -INFINITY, low_v = INFINITY, high_v = -INFINITY, u, v;
  for (int y = 0; y < flags->height; y++) {
    for (int x = 0; x < flags->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET) || !in_plane(chart, exponent, x, y, &u, &v))
        continue;
      low_u = fminf(low_u, u), high_u = fmaxf(high_u, u);
      low_v = fminf(low_v, v), high_v = fmaxf(high_v, v);
    }
    RC_TRY(rc_poll(context));
  }
  *plan = (rc_plan){.middle_x = (low_u + high_u) / 2, .middle_y = (low_v + high_v) / 2, .a = 1};
  plan->cell = fmaxf(fmaxf(high_u - low_u, high_v - low_v), 1.f) / RC_PLAN_HOLE;
  return RECEDE_OK;
}

static void add(rc_plan *plan, const rc_image *image, int x, int y, float column, float row) {
  if (!(column > -.5f && row > -.5f && column < RC_PLAN_SIDE - .5f && row < RC_PLAN_SIDE - .5f))
    return;
  float *sums = rc_plan_cell(plan, (int)(column + .5f), (int)(row + .5f));
  for (int k = 0; k < plan->channels; k++) sums[k] += rc_pixel(image, x, y)[k];
  sums[plan->channels]++;
}

recede_status rc_plan_gather(rc_context *context, const rc_image *image, const rc_mask *flags,
                             uint8_t flag, const rc_chart *chart, int exponent, rc_plan *plan) {
  plan->channels = image ? image->channels : 0;
  size_t each = (size_t)plan->channels + 1;
  RC_TRY(RC_NEW_ZERO(context, RC_PLAN_CELLS * each, &plan->sums));
  for (int y = 0; y < flags->height; y++) {
    for (int x = 0; x < flags->width; x++) {
      float column, row;
      if (*rc_flag(flags, x, y) & flag && rc_plan_at(plan, chart, exponent, x, y, &column, &row))
        add(plan, image, x, y, column, row);
    }
    RC_TRY(rc_poll(context));
  }
  for (size_t i = 0; i < RC_PLAN_CELLS * each; i += each) {
    float count = plan->sums[i + each - 1];
    for (size_t k = 0; k < each && count > 0.f; k++) plan->sums[i + k] /= count;
  }
  return rc_poll(context);
}

/* Means over boxes, so many floats to a cell, of a line of cells that are so many floats apart. */
static void smooth_line(const float *from, float *to, size_t step, size_t each, int reach) {
  for (size_t k = 0; k < each; k++) {
    double sum = 0;
    for (int i = 0; i < reach; i++) sum += (double)from[(size_t)i * step + k];
    for (int i = 0; i < RC_PLAN_SIDE; i++) {
      if (i + reach < RC_PLAN_SIDE) sum += (double)from[(size_t)(i + reach) * step + k];
      to[(size_t)i * step + k] = (float)(sum / (2 * reach + 1));
      if (i >= reach) sum -= (double)from[(size_t)(i - reach) * step + k];
    }
  }
}

recede_status rc_plan_smooth(rc_context *context, const rc_plan *plan, int along, int across,
                             rc_plan *smooth) {
  size_t each = (size_t)plan->channels + 1, width = RC_PLAN_SIDE * each;
  float *from, *to;
  RC_TRY(RC_NEW(context, RC_PLAN_CELLS * each, &from));
  RC_TRY(RC_NEW(context, RC_PLAN_CELLS * each, &to));
  memcpy(to, plan->sums, RC_PLAN_CELLS * each * sizeof *to);
  for (int pass = 0; pass < 2 * BOXES; pass++) {
    float *last = to;
    to = from, from = last;
    for (size_t i = 0; i < RC_PLAN_SIDE; i++)
      if (pass < BOXES)
        smooth_line(from + i * width, to + i * width, each, each, along);
      else
        smooth_line(from + i * each, to + i * each, width, each, across);
    RC_TRY(rc_poll(context));
  }
  RC_FREE(context, &from);
  *smooth = *plan, smooth->sums = to;
  return RECEDE_OK;
}
