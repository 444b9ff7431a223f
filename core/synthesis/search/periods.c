#include "synthesis/search/periods.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/real.h"
#include "synthesis/search/evaluate.h"

/* Lags up to this many px at the coarsest level, and no more than a third of the picture there. */
#define MOST_LAG_PX 64
/* Nearer ones are the texture's own correlation length. */
#define LEAST_LAG_PX 3
/* A lag that fewer of the points share tells nothing. */
#define LEAST_SHARED .25
#define NOT_KNOWN 0.f
#define LEAST_PEAK .12f
/* A texture repeats by nature where it correlates so much with itself a period away, drawn bricks,
 * tiles and planks .77 to .99; so do even sand and roads, where nobody sees what comes twice. Or
 * where it rises by so much on the way there: roofs in a photo correlate only .6 to .7, but rise by
 * .7 to 1.2. Stones and lawns have up to .55, and rise by up to .72. */
#define REPEATS .72f
#define REPEATS_BY_RISE .85f
/* And it is regular where two periods so far from parallel, sine of the angle, correlate and rise
 * by so much each: drawn chess boards, hexagons, pavers, parquet and facades .6 to .98, and .75 to
 * 1.1. Dunes have .9 and 1, but one way. And a third one, of their sum or difference, correlates by
 * the last. */
typedef struct bar {
  float value, rise, confirmed;
} bar;
static const bar by_all = {.6f, .75f, .4f};
/* Tiles that are stained, or of many colours, have nothing in common but their joints, thin lines
 * that are darker or brighter than what lies within so many px. Of a lattice every place that its
 * periods lead to correlates by so much, and those half a period off by no more than this part of
 * what these do in the mean: hexagons, octagons, window panes, figured tiles .21 to .52, and up to
 * .54; walls in courses, setts and boards less than .17, or .72 to .98. */
#define JOINTS_WITHIN_PX 3
#define MOST_DEVIATIONS 2.f /* a joint is a joint, however dark */
static const bar by_joints = {.25f, .25f, .2f};
#define LEAST_ON .2f
#define MOST_OFF .65
/* And the sources are so many of its cells large (10 to 39): among fewer some pairs agree by
 * chance, as in the grain of a table (.6) or in drapery (4). */
#define LEAST_CELLS 6.f
/* So it must be beside the hole, too, off by .4 to 1.4 of what all joints vary by; heaps in rows
 * with bare ground around the hole by 1.7 and more. Smaller than what is due are jittered stones.
 */
#define MOST_JOINTS_OFF 1.6
#define MOST_BASES 8 /* are tried */
#define REACHED 9    /* so many periods each way */
#define LEAST_SINE .5f
/* Of what is smaller patches see nearly two. */
#define LEAST_DUE_PX 7.f
#define BESIDE_PX 4
/* What is due is off by .1 to 1 of the variance, bare ground among heaps by 2. */
#define MOST_DUE_OFF 1.2
/* A peak is a multiple of both that is off by no more. */
#define MOST_OFF_PX 1.5

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
  bool inside; /* of the lags looked at */
} peak;

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

