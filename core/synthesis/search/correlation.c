#include "synthesis/search/correlation.h"

#include <math.h>
#include <stdlib.h>

#include "base/four.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/real.h"

/* Nearer ones are the texture's own correlation length. */
#define LEAST_LAG_PX 3
/* A lag that fewer of the points share tells nothing. */
#define LEAST_SHARED .25
#define LEAST_PEAK .12f

/* Displacements are asked four at a time, as vectors. */
typedef double four_sums __attribute__((vector_size(4 * sizeof(double))));

/* The points, as displacements are tried at them: relative to the chart's origin. */
typedef struct probes {
  const rc_correlation *c;
  const float *x, *y, *w, *own;
  const float *known; /* the trait of each pixel; NAN: no source */
} probes;

static double correlation_of(double n, double a, double b, double aa, double bb, double ab) {
  double spread = (aa - a * a / n) * (bb - b * b / n);
  return n > 0 && spread > 0 ? (ab - a * b / n) / sqrt(spread) : 0;
}

/* What the sources show that the displacements (dx .. dx + 3, dy) take a point to; NAN: none. */
static rc_four taken(const probes *p, int i, rc_four dx, float dy) {
  const rc_level *level = p->c->level;
  const rc_chart *flat = &p->c->flat;
  float w = p->w[i], x = p->x[i], y = p->y[i];
  /* As rc_copy_place and rc_place_at. */
  rc_four ratio = 1.f / (1.f - (flat->lx * dx + flat->ly * dy) * w);
  rc_four to_x = (x + dx * w) * ratio + flat->x0 + .5f;
  rc_four to_y = (y + dy * w) * ratio + flat->y0 + .5f;
  rc_four_ints may = (ratio > .5f) & (ratio < 2.f) & (to_x >= 0.f) & (to_y >= 0.f) &
                     (to_x < (float)level->width) & (to_y < (float)level->height);
  rc_four_ints px = __builtin_convertvector(rc_select(may, to_x, (rc_four){0}), rc_four_ints);
  rc_four_ints py = __builtin_convertvector(rc_select(may, to_y, (rc_four){0}), rc_four_ints);
  rc_four value = {0};
  for (int k = 0; k < 4; k++)
    value[k] = p->known[(size_t)py[k] * (size_t)level->width + (size_t)px[k]];
  return rc_select(may, value, (rc_four){NAN, NAN, NAN, NAN});
}

static void correlate_four(const probes *p, int dx, int dy, float value[4]) {
  four_sums n = {0}, a = {0}, b = {0}, aa = {0}, bb = {0}, ab = {0};
  const rc_four by = {(float)dx, (float)(dx + 1), (float)(dx + 2), (float)(dx + 3)};
  for (int i = 0; i < p->c->count; i++) {
    rc_four to = taken(p, i, by, (float)dy), own = {p->own[i], p->own[i], p->own[i], p->own[i]};
    rc_four_ints seen = to == to;
    four_sums one =
        __builtin_convertvector(rc_select(seen, (rc_four){1, 1, 1, 1}, (rc_four){0}), four_sums);
    four_sums va = __builtin_convertvector(rc_select(seen, own, (rc_four){0}), four_sums);
    four_sums vb = __builtin_convertvector(rc_select(seen, to, (rc_four){0}), four_sums);
    n += one, a += va, b += vb, aa += va * va, bb += vb * vb, ab += va * vb;
  }
  for (int k = 0; k < 4; k++)
    value[k] = n[k] >= LEAST_SHARED * p->c->count
                   ? (float)correlation_of(n[k], a[k], b[k], aa[k], bb[k], ab[k])
                   : RC_NOT_KNOWN;
}

static void correlate_row(void *user, int dy, int thread) {
  const probes *p = user;
  int lag = p->c->lag, width = 2 * lag + 1;
  float *row = p->c->value + (size_t)dy * (size_t)width, value[4];
  (void)thread;
  for (int i = 0; i < width; i += 4) {
    correlate_four(p, i - lag, dy, value);
    for (int k = 0; k < 4 && i + k < width; k++) row[i + k] = value[k];
  }
}

float rc_correlation_at(const rc_correlation *c, int dx, int dy) {
  if (dy < 0) dx = -dx, dy = -dy; /* the correlation is the same both ways */
  if (abs(dx) > c->lag || dy > c->lag) return RC_NOT_KNOWN;
  return c->value[(size_t)dy * (size_t)(2 * c->lag + 1) + (size_t)(dx + c->lag)];
}

static bool is_peak(const rc_correlation *c, int dx, int dy) {
  float own = rc_correlation_at(c, dx, dy);
  if (own < LEAST_PEAK || (dy == 0 && dx <= 0)) return false;
  if (dx * dx + dy * dy < LEAST_LAG_PX * LEAST_LAG_PX) return false;
  for (int j = -2; j <= 2; j++)
    for (int i = -2; i <= 2; i++)
      if ((i || j) && rc_correlation_at(c, dx + i, dy + j) > own) return false;
  return true;
}

