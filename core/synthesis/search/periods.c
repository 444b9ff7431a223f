#include "synthesis/search/periods.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/real.h"
#include "synthesis/search/correlation.h"
#include "synthesis/search/evaluate.h"

/* Lags up to this many px at the coarsest level, and no more than a third of the picture there; a
 * half of it where by then something is seen to repeat, but nothing both ways. */
#define MOST_LAG_PX 64
/* Smaller levels, and fewer sources than this part of the points, tell nothing. */
#define LEAST_THIRD_PX 4
#define LEAST_SOURCES .25
/* A texture repeats by nature where it correlates so much with itself a period away, drawn bricks,
 * tiles and planks .77 to .99; so do even sand and roads, where nobody sees what comes twice. Or
 * where it rises by so much on the way there: roofs in a photo correlate only .6 to .7, but rise by
 * .7 to 1.2. Stones and lawns have up to .55, and rise by up to .72. */
#define REPEATS .72f
#define REPEATS_BY_RISE .85f

/* What is regular repeats by two periods that are far from parallel. */
typedef struct bar {
  int bases;          /* are tried, shortest first */
  float value, rise;  /* the least of each period */
  float confirmed;    /* of a third one, their sum or difference */
  float cells;        /* so large are the sources at least: among fewer some agree by chance */
  double whole;       /* the least mean of all that whole periods lead to */
  double most_off;    /* half a period off, of that mean */
  double most_beside; /* what lies beside the hole is off from its place in this, squared, of what
                         all vary by */
  bool unseen;        /* two are enough where a third one can not be seen */
  bool lattice, due;  /* all that they lead to is asked, and what lies beside the hole */
} bar;
/* Drawn chess boards, hexagons, pavers, parquet and facades correlate by .6 to .98, and rise by .75
 * to 1.1. Dunes have .9 and 1, but one way. Beside the hole they are off by .1 to 1, bare ground
 * among heaps by 2. */
static const bar by_all = {
    .bases = 1, .value = .6f, .rise = .75f, .confirmed = .4f, .most_beside = 1.2};
/* A grid of bars rises less on the way along them, and is only .16 to .77 off between, but it
 * correlates by .82 to .98 wherever its periods lead. */
static const bar by_bars = {.bases = 8,
                            .value = .8f,
                            .rise = .4f,
                            .confirmed = .75f,
                            .cells = 3.f,
                            .whole = .65,
                            .most_off = .8,
                            .most_beside = 1.2,
                            .lattice = true};
/* Cells of which the picture shows two or three each way: what would confirm them may lie beyond
 * the lags looked at. In the mean .73 to .93, and beside the hole off by .2 to .54, where
 * gravel crosses roof tiles .7. */
static const bar by_cells = {.bases = 1,
                             .value = .7f,
                             .rise = .6f,
                             .confirmed = .4f,
                             .cells = 3.f,
                             .whole = .65,
                             .most_off = .65,
                             .most_beside = .6,
                             .unseen = true,
                             .lattice = true,
                             .due = true};
/* What repeats one way, as the stripes of a crossing do, is due as clearly, and not as near. */
static const bar by_row = {.bases = 1, .value = .85f, .rise = .8f, .most_beside = .6};
#define LEAST_ROW_PX 5.f
/* Tiles that are stained, or of many colours, have nothing in common but their joints, thin lines
 * that are darker or brighter than what lies within so many px: hexagons, octagons, window panes,
 * figured tiles off by up to .54 between; walls in courses, setts and boards .72 to .98. Beside
 * the hole .4 to 1.4, heaps in rows with bare ground around it 1.7 and more. Cells: 10 to 39; the
 * grain of a table .6, drapery 4. */
#define JOINTS_WITHIN_PX 3
#define MOST_DEVIATIONS 2.f /* a joint is a joint, however dark */
static const bar by_joints = {.bases = 8,
                              .value = .25f,
                              .rise = .25f,
                              .confirmed = .2f,
                              .cells = 6.f,
                              .most_off = .65,
                              .most_beside = 1.6,
                              .lattice = true,
                              .due = true};
/* Of a lattice every place that its periods lead to correlates by so much: joints .21 to .52, walls
 * in courses, setts and boards less than .17. */
#define LEAST_ON .2f
#define REACHED 9 /* so many periods each way */
#define LEAST_SINE .5f
/* Of what is smaller patches see nearly two; what is so small by its joints is jittered stones. */
#define LEAST_DUE_PX 7.f
#define BESIDE_PX 4
/* So much of what all vary by: what is plain is like itself any period off. Beside holes in what
 * repeats .24 and more, of windows .08, in a table beside a striped carpet .003. */
