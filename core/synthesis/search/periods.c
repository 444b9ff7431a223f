#include "synthesis/search/periods.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/real.h"

/* Lags up to this many px at the coarsest level, and no more than a third of the picture there. */
#define MOST_LAG_PX 64
/* Nearer ones are the texture's own correlation length. */
#define LEAST_LAG_PX 3
/* A lag that fewer of the points share tells nothing. */
#define LEAST_SHARED .25
#define LEAST_PEAK .12f
/* A texture repeats by nature where it correlates so much with itself a period away, drawn bricks,
 * tiles and planks .77 to .99; so do even sand and roads, where nobody sees what comes twice. Or
 * where it rises by so much on the way there: roofs in a photo correlate only .6 to .7, but rise by
 * .7 to 1.2. Stones and lawns have up to .55, and rise by up to .72. */
#define REPEATS .72f
#define REPEATS_BY_RISE .85f
/* And it is regular where two periods so far from parallel, sine of the angle, correlate and rise
 * by so much each: drawn chess boards, hexagons, pavers, parquet and facades .6 to .98, and .75 to
 * 1.1. Dunes have .9 and 1, but one way. */
#define REGULAR .6f
#define REGULAR_RISE .75f
#define LEAST_SINE .5f

typedef struct correlation {
  const rc_level *level;
  rc_chart flat;
  const float *trait; /* of each pixel */
  const int32_t *points;
  int count;    /* of points */
  int lag;      /* largest */
  float *value; /* (lag + 1) rows of 2 lag + 1 */
} correlation;

typedef struct peak {
  float value, rise, x, y;
} peak;

static void correlate_lag(const correlation *c, int dx, int dy, float *value) {
  const rc_level *level = c->level;
  rc_copy copy = {(float)dx, (float)dy, 0.f};
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (int i = 0; i < c->count; i++) {
    int x = c->points[i] % level->width, y = c->points[i] / level->width;
    rc_place place = rc_copy_place(&c->flat, copy, rc_level_x(level, x), rc_level_y(level, y));
    float sx = place.x + c->flat.x0 + .5f, sy = place.y + c->flat.y0 + .5f;
    if (place.beyond || !(place.ratio > .5f && place.ratio < 2.f)) continue;
    if (!(sx >= 0.f && sy >= 0.f && sx < (float)level->width && sy < (float)level->height))
      continue;
    size_t at = (size_t)(int)sy * (size_t)level->width + (size_t)(int)sx;
    if (!level->room[at]) continue;
    double p = c->trait[c->points[i]], q = c->trait[at];
    n++, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
  }
  double spread = (aa - a * a / fmax(n, 1)) * (bb - b * b / fmax(n, 1));
  *value =
      n >= LEAST_SHARED * c->count && spread > 0 ? (float)((ab - a * b / n) / sqrt(spread)) : 0.f;
}

static void correlate_row(void *user, int dy, int thread) {
  const correlation *c = user;
  int width = 2 * c->lag + 1;
  (void)thread;
  for (int dx = -c->lag; dx <= c->lag; dx++)
    correlate_lag(c, dx, dy, c->value + (size_t)dy * (size_t)width + (size_t)(dx + c->lag));
}

static float value_at(const correlation *c, int dx, int dy) {
  if (dy < 0) dx = -dx, dy = -dy; /* the correlation is the same both ways */
  if (abs(dx) > c->lag || dy > c->lag) return 0.f;
  return c->value[(size_t)dy * (size_t)(2 * c->lag + 1) + (size_t)(dx + c->lag)];
}

static bool is_peak(const correlation *c, int dx, int dy) {
  float own = value_at(c, dx, dy);
  if (own < LEAST_PEAK || (dy == 0 && dx <= 0)) return false;
  if (dx * dx + dy * dy < LEAST_LAG_PX * LEAST_LAG_PX) return false;
  for (int j = -2; j <= 2; j++)
    for (int i = -2; i <= 2; i++)
      if ((i || j) && value_at(c, dx + i, dy + j) > own) return false;
  return true;
}

/* The vertex of the parabola through three values. */
static float vertex(float before, float at, float after) {
  float bend = before - 2.f * at + after;
  return bend < 0.f ? fminf(fmaxf(.5f * (before - after) / bend, -.5f), .5f) : 0.f;
}