/* The vertex of the parabola through three values. */
static float vertex(float before, float at, float after) {
  float bend = before - 2.f * at + after;
  return bend < 0.f ? fminf(fmaxf(.5f * (before - after) / bend, -.5f), .5f) : 0.f;
}

float rc_correlation_rise(const rc_correlation *c, int from_x, int from_y, int dx, int dy) {
  int x = dx - from_x, y = dy - from_y, steps = abs(x) > abs(y) ? abs(x) : abs(y);
  float own = rc_correlation_at(c, dx, dy), least = own;
  for (int i = 1; i < steps; i++) {
    float part = (float)i / (float)steps, on_x = part * (float)x, on_y = part * (float)y;
    least = fminf(least,
                  rc_correlation_at(c, from_x + (int)rc_round(on_x), from_y + (int)rc_round(on_y)));
  }
  return own - least;
}

static int stronger_first(const void *a, const void *b) {
  const rc_peak *p = a, *q = b;
  if (p->value != q->value) return p->value < q->value ? 1 : -1;
  return p->y != q->y ? (p->y > q->y) - (p->y < q->y) : (p->x > q->x) - (p->x < q->x);
}

static recede_status find_peaks(rc_context *context, const rc_correlation *c, rc_peak **peaks,
                                int *count) {
  rc_peak *found;
  RC_TRY(RC_NEW(context, (c->lag + 1) * (2 * c->lag + 1), &found));
  *count = 0;
  for (int dy = 0; dy <= c->lag; dy++)
    for (int dx = -c->lag; dx <= c->lag; dx++) {
      if (!is_peak(c, dx, dy)) continue;
      rc_peak *peak = &found[(*count)++];
      peak->value = rc_correlation_at(c, dx, dy);
      peak->x = (float)dx + vertex(rc_correlation_at(c, dx - 1, dy), peak->value,
                                   rc_correlation_at(c, dx + 1, dy));
      peak->y = (float)dy + vertex(rc_correlation_at(c, dx, dy - 1), peak->value,
                                   rc_correlation_at(c, dx, dy + 1));
      /* Beyond the largest lag nothing is known: no peak there. */
      peak->inside = abs(dx) < c->lag && dy < c->lag;
      peak->rise = peak->inside ? rc_correlation_rise(c, 0, 0, dx, dy) : 0;
    }
  qsort(found, (size_t)*count, sizeof *found, stronger_first);
  *peaks = found;
  return RECEDE_OK;
}

recede_status rc_correlation_new(rc_context *context, const rc_level *level, const float *trait,
                                 uint64_t key, int points, rc_correlation *c) {
  int32_t *chosen;
  uint32_t sources = (uint32_t)rc_level_all_sources(level).end;
  *c = (rc_correlation){
      .level = level, .flat = rc_chart_flat(level->chart), .trait = trait, .count = points};
  RC_TRY(RC_NEW(context, points, &chosen));
  for (int i = 0; i < points; i++)
    chosen[i] = level->order[rc_below((uint32_t)rc_random(key, (uint32_t)i, 0, 0), sources)];
  c->points = chosen;
  return RECEDE_OK;
}

static recede_status see_points(rc_context *context, const rc_correlation *c, probes *p) {
  const rc_level *level = c->level;
  size_t pixels = (size_t)level->width * (size_t)level->height, count = (size_t)c->count;
  float *known, *of;
  RC_TRY(RC_NEW(context, pixels, &known));
  RC_TRY(RC_NEW(context, 4 * count, &of));
  for (size_t i = 0; i < pixels; i++) known[i] = level->room[i] ? c->trait[i] : NAN;
  for (size_t i = 0; i < count; i++) {
    float x = rc_level_x(level, c->points[i] % level->width);
    float y = rc_level_y(level, c->points[i] / level->width);
    of[i] = x, of[count + i] = y;
    of[2 * count + i] = rc_level_w(level, x, y);
    of[3 * count + i] = c->trait[c->points[i]];
  }
  *p = (probes){c, of, of + count, of + 2 * count, of + 3 * count, known};
  return RECEDE_OK;
}

recede_status rc_correlate(rc_context *context, rc_correlation *c, int lag, rc_peak **peaks,
                           int *count) {
  probes p;
  c->lag = lag;
  RC_TRY(RC_NEW(context, (lag + 1) * (2 * lag + 1), &c->value));
  rc_block *mark = rc_mark(context);
  RC_TRY(see_points(context, c, &p));
  RC_TRY(rc_parallel(context, lag + 1, correlate_row, &p));
  rc_release(context, mark);
  return find_peaks(context, c, peaks, count);
}

double rc_correlation_variance(const rc_correlation *c) {
  double sum = 0, square = 0, count = c->count;
  for (int i = 0; i < c->count; i++) {
    double own = (double)c->trait[c->points[i]];
    sum += own, square += own * own;
  }
  return (square - sum * sum / count) / count;
}