#define LEAST_BESIDE_VARIES .03
/* A peak is a multiple of both that is off by no more. */
#define MOST_OFF_PX 1.5

static bool is_regular(const bar *b, const rc_peak *p) {
  return p->value >= b->value && p->rise >= b->rise;
}

/* Of stripes there are peaks all along the next one, and none between them. */
static bool part_them(const rc_correlation *c, const bar *b, const rc_peak *p, const rc_peak *q) {
  int px = (int)rc_round(p->x), py = (int)rc_round(p->y);
  int qx = (int)rc_round(q->x), qy = (int)rc_round(q->y);
  return rc_correlation_rise(c, px, py, qx, qy) >= b->rise &&
         rc_correlation_rise(c, -px, -py, qx, qy) >= b->rise;
}

static bool is_seen(const rc_correlation *c, float x, float y) {
  float most = (float)c->lag - 1;
  return fabsf(x) <= most && fabsf(y) <= most &&
         rc_correlation_at(c, (int)rc_round(x), (int)rc_round(y)) != RC_NOT_KNOWN;
}

/* Two peaks come by chance, but what they span has more: at their sum or difference. */
static bool is_confirmed(const rc_correlation *c, const bar *b, const rc_peak *peaks, int count,
                         const rc_peak *p, const rc_peak *q) {
  if (b->unseen && !is_seen(c, p->x + q->x, p->y + q->y) && !is_seen(c, p->x - q->x, p->y - q->y))
    return true;
  for (int n = 0; n < 4 * count; n++) {
    const rc_peak *at = &peaks[n / 4];
    float by = n % 2 ? 1.f : -1.f, sign = n / 2 % 2 ? 1.f : -1.f;
    if (at->value >= b->confirmed && at->rise > 0 &&
        fabsf(sign * at->x - p->x - by * q->x) <= MOST_OFF_PX &&
        fabsf(sign * at->y - p->y - by * q->y) <= MOST_OFF_PX)
      return true;
  }
  return false;
}

/* The two that together are shortest, of those longer than *length, which becomes theirs. */
static bool find_base(const rc_correlation *c, const bar *b, const rc_peak *peaks, int count,
                      float *length, rc_periods *periods) {
  float shortest = INFINITY;
  for (int i = 0; i < count; i++)
    for (int j = 0; j < i; j++) {
      const rc_peak *p = &peaks[i], *q = &peaks[j];
      if (!is_regular(b, p) || !is_regular(b, q)) continue;
      float p_px = sqrtf(p->x * p->x + p->y * p->y), q_px = sqrtf(q->x * q->x + q->y * q->y);
      if (fabsf(p->x * q->y - p->y * q->x) < LEAST_SINE * p_px * q_px || p_px + q_px <= *length ||
          p_px + q_px >= shortest)
        continue;
      if (!part_them(c, b, p, q) || !is_confirmed(c, b, peaks, count, p, q)) continue;
      shortest = p_px + q_px;
      periods->due = fminf(p_px, q_px) >= LEAST_DUE_PX;
      periods->base[0] = (rc_copy){p->x, p->y, 0.f}, periods->base[1] = (rc_copy){q->x, q->y, 0.f};
    }
  *length = shortest;
  return shortest < INFINITY;
}

/* Heaps that lie in rows, but not around the hole, are not due there: sources beside its box must
 * be like what is one period off, by what all vary by, and vary themselves. */
static bool holds_beside(const rc_correlation *c, const bar *b, const rc_periods *periods) {
  const rc_level *level = c->level;
  double off = 0, pairs = 0, sum = 0, square = 0, count = 0;
  for (int y = level->box.y0 - BESIDE_PX; y < level->box.y1 + BESIDE_PX; y++)
    for (int x = level->box.x0 - BESIDE_PX; x < level->box.x1 + BESIDE_PX; x++) {
      if (!rc_inside(level->width, level->height, x, y)) continue;
      size_t at = (size_t)y * (size_t)level->width + (size_t)x, to;
      if (!level->room[at]) continue;
      double own = (double)c->trait[at];
      sum += own, square += own * own, count++;
      for (int n = 0; n < (periods->row ? 2 : 4); n++) {
        float sign = n % 2 ? 1.f : -1.f;
        rc_copy move = {sign * periods->base[n / 2].a, sign * periods->base[n / 2].b, 0.f};
        rc_place place = rc_copy_place(&c->flat, move, rc_level_x(level, x), rc_level_y(level, y));
        if (!rc_place_at(level, &place, &to) || !level->room[to]) continue;
        double d = own - (double)c->trait[to];
        off += d * d, pairs++;
      }
    }
  double all = rc_correlation_variance(c);
  return pairs > 0 && off / pairs <= b->most_beside * all &&
         square / count - sum / count * (sum / count) >= LEAST_BESIDE_VARIES * all;
}