static void correlate_lag(const correlation *c, int dx, int dy, float *value) {
  const rc_level *level = c->level;
  rc_copy copy = {(float)dx, (float)dy, 0.f};
  sums s = {0, 0, 0, 0, 0, 0};
  for (int i = 0; i < c->count; i++) {
    int x = c->points[i] % level->width, y = c->points[i] / level->width;
    rc_place place = rc_copy_place(&c->flat, copy, rc_level_x(level, x), rc_level_y(level, y));
    float sx = place.x + c->flat.x0 + .5f, sy = place.y + c->flat.y0 + .5f;
    if (place.beyond || !(place.ratio > .5f && place.ratio < 2.f)) continue;
    if (!(sx >= 0.f && sy >= 0.f && sx < (float)level->width && sy < (float)level->height))
      continue;
    size_t at = (size_t)(int)sy * (size_t)level->width + (size_t)(int)sx;
    if (!level->room[at]) continue;
    add_pair(&s, (double)c->trait[c->points[i]], (double)c->trait[at]);
  }
  *value = s.n >= LEAST_SHARED * c->count ? (float)correlation_of(&s) : NOT_KNOWN;
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

/* What the correlation at (dx, dy) rises by from the least on the way there from (from_x, from_y):
 * a high one may be shading's alone, which drifts. */
static float rise_to(const correlation *c, int from_x, int from_y, int dx, int dy) {
  int x = dx - from_x, y = dy - from_y, steps = abs(x) > abs(y) ? abs(x) : abs(y);
  float own = value_at(c, dx, dy), least = own;
  for (int i = 1; i < steps; i++) {
    float part = (float)i / (float)steps, on_x = part * (float)x, on_y = part * (float)y;
    least = fminf(least, value_at(c, from_x + (int)rc_round(on_x), from_y + (int)rc_round(on_y)));
  }
  return own - least;
}

static int stronger_first(const void *a, const void *b) {
  const peak *p = a, *q = b;
  if (p->value != q->value) return p->value < q->value ? 1 : -1;
  return p->y != q->y ? (p->y > q->y) - (p->y < q->y) : (p->x > q->x) - (p->x < q->x);
}

static bool is_regular(const bar *b, const peak *p) {
  return p->value >= b->value && p->rise >= b->rise;
}

/* Of stripes there are peaks all along the next one, and none between them. */
static bool part_them(const correlation *c, const bar *b, const peak *p, const peak *q) {
  int px = (int)rc_round(p->x), py = (int)rc_round(p->y);
  int qx = (int)rc_round(q->x), qy = (int)rc_round(q->y);
  return rise_to(c, px, py, qx, qy) >= b->rise && rise_to(c, -px, -py, qx, qy) >= b->rise;
}

/* Two peaks come by chance, but what they span has more: at their sum or difference. */
static bool is_confirmed(const bar *b, const peak *peaks, int count, const peak *p, const peak *q) {
  for (int n = 0; n < 4 * count; n++) {
    const peak *at = &peaks[n / 4];
    float by = n % 2 ? 1.f : -1.f, sign = n / 2 % 2 ? 1.f : -1.f;
    if (at->value >= b->confirmed && at->rise > 0 &&
        fabsf(sign * at->x - p->x - by * q->x) <= MOST_OFF_PX &&
        fabsf(sign * at->y - p->y - by * q->y) <= MOST_OFF_PX)
      return true;
  }
  return false;
}

/* The two that together are shortest, of those longer than *length, which becomes theirs. */
static bool find_base(const correlation *c, const bar *b, const peak *peaks, int count,
                      float *length, rc_periods *periods) {
  float shortest = INFINITY;
  for (int i = 0; i < count; i++)
    for (int j = 0; j < i; j++) {
      const peak *p = &peaks[i], *q = &peaks[j];
      if (!is_regular(b, p) || !is_regular(b, q)) continue;
      float p_px = sqrtf(p->x * p->x + p->y * p->y), q_px = sqrtf(q->x * q->x + q->y * q->y);
      if (fabsf(p->x * q->y - p->y * q->x) < LEAST_SINE * p_px * q_px || p_px + q_px <= *length ||
          p_px + q_px >= shortest)
        continue;
      if (!part_them(c, b, p, q) || !is_confirmed(b, peaks, count, p, q)) continue;
      shortest = p_px + q_px;
      periods->due = fminf(p_px, q_px) >= LEAST_DUE_PX;
      periods->base[0] = (rc_copy){p->x, p->y, 0.f}, periods->base[1] = (rc_copy){q->x, q->y, 0.f};
    }
  *length = shortest;
  return shortest < INFINITY;
}

static double variance_of(const correlation *c) {
  sums s = {0, 0, 0, 0, 0, 0};
  for (int i = 0; i < c->count; i++) add_pair(&s, (double)c->trait[c->points[i]], 0);
  return (s.aa - s.a * s.a / s.n) / s.n;
}

/* Heaps that lie in rows, but not around the hole, are not due there: sources beside its box must
 * be like what is one period off, by what all vary by. */
static bool holds_beside(const correlation *c, const rc_periods *periods, double most_off) {
  const rc_level *level = c->level;
  double off = 0, pairs = 0;
  for (int y = level->box.y0 - BESIDE_PX; y < level->box.y1 + BESIDE_PX; y++)
    for (int x = level->box.x0 - BESIDE_PX; x < level->box.x1 + BESIDE_PX; x++) {
      if (!rc_inside(level->width, level->height, x, y)) continue;
      size_t at = (size_t)y * (size_t)level->width + (size_t)x, to;
      for (int n = 0; n < 4 && level->room[at]; n++) {
        float sign = n % 2 ? 1.f : -1.f;
        rc_copy move = {sign * periods->base[n / 2].a, sign * periods->base[n / 2].b, 0.f};
        rc_place place = rc_copy_place(&c->flat, move, rc_level_x(level, x), rc_level_y(level, y));
        if (!rc_place_at(level, &place, &to) || !level->room[to]) continue;
        double d = (double)c->trait[at] - (double)c->trait[to];
        off += d * d, pairs++;
      }
    }
  return pairs > 0 && off / pairs <= most_off * variance_of(c);
}

/* By all peaks that are near whole multiples of it: a px off each time is half a square soon. */
static void refine_base(const bar *b, const peak *peaks, int count, rc_periods *periods) {
  rc_copy *p = &periods->base[0], *q = &periods->base[1];
  double area = (double)p->a * q->b - (double)p->b * q->a, ii = 0, ij = 0, jj = 0;
  double ia = 0, ib = 0, ja = 0, jb = 0;
  for (int n = 0; n < count; n++) {
    const peak *at = &peaks[n];
    double i = rc_round((float)((at->x * q->b - at->y * q->a) / area));
    double j = rc_round((float)((at->y * p->a - at->x * p->b) / area));
    if (at->value < b->value || !(at->rise > 0) ||
        fabs(at->x - i * p->a - j * q->a) > MOST_OFF_PX ||
        fabs(at->y - i * p->b - j * q->b) > MOST_OFF_PX)
      continue;
    ii += i * i, ij += i * j, jj += j * j;
    ia += i * at->x, ib += i * at->y, ja += j * at->x, jb += j * at->y;
  }
  double both = ii * jj - ij * ij; /* at least 1: base itself is among them */
  *p = (rc_copy){(float)((ia * jj - ja * ij) / both), (float)((ib * jj - jb * ij) / both), 0.f};
  *q = (rc_copy){(float)((ja * ii - ia * ij) / both), (float)((jb * ii - ib * ij) / both), 0.f};
}

/* All peaks, strongest first. */
static recede_status find_peaks(rc_context *context, const correlation *c, peak **peaks,
                                int *count) {
  peak *found;
  RC_TRY(RC_NEW(context, (c->lag + 1) * (2 * c->lag + 1), &found));
  *count = 0;
  for (int dy = 0; dy <= c->lag; dy++)
    for (int dx = -c->lag; dx <= c->lag; dx++) {
      if (!is_peak(c, dx, dy)) continue;
      /* Beyond the largest lag nothing is known: no peak there. */
      bool inside = abs(dx) < c->lag && dy < c->lag;
      float own = value_at(c, dx, dy);
      found[(*count)++] =
          (peak){own, inside ? rise_to(c, 0, 0, dx, dy) : 0,
                 (float)dx + vertex(value_at(c, dx - 1, dy), own, value_at(c, dx + 1, dy)),
                 (float)dy + vertex(value_at(c, dx, dy - 1), own, value_at(c, dx, dy + 1)), inside};
    }
  qsort(found, (size_t)*count, sizeof *found, stronger_first);
  *peaks = found;
  return RECEDE_OK;
}

static recede_status find_by_all(rc_context *context, const correlation *c, rc_periods *periods) {
  peak *peaks;
  int found;
  float length = 0;
  RC_TRY(find_peaks(context, c, &peaks, &found));
  for (int i = 0; i < found; i++)
    periods->repeats =
        periods->repeats ||
        (peaks[i].inside && (peaks[i].value >= REPEATS || peaks[i].rise >= REPEATS_BY_RISE));
  periods->regular = find_base(c, &by_all, peaks, found, &length, periods);
  if (periods->regular) refine_base(&by_all, peaks, found, periods);
  periods->due = periods->due && holds_beside(c, periods, MOST_DUE_OFF);
  for (int i = 0; i < found && periods->count + 1 < RC_MOST_PERIODS; i++) {
    periods->copies[periods->count++] = (rc_copy){peaks[i].x, peaks[i].y, 0.f};
    periods->copies[periods->count++] = (rc_copy){-peaks[i].x, -peaks[i].y, 0.f};
  }
  return RECEDE_OK;
}

/* How far what lies within so many px is brighter than a pixel, both known, up to so many
 * deviations; 0 elsewhere. */
static void take_joints(const rc_level *level, const float *trait, float *joint) {
  enum { R = JOINTS_WITHIN_PX };
  double squares = 0, count = 0;
  for (int y = 0; y < level->height; y++)
    for (int x = 0; x < level->width; x++) {
      float sum = 0, seen = 0;
      size_t at = (size_t)y * (size_t)level->width + (size_t)x;
      joint[at] = 0;
      if (!level->room[at]) continue;
      for (int v = y - R; v <= y + R; v++)
        for (int u = x - R; u <= x + R; u++) {
          if (!rc_inside(level->width, level->height, u, v)) continue;
          size_t near = (size_t)v * (size_t)level->width + (size_t)u;
          if (level->room[near]) sum += trait[near], seen++;
        }
      joint[at] = sum / seen - trait[at];
      squares += (double)(joint[at] * joint[at]), count++;
    }
  float most = count > 0 ? MOST_DEVIATIONS * (float)sqrt(squares / count) : 0;
  for (size_t i = 0; i < (size_t)level->width * (size_t)level->height; i++)
    joint[i] = fminf(fmaxf(joint[i], -most), most);
}

static float highest_near(const correlation *c, int dx, int dy) {
  float most = -1;
  for (int j = dy - 1; j <= dy + 1; j++)
    for (int i = dx - 1; i <= dx + 1; i++) most = fmaxf(most, value_at(c, i, j));
  return most;
}

/* Whether all that the periods lead to correlates, and what lies between does not. */
static bool is_lattice(const correlation *c, const rc_periods *periods) {
  const rc_copy *p = &periods->base[0], *q = &periods->base[1];
  double mean[4], off = 0;
  float pixels = (float)rc_level_all_sources(c->level).end;
  if (pixels < LEAST_CELLS * fabsf(p->a * q->b - p->b * q->a)) return false;
  for (int k = 0; k < 4; k++) { /* the last three are half a period off, one way or both */
    double sum = 0, count = 0;
    for (int n = 0; n < REACHED * REACHED; n++) {
      float i = (float)(n % REACHED - REACHED / 2) + .5f * (float)(k % 2);
      float j = (float)(n / REACHED - REACHED / 2) + .5f * (float)(k / 2);
      int dx = (int)rc_round(i * p->a + j * q->a);
      int dy = (int)rc_round(i * p->b + j * q->b);
      if (abs(dx) >= c->lag || abs(dy) >= c->lag || (!k && !dx && !dy) ||
          value_at(c, dx, dy) == NOT_KNOWN)
        continue;
      float value = k ? value_at(c, dx, dy) : highest_near(c, dx, dy);
      if (!k && value < LEAST_ON) return false;
      sum += (double)value, count++;
    }
    mean[k] = count > 0 ? sum / count : 1;
    if (k) off = fmax(off, mean[k]);
  }
  return off <= MOST_OFF * mean[0];
}

static recede_status find_by_joints(rc_context *context, correlation *c, rc_periods *periods) {
  peak *peaks;
  int found;
  float *joint, length = 0;
  const rc_level *level = c->level;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &joint));
  take_joints(level, c->trait, joint);
  c->trait = joint;
  RC_TRY(rc_parallel(context, c->lag + 1, correlate_row, c));
  RC_TRY(find_peaks(context, c, &peaks, &found));
  for (int n = 0; n < MOST_BASES && !periods->regular; n++) {
    if (!find_base(c, &by_joints, peaks, found, &length, periods)) break;
    refine_base(&by_joints, peaks, found, periods);
    periods->regular =
        periods->due && is_lattice(c, periods) && holds_beside(c, periods, MOST_JOINTS_OFF);
  }
  periods->by_joints = periods->regular;
  periods->due = false; /* that is told by more than joints */
  return RECEDE_OK;
}

recede_status rc_find_periods(rc_context *context, const rc_level *level, uint64_t key, int count,
                              bool joints, rc_periods *periods) {
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
  RC_TRY(find_by_all(context, &c, periods));
  if (!periods->regular && joints) RC_TRY(find_by_joints(context, &c, periods));
  rc_release(context, mark);
  return RECEDE_OK;
}