/* From the least on the way there: a high correlation may be shading's alone, which drifts. */
static float rise_to(const correlation *c, int dx, int dy) {
  int steps = abs(dx) > dy ? abs(dx) : dy;
  float own = value_at(c, dx, dy), least = own;
  for (int i = 1; i < steps; i++) {
    float part = (float)i / (float)steps, x = part * (float)dx, y = part * (float)dy;
    least = fminf(least, value_at(c, (int)rc_round(x), (int)rc_round(y)));
  }
  return own - least;
}

static int stronger_first(const void *a, const void *b) {
  const peak *p = a, *q = b;
  if (p->value != q->value) return p->value < q->value ? 1 : -1;
  return p->y != q->y ? (p->y > q->y) - (p->y < q->y) : (p->x > q->x) - (p->x < q->x);
}

static bool is_regular(const peak *p) { return p->value >= REGULAR && p->rise >= REGULAR_RISE; }

/* The two that together are shortest. */
static void find_base(const peak *peaks, int count, rc_periods *periods) {
  float shortest = INFINITY;
  for (int i = 0; i < count; i++)
    for (int j = 0; j < i; j++) {
      const peak *p = &peaks[i], *q = &peaks[j];
      if (!is_regular(p) || !is_regular(q)) continue;
      float p_px = sqrtf(p->x * p->x + p->y * p->y), q_px = sqrtf(q->x * q->x + q->y * q->y);
      if (fabsf(p->x * q->y - p->y * q->x) < LEAST_SINE * p_px * q_px || p_px + q_px >= shortest)
        continue;
      shortest = p_px + q_px;
      periods->regular = true;
      periods->base[0] = (rc_copy){p->x, p->y, 0.f}, periods->base[1] = (rc_copy){q->x, q->y, 0.f};
    }
}

static recede_status collect(rc_context *context, const correlation *c, rc_periods *periods) {
  peak *peaks;
  int found = 0, most = (c->lag + 1) * (2 * c->lag + 1);
  RC_TRY(RC_NEW(context, most, &peaks));
  for (int dy = 0; dy <= c->lag; dy++)
    for (int dx = -c->lag; dx <= c->lag; dx++) {
      if (!is_peak(c, dx, dy)) continue;
      /* Beyond the largest lag nothing is known: no peak there. */
      bool inside = abs(dx) < c->lag && dy < c->lag;
      float own = value_at(c, dx, dy), rise = inside ? rise_to(c, dx, dy) : 0;
      periods->repeats =
          periods->repeats || (inside && (own >= REPEATS || rise >= REPEATS_BY_RISE));
      peaks[found++] = (peak){
          own, rise, (float)dx + vertex(value_at(c, dx - 1, dy), own, value_at(c, dx + 1, dy)),
          (float)dy + vertex(value_at(c, dx, dy - 1), own, value_at(c, dx, dy + 1))};
    }
  qsort(peaks, (size_t)found, sizeof *peaks, stronger_first);
  find_base(peaks, found, periods);
  for (int i = 0; i < found && periods->count + 1 < RC_MOST_PERIODS; i++) {
    periods->copies[periods->count++] = (rc_copy){peaks[i].x, peaks[i].y, 0.f};
    periods->copies[periods->count++] = (rc_copy){-peaks[i].x, -peaks[i].y, 0.f};
  }
  return RECEDE_OK;
}

recede_status rc_find_periods(rc_context *context, const rc_level *level, uint64_t key, int count,
                              rc_periods *periods) {
  size_t pixels = (size_t)level->width * (size_t)level->height;
  int sources = rc_level_all_sources(level).end;
  int third = (level->width < level->height ? level->width : level->height) / 3;
  correlation c = {.level = level, .flat = rc_chart_flat(level->chart), .count = count};
  float *trait;
  int32_t *points;
  *periods = (rc_periods){.count = 0};
  c.lag = third < MOST_LAG_PX ? third : MOST_LAG_PX;
  if (sources < LEAST_SHARED * count || c.lag <= LEAST_LAG_PX) return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &trait));
  RC_TRY(RC_NEW(context, count, &points));
  RC_TRY(RC_NEW(context, (c.lag + 1) * (2 * c.lag + 1), &c.value));
  for (size_t i = 0; i < pixels; i++) trait[i] = rc_level_trait(level, (int)i);
  for (int i = 0; i < count; i++)
    points[i] =
        level->order[rc_below((uint32_t)rc_random(key, (uint32_t)i, 0, 0), (uint32_t)sources)];
  c.trait = trait, c.points = points;
  RC_TRY(rc_parallel(context, c.lag + 1, correlate_row, &c));
  RC_TRY(collect(context, &c, periods));
  rc_release(context, mark);
  return RECEDE_OK;
}