/* By all peaks that are near whole multiples of it: a px off each time is half a square soon. */
static void refine_base(const bar *b, const rc_peak *peaks, int count, rc_periods *periods) {
  rc_copy *p = &periods->base[0], *q = &periods->base[1];
  double area = (double)p->a * q->b - (double)p->b * q->a, ii = 0, ij = 0, jj = 0;
  double ia = 0, ib = 0, ja = 0, jb = 0;
  for (int n = 0; n < count; n++) {
    const rc_peak *at = &peaks[n];
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

/* How far what lies within so many px is brighter than a pixel, both known, up to so many
 * deviations; 0 elsewhere. */
static recede_status take_joints(rc_context *context, const rc_level *level, const float *trait,
                                 float *joint) {
  enum { R = JOINTS_WITHIN_PX };
  double squares = 0, count = 0;
  for (int y = 0; y < level->height; y++) {
    RC_TRY(rc_poll(context));
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
  }
  float most = count > 0 ? MOST_DEVIATIONS * (float)sqrt(squares / count) : 0;
  for (size_t i = 0; i < (size_t)level->width * (size_t)level->height; i++)
    joint[i] = fminf(fmaxf(joint[i], -most), most);
  return RECEDE_OK;
}

static float highest_near(const rc_correlation *c, int dx, int dy) {
  float most = -1;
  for (int j = dy - 1; j <= dy + 1; j++)
    for (int i = dx - 1; i <= dx + 1; i++) most = fmaxf(most, rc_correlation_at(c, i, j));
  return most;
}

/* Whether all that the periods lead to correlates, and what lies between does not. */
static bool is_lattice(const rc_correlation *c, const bar *b, const rc_periods *periods) {
  const rc_copy *p = &periods->base[0], *q = &periods->base[1];
  double mean[4], off = 0;
  float pixels = (float)rc_level_all_sources(c->level).end;
  if (pixels < b->cells * fabsf(p->a * q->b - p->b * q->a)) return false;
  for (int k = 0; k < 4; k++) { /* the last three are half a period off, one way or both */
    double sum = 0, count = 0;
    for (int n = 0; n < REACHED * REACHED; n++) {
      float i = (float)(n % REACHED - REACHED / 2) + .5f * (float)(k % 2);
      float j = (float)(n / REACHED - REACHED / 2) + .5f * (float)(k / 2);
      int dx = (int)rc_round(i * p->a + j * q->a);
      int dy = (int)rc_round(i * p->b + j * q->b);
      if (abs(dx) >= c->lag || abs(dy) >= c->lag || (!k && !dx && !dy) ||
          rc_correlation_at(c, dx, dy) == RC_NOT_KNOWN)
        continue;
      float value = k ? rc_correlation_at(c, dx, dy) : highest_near(c, dx, dy);
      if (!k && value < LEAST_ON) return false;
      sum += (double)value, count++;
    }
    mean[k] = count > 0 ? sum / count : 1;
    if (k) off = fmax(off, mean[k]);
  }
  return mean[0] >= b->whole && off <= b->most_off * mean[0];
}

/* By the first base that is a lattice and due, if it has to be. */
static bool find_regular(const rc_correlation *c, const bar *b, const rc_peak *peaks, int count,
                         rc_periods *periods) {
  float length = 0;
  for (int n = 0; n < b->bases; n++) {
    if (!find_base(c, b, peaks, count, &length, periods)) break;
    refine_base(b, peaks, count, periods);
    periods->due = periods->due && holds_beside(c, b, periods);
    if ((periods->due || !b->due) && (!b->lattice || is_lattice(c, b, periods))) return true;
  }
  periods->due = false;
  return false;
}

/* By all peaks that are near whole multiples of it. */
static void refine_row(const rc_peak *peaks, int count, rc_copy *row) {
  double square = (double)row->a * row->a + (double)row->b * row->b, kk = 0, kx = 0, ky = 0;
  for (int n = 0; n < count; n++) {
    const rc_peak *at = &peaks[n];
    double k = rc_round((float)((at->x * row->a + at->y * row->b) / square));
    if (!is_regular(&by_row, at) || fabs(at->x - k * row->a) > MOST_OFF_PX ||
        fabs(at->y - k * row->b) > MOST_OFF_PX)
      continue;
    kk += k * k, kx += k * at->x, ky += k * at->y;
  }
  *row = (rc_copy){(float)(kx / kk), (float)(ky / kk), 0}; /* it is one of them */
}

/* The shortest period of what repeats clearly, one way; if there is one it is due. */
static void find_row(const rc_correlation *c, const rc_peak *peaks, int count,
                     rc_periods *periods) {
  float shortest = INFINITY;
  for (int i = 0; i < count; i++) {
    const rc_peak *p = &peaks[i];
    float px = sqrtf(p->x * p->x + p->y * p->y);
    if (!is_regular(&by_row, p) || px >= shortest || px < LEAST_ROW_PX) continue;
    shortest = px;
    periods->base[0] = (rc_copy){p->x, p->y, 0};
  }
  if (shortest == INFINITY) return;
  refine_row(peaks, count, &periods->base[0]);
  periods->row = true; /* as holds_beside asks */
  periods->row = periods->due = holds_beside(c, &by_row, periods);
}

static void take_peaks(const rc_peak *peaks, int count, rc_periods *periods) {
  for (int i = 0; i < count; i++)
    periods->repeats =
        periods->repeats ||
        (peaks[i].inside && (peaks[i].value >= REPEATS || peaks[i].rise >= REPEATS_BY_RISE));
  for (int i = 0; i < count && periods->count + 1 < RC_MOST_PERIODS; i++) {
    periods->copies[periods->count++] = (rc_copy){peaks[i].x, peaks[i].y, 0.f};
    periods->copies[periods->count++] = (rc_copy){-peaks[i].x, -peaks[i].y, 0.f};
  }
}

static recede_status find_by_joints(rc_context *context, rc_correlation *c, int lag,
                                    rc_periods *periods) {
  rc_peak *peaks;
  int count;
  float *joint;
  const rc_level *level = c->level;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &joint));
  RC_TRY(take_joints(context, level, c->trait, joint));
  c->trait = joint;
  RC_TRY(rc_correlate(context, c, lag, &peaks, &count));
  periods->by_joints = find_regular(c, &by_joints, peaks, count, periods);
  periods->regular = periods->by_joints;
  periods->due = false; /* that is told by more than joints */
  return RECEDE_OK;
}

