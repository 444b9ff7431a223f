#include "synthesis/structure/moves.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "base/real.h"
#include "synthesis/structure/profile.h"

#define TRIES (8 * RC_MOVES_POINTS)
#define WIDEST_RATIO 2.f
#define STANDS_OUT .1 /* the brightest and the darkest of all points */

static rc_box near(const rc_mask *flags) {
  rc_box hole = rc_box_of(flags, RC_TARGET);
  return rc_box_grown(hole, rc_longer_side(hole) / 2, flags->width, flags->height);
}

recede_status rc_moves_set(rc_context *context, const rc_image *image, const rc_mask *flags,
                           rc_chart chart, bool near_hole, const rc_boundary *beside, rc_moves *m) {
  rc_box box = rc_box_of(flags, RC_SOURCE); /* they may be few, of a large picture */
  if (near_hole) box = rc_box_common(box, near(flags));
  m->chart = rc_chart_flat(chart), m->most_change = INFINITY, m->count = 0;
  RC_TRY(rc_see(context, image, flags, rc_brightness_axis(image), &m->picture));
  if (box.x1 <= box.x0 || box.y1 <= box.y0) return RECEDE_OK;
  for (uint32_t n = 0; n < TRIES && m->count < RC_MOVES_POINTS; n++) {
    uint64_t bits = rc_random(rc_key(0, 97, 0), n, 0, 0);
    int x = box.x0 + (int)rc_below((uint32_t)bits, (uint32_t)(box.x1 - box.x0));
    int y = box.y0 + (int)rc_below((uint32_t)(bits >> 32), (uint32_t)(box.y1 - box.y0));
    float px = (float)x - chart.x0, py = (float)y - chart.y0,
          w = 1.f + chart.lx * px + chart.ly * py;
    if (beside && !(beside->nx * px + beside->ny * py + beside->at > 0)) continue;
    if (*rc_flag(flags, x, y) & RC_SOURCE && w > 1 / WIDEST_RATIO && w < WIDEST_RATIO)
      m->points[m->count++] = y * image->width + x;
  }
  return rc_poll(context);
}

float rc_moves_change_of(const rc_moves *m, int point, float a, float b) {
  rc_ruler ruler = {.picture = &m->picture};
  int width = m->picture.flags->width, x = m->points[point] % width, y = m->points[point] / width;
  float there, here = m->picture.value[m->points[point]];
  rc_place place =
      rc_copy_place(&m->chart, (rc_copy){a, b, 0}, (float)x - m->chart.x0, (float)y - m->chart.y0);
  if (place.beyond || !(place.ratio < WIDEST_RATIO && place.ratio > 1 / WIDEST_RATIO) ||
      !rc_ruler_sample(&ruler, place.x + m->chart.x0, place.y + m->chart.y0, &there))
    return NAN;
  return fminf((there - here) * (there - here), (float)m->most_change);
}

void rc_moves_look(const rc_moves *m, float a, float b, rc_change_sum *sum) {
  for (int i = 0; i < m->count; i++) {
    float change = rc_moves_change_of(m, i, a, b);
    if (isnan(change)) continue;
    sum->squares += change;
    sum->seen++;
  }
}

double rc_moves_mean(const rc_change_sum *sum) {
  return sum->seen < RC_MOVES_LEAST_SEEN ? INFINITY : sum->squares / sum->seen;
}

double rc_moves_along(const rc_moves *m, float a, float b, float px) {
  rc_change_sum sum = {0, 0};
  rc_moves_look(m, px * a, px * b, &sum);
  return rc_moves_mean(&sum);
}

double rc_moves_across(const rc_moves *m, float a, float b, float px) {
  return rc_moves_along(m, -b, a, px);
}

double rc_moves_usual_change(const rc_moves *m) {
  float values[RC_MOVES_POINTS] = {0};
  for (int i = 0; i < m->count; i++) values[i] = m->picture.value[m->points[i]];
  qsort(values, (size_t)m->count, sizeof *values, rc_by_value);
  int end = (int)(STANDS_OUT * m->count);
  double all = m->count ? values[m->count - 1 - end] - values[end] : 0;
  return all > 0 ? all * all : INFINITY;
}
