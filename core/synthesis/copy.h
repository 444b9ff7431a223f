/* A copy: where the texture at a target point is taken from.
 *
 * Flat: a displacement d IN THE PLANE. With X the position relative to the point where w = 1,
 *   X' = (X + d w) / (1 - (l . d) w),   w(X') = w / (1 - (l . d) w),   w(X) = 1 + l . X
 * so scale, flattening, shear and converging lines come right by themselves.
 * Raised: an upright similarity X' = r X + t of things that stand up from the plane, r the ratio of
 * scales in steps of 2^(1/8), so that neighbours can share it; r = 1 is a move by whole pixels.
 * Along lines both are exact. Near the horizon things that stand hide a plane that is flat: there
 * copies may be raised ones, too. */
#ifndef RECEDE_SYNTHESIS_COPY_H
#define RECEDE_SYNTHESIS_COPY_H

#include <math.h>
#include <stdbool.h>

#include "base/real.h"

typedef struct rc_copy {
  float a, b; /* flat: d; raised: t. px of its level */
  float r;    /* flat: 0; raised: the scale */
} rc_copy;

/* The plane as a level sees it: w = 1 + lx X + ly Y, and which map applies. */
typedef struct rc_chart {
  float lx, ly;
  float x0, y0; /* where X = Y = 0, in the level's px */
  bool raised;
  float standing_w; /* of a flat one: where w is less copies are raised; 0 = nowhere */
} rc_chart;

/* w at a px of the level: 0 and less beyond the horizon. */
static inline float rc_chart_w(const rc_chart *chart, float x, float y) {
  return 1.f + chart->lx * (x - chart->x0) + chart->ly * (y - chart->y0);
}

/* Whether copies are raised at (x, y), relative to the chart's origin. */
static inline bool rc_chart_stands(const rc_chart *chart, float x, float y) {
  return chart->raised || 1.f + chart->lx * x + chart->ly * y < chart->standing_w;
}

/* The same for copies within the plane, as which moves and directions are told. */
static inline rc_chart rc_chart_flat(rc_chart chart) {
  chart.raised = false, chart.standing_w = 0.f;
  return chart;
}

typedef struct rc_place {
  float x, y;     /* source position X', relative like X */
  float ratio;    /* w(X') / w(X): the source's resolution over the target's, across */
  float mismatch; /* ratio over the copy's own scale: 1 for flat copies */
  bool beyond;    /* behind the horizon: the rest is meaningless */
} rc_place;

static inline bool rc_same_copy(rc_copy p, rc_copy q) {
  return (p.a == q.a) & (p.b == q.b) & (p.r == q.r);
}

static inline rc_place rc_copy_place(const rc_chart *chart, rc_copy copy, float x, float y) {
  rc_place place;
  float w = 1.f + chart->lx * x + chart->ly * y;
  if (copy.r > 0.f) {
    place.x = copy.r * x + copy.a;
    place.y = copy.r * y + copy.b;
    float there = 1.f + chart->lx * place.x + chart->ly * place.y;
    place.ratio = there / w;
    place.mismatch = place.ratio / copy.r;
    place.beyond = !(there > 0.f);
    return place;
  }
  float divisor = 1.f - (chart->lx * copy.a + chart->ly * copy.b) * w;
  place.ratio = 1.f / divisor;
  place.x = (x + copy.a * w) * place.ratio;
  place.y = (y + copy.b * w) * place.ratio;
  place.mismatch = 1.f;
  place.beyond = !(divisor > 1e-3f);
  return place;
}

/* dX'/dX at a place, row by row: (xx, xy; yx, yy). */
static inline void rc_copy_jacobian(const rc_chart *chart, rc_copy copy, const rc_place *place,
                                    float jacobian[4]) {
  if (copy.r > 0.f) {
    jacobian[0] = jacobian[3] = copy.r;
    jacobian[1] = jacobian[2] = 0.f;
    return;
  }
  float e = chart->lx * copy.a + chart->ly * copy.b;
  float gx = copy.a + e * place->x, gy = copy.b + e * place->y;
  jacobian[0] = (1.f + gx * chart->lx) * place->ratio;
  jacobian[1] = gx * chart->ly * place->ratio;
  jacobian[2] = gy * chart->lx * place->ratio;
  jacobian[3] = (1.f + gy * chart->ly) * place->ratio;
}

/* rc_exp2(eighths / 8) from its own values for -4 .. 4. */
static inline float rc_exp2_eighths(int eighths) {
  static const float parts[9] = {0x1.6a09e6p-1f, 0x1.8ace54p-1f, 0x1.ae89fap-1f,
                                 0x1.d5818ep-1f, 0x1p+0f,        0x1.172b84p+0f,
                                 0x1.306fep+0f,  0x1.4bfdaep+0f, 0x1.6a09e6p+0f};
  if (eighths < -800 || eighths > 800) return rc_exp2((float)eighths / 8.f);
  int whole = (eighths < 0 ? eighths - 4 : eighths + 4) / 8;
  uint32_t bits = (uint32_t)(whole + 127) << 23;
  float power;
  memcpy(&power, &bits, 4);
  return parts[eighths - 8 * whole + 4] * power;
}

/* Eighth-octave steps: 4.4 % off at the most, below what the eye takes for another size. */
static inline float rc_scale_step(float ratio) {
  bool same = ratio > .957f && ratio < 1.045f;
  return same ? 1.f : rc_exp2_eighths((int)rc_round(8.f * rc_log2(ratio)));
}

/* The copy that takes target (x, y) from source (to_x, to_y), all relative to the chart's origin.
 */
static inline rc_copy rc_copy_between(const rc_chart *chart, float x, float y, float to_x,
                                      float to_y) {
  float w = 1.f + chart->lx * x + chart->ly * y;
  float there = 1.f + chart->lx * to_x + chart->ly * to_y;
  if (!chart->raised && !(w < chart->standing_w))
    return (rc_copy){to_x / there - x / w, to_y / there - y / w, 0.f};
  float r = rc_scale_step(there / w);
  if (r == 1.f) return (rc_copy){rc_round(to_x - x), rc_round(to_y - y), 1.f};
  return (rc_copy){to_x - r * x, to_y - r * y, r};
}

/* The same without steps of scale or whole pixels: for lines, that would get steps by them. A
 * raised copy of this scale keeps each line through the vanishing point of the move where it is. */
static inline rc_copy rc_copy_exact(const rc_chart *chart, float x, float y, float to_x,
                                    float to_y) {
  rc_chart flat = rc_chart_flat(*chart);
  if (!chart->raised) return rc_copy_between(&flat, x, y, to_x, to_y);
  float r = (1.f + chart->lx * to_x + chart->ly * to_y) / (1.f + chart->lx * x + chart->ly * y);
  return (rc_copy){to_x - r * x, to_y - r * y, r};
}

/* The same copy one pyramid level finer. */
static inline rc_copy rc_copy_finer(rc_copy copy) {
  return (rc_copy){2.f * copy.a, 2.f * copy.b, copy.r};
}

/* The same plane seen by a level 2^exponent times coarser. */
static inline rc_chart rc_chart_coarser(rc_chart chart, int exponent) {
  float unit = (float)(1 << exponent);
  chart.lx *= unit, chart.ly *= unit;
  chart.x0 = (chart.x0 + .5f) / unit - .5f;
  chart.y0 = (chart.y0 + .5f) / unit - .5f;
  return chart;
}

#endif