/* By all that the pixels show. *row: where nothing is regular there may be a row. */
static recede_status find_by_all(rc_context *context, rc_correlation *c, int third, int half,
                                 bool regular, rc_periods *periods, rc_periods *row) {
  rc_peak *peaks;
  int count;
  RC_TRY(rc_correlate(context, c, third, &peaks, &count));
  take_peaks(peaks, count, periods);
  *row = *periods;
  if (!regular) return RECEDE_OK;
  periods->clear = find_regular(c, &by_bars, peaks, count, periods);
  periods->regular = periods->clear || find_regular(c, &by_all, peaks, count, periods);
  if (periods->regular) return RECEDE_OK;
  find_row(c, peaks, count, row);
  if (!count || peaks[0].value < REPEATS || half <= third) return RECEDE_OK;
  RC_TRY(rc_correlate(context, c, half, &peaks, &count));
  periods->clear = find_regular(c, &by_bars, peaks, count, periods);
  periods->regular = periods->clear || find_regular(c, &by_cells, peaks, count, periods);
  return RECEDE_OK;
}

recede_status rc_find_periods(rc_context *context, const rc_level *level, int shorter_px,
                              uint64_t key, int count, bool regular, bool joints,
                              rc_periods *periods) {
  size_t pixels = (size_t)level->width * (size_t)level->height;
  int third = shorter_px / 3 < MOST_LAG_PX ? shorter_px / 3 : MOST_LAG_PX;
  int half = shorter_px / 2 < MOST_LAG_PX ? shorter_px / 2 : MOST_LAG_PX;
  rc_correlation c;
  rc_periods row;
  float *trait;
  *periods = (rc_periods){.count = 0};
  if (rc_level_all_sources(level).end < LEAST_SOURCES * count || third < LEAST_THIRD_PX)
    return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &trait));
  for (size_t i = 0; i < pixels; i++) trait[i] = rc_level_trait(level, (int)i);
  RC_TRY(rc_correlation_new(context, level, trait, key, count, &c));
  RC_TRY(find_by_all(context, &c, third, half, regular, periods, &row));
  if (!periods->regular && regular && joints) RC_TRY(find_by_joints(context, &c, third, periods));
  if (!periods->regular && row.row) *periods = row;
  rc_release(context, mark);
  return RECEDE_OK;
}
