#include "synthesis/search/correlation.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/real.h"
#include "synthesis/search/evaluate.h"

/* Nearer ones are the texture's own correlation length. */
#define LEAST_LAG_PX 3
/* A lag that fewer of the points share tells nothing. */
#define LEAST_SHARED .25
#define LEAST_PEAK .12f

typedef struct sums {
  double n, a, b, aa, bb, ab;
} sums;

static void add_pair(sums *s, double a, double b) {
  s->n++, s->a += a, s->b += b, s->aa += a * a, s->bb += b * b, s->ab += a * b;
}

static double correlation_of(const sums *s) {
  double spread = (s->aa - s->a * s->a / s->n) * (s->bb - s->b * s->b / s->n);
  return s->n > 0 && spread > 0 ? (s->ab - s->a * s->b / s->n) / sqrt(spread) : 0;
}

static void correlate_lag(const rc_correlation *c, int dx, int dy, float *value) {
  const rc_level *level = c->level;
  rc_copy copy = {(float)dx, (float)dy, 0.f};
  sums s = {0, 0, 0, 0, 0, 0};
  for (int i = 0; i < c->count; i++) {
    int x = c->points[i] % level->width, y = c->points[i] / level->width;
    rc_place place = rc_copy_place(&c->flat, copy, rc_level_x(level, x), rc_level_y(level, y));
    size_t at;
    if (!(place.ratio > .5f && place.ratio < 2.f) || !rc_place_at(level, &place, &at)) continue;
    if (!level->room[at]) continue;
    add_pair(&s, (double)c->trait[c->points[i]], (double)c->trait[at]);
  }
  *value = s.n >= LEAST_SHARED * c->count ? (float)correlation_of(&s) : RC_NOT_KNOWN;
}

static void correlate_row(void *user, int dy, int thread) {
  const rc_correlation *c = user;
  int width = 2 * c->lag + 1;
  (void)thread;
  for (int dx = -c->lag; dx <= c->lag; dx++)
    correlate_lag(c, dx, dy, c->value + (size_t)dy * (size_t)width + (size_t)(dx + c->lag));
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

recede_status rc_correlate(rc_context *context, rc_correlation *c, int lag, rc_peak **peaks,
                           int *count) {
  c->lag = lag;
  RC_TRY(RC_NEW(context, (lag + 1) * (2 * lag + 1), &c->value));
  RC_TRY(rc_parallel(context, lag + 1, correlate_row, c));
  return find_peaks(context, c, peaks, count);
}

double rc_correlation_variance(const rc_correlation *c) {
  sums s = {0, 0, 0, 0, 0, 0};
  for (int i = 0; i < c->count; i++) add_pair(&s, (double)c->trait[c->points[i]], 0);
  return (s.aa - s.a * s.a / s.n) / s.n;
}
