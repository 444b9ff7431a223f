#include "synthesis/structure/tracks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"

/* Bands are broader than so many cells of a plan, and narrower than half of the hole. */
#define NARROWEST 5
#define WIDEST (RC_PLAN_HOLE / 2)
/* Dashes and studs of a road make no bands: what is off by more than so many times the median
 * counts as that. */
#define TIMES_MEDIAN 3.f
/* What lies so much of the hole's length apart along a band is alike, anywhere; and so is what lies
 * on both sides of the hole. Correlations: docs/measured.md. */
#define APART .75f
#define LEAST_APART 4.f
#define LEAST_ALIKE .5
#define LEAST_ALIKE_ACROSS .6
/* Directions that are asked, and then around the best of them. */
#define DIRECTIONS 60
#define AROUND 5
/* Broad as they are, every second cell tells enough. */
#define STRIDE 2
/* From so few pairs a correlation says nothing. */
#define LEAST_PAIRS 100
#define PAIRS_OF_HOLE 2
/* Of the brightness around: a road's wheel tracks are .02 of it. What is stronger, as the lit and
 * the dark side of a dune, .25, is a thing that copies show. */
#define FAINT .08
/* The bands fade out at the plan's end, where nothing is known of them. */
#define FADE 16
/* A cell of which less is known has no band. */
#define LEAST_KNOWN .01f

static float limit_of(const rc_plan *plan, const rc_plan *wide, int channel, float *scratch) {
  int count = 0;
  size_t each = (size_t)plan->channels + 1, k = (size_t)channel;
  for (size_t i = 0; i < RC_PLAN_CELLS * each; i += each)
    if (plan->sums[i + each - 1] > 0.f)
      scratch[count++] = fabsf(plan->sums[i + k] - wide->sums[i + k] / wide->sums[i + each - 1]);
  if (!count) return 0.f;
  qsort(scratch, (size_t)count, sizeof *scratch, rc_by_value);
  return TIMES_MEDIAN * scratch[count / 2];
}

/* What is left of each cell without the tone of all around it, and no more than the limit. */
static recede_status keep_rest(rc_context *context, bool limited, rc_plan *plan) {
  rc_plan wide;
  float *scratch;
  size_t each = (size_t)plan->channels + 1;
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_plan_smooth(context, plan, WIDEST, WIDEST, &wide));
  RC_TRY(RC_NEW(context, RC_PLAN_CELLS, &scratch));
  for (size_t k = 0; k + 1 < each; k++) {
    float limit = limited ? limit_of(plan, &wide, (int)k, scratch) : INFINITY;
    for (size_t i = 0; i < RC_PLAN_CELLS * each; i += each) {
      if (!(plan->sums[i + each - 1] > 0.f)) continue;
      float rest = plan->sums[i + k] - wide.sums[i + k] / wide.sums[i + each - 1];
      plan->sums[i + k] = fminf(fmaxf(rest, -limit), limit);
    }
  }
  rc_release(context, mark);
  return rc_poll(context);
}

/* The broad tone at the cells that are known. */
static recede_status broad_tone(rc_context *context, const rc_plan *rest, rc_plan *tone) {
  size_t each = (size_t)rest->channels + 1;
  RC_TRY(rc_plan_smooth(context, rest, NARROWEST, NARROWEST, tone));
  for (size_t i = 0; i < RC_PLAN_CELLS * each; i += each) {
    for (size_t k = 0; k + 1 < each && tone->sums[i + each - 1] > 0.f; k++)
      tone->sums[i + k] /= tone->sums[i + each - 1];
    for (size_t k = 0; k < each; k++)
      tone->sums[i + k] = rest->sums[i + each - 1] > 0.f ? tone->sums[i + k] : 0.f;
    tone->sums[i + each - 1] = rest->sums[i + each - 1];
  }
  return keep_rest(context, false, tone);
}

/* Of pairs of cells, over all channels. */
typedef struct correlation {
  double p[3], q[3], pp, pq, qq, pairs;
} correlation;

static double value_of(const correlation *c) {
  double pp = c->pp, pq = c->pq, qq = c->qq;
  if (c->pairs < LEAST_PAIRS) return 0;
  for (int k = 0; k < 3; k++) {
    pp -= c->p[k] * c->p[k] / c->pairs;
    pq -= c->p[k] * c->q[k] / c->pairs;
    qq -= c->q[k] * c->q[k] / c->pairs;
  }
  return pp > 0 && qq > 0 ? pq / sqrt(pp * qq) : 0;
}

/* Cells so far apart; hole: only with the hole between them. */
static void correlate(const rc_plan *tone, const rc_plan *hole, int dx, int dy, correlation *c) {
  for (int y = dy < 0 ? -dy : 0; y < RC_PLAN_SIDE - (dy > 0 ? dy : 0); y += STRIDE)
    for (int x = dx < 0 ? -dx : 0; x < RC_PLAN_SIDE - (dx > 0 ? dx : 0); x += STRIDE) {
      const float *p = rc_plan_cell(tone, x, y), *q = rc_plan_cell(tone, x + dx, y + dy);
      if (!(p[tone->channels] > 0.f && q[tone->channels] > 0.f)) continue;
      if (hole && !(*rc_plan_cell(hole, x + dx / 2, y + dy / 2) > 0.f)) continue;
      c->pairs++;
      for (int k = 0; k < tone->channels; k++) {
        double v = (double)p[k], w = (double)q[k];
        c->p[k] += v, c->q[k] += w, c->pp += v * v, c->pq += v * w, c->qq += w * w;
      }
    }
}

static float length_of(const rc_plan *hole, float a, float b) {
  float low = INFINITY, high = -INFINITY;
  for (int y = 0; y < RC_PLAN_SIDE; y += STRIDE)
    for (int x = 0; x < RC_PLAN_SIDE; x += STRIDE) {
      if (!(*rc_plan_cell(hole, x, y) > 0.f)) continue;
      float along = a * (float)x + b * (float)y;
      low = fminf(low, along), high = fmaxf(high, along);
    }
  return fmaxf(high - low, 0.f);
}

static void correlate_along(const rc_plan *tone, const rc_plan *hole, float a, float b, float apart,
                            correlation *c) {
  correlate(tone, hole, (int)rc_round(a * apart), (int)rc_round(b * apart), c);
}

typedef struct direction {
  double a, b;
  float alike, across;
} direction;

static direction turned(direction d, double cosine, double sine) {
  return (direction){d.a * cosine - d.b * sine, d.a * sine + d.b * cosine, 0, 0};
}

typedef struct asking {
  const rc_plan *tone, *hole;
  double cells;
  direction directions[DIRECTIONS];
} asking;

/* How alike is what lies along a direction: so much of the hole's length apart, anywhere, and on
 * both sides of the hole. */
static void ask_direction(void *user, int item, int thread) {
  asking *s = user;
  direction *d = &s->directions[item];
  float a = (float)d->a, b = (float)d->b, length = length_of(s->hole, a, b);
  correlation all = {.pairs = 0}, across = {.pairs = 0};
  (void)thread;
  d->alike = d->across = 0;
  correlate_along(s->tone, NULL, a, b, APART * length + LEAST_APART, &all);
  if (PAIRS_OF_HOLE * STRIDE * STRIDE * all.pairs < s->cells) return;
  for (int quarters = 4; quarters <= 6; quarters++)
    correlate_along(s->tone, s->hole, a, b, length * (float)quarters / 4, &across);
  d->alike = (float)value_of(&all), d->across = (float)value_of(&across);
}

/* The best of so many, each turned by as much. */
static recede_status ask_directions(rc_context *context, asking *s, direction first, double cosine,
                                    double sine, int count, rc_tracks *tracks) {
  for (int i = 0; i < count; i++, first = turned(first, cosine, sine)) s->directions[i] = first;
  RC_TRY(rc_parallel(context, count, ask_direction, s));
  for (int i = 0; i < count; i++) {
    const direction *d = &s->directions[i];
    if (d->alike + d->across <= tracks->alike + tracks->across) continue;
    tracks->alike = d->alike, tracks->across = d->across;
    tracks->tone.a = (float)d->a, tracks->tone.b = (float)d->b;
  }
  return RECEDE_OK;
}

/* The direction along which the tone stays most the same: all, 3 degrees apart, then around the
 * best, 1 degree apart. */
static recede_status find_direction(rc_context *context, const rc_plan *tone, const rc_plan *hole,
                                    rc_tracks *tracks) {
  const double c3 = .99862953475457387, s3 = .052335956242943833; /* of 3 degrees */
  const double c1 = .99984769515639127, s1 = .017452406437283512; /* of 1 */
  asking s = {.tone = tone, .hole = hole};
  for (int i = 0; i < RC_PLAN_CELLS; i++) s.cells += hole->sums[i] > 0.f ? 1 : 0;
  RC_TRY(ask_directions(context, &s, (direction){1, 0, 0, 0}, c3, s3, DIRECTIONS, tracks));
  direction best = {(double)tracks->tone.a, (double)tracks->tone.b, 0, 0};
  best = turned(turned(best, c1, -s1), c1, -s1);
  return ask_directions(context, &s, best, c1, s1, AROUND, tracks);
}

static double strength_of(const rc_plan *tone) {
  size_t each = (size_t)tone->channels + 1;
  double square = 0, count = 0;
  for (size_t i = 0; i < RC_PLAN_CELLS * each; i += each)
    for (size_t k = 0; k + 1 < each && tone->sums[i + each - 1] > 0.f; k++, count++)
      square += (double)tone->sums[i + k] * (double)tone->sums[i + k];
  return sqrt(square / fmax(count, 1));
}

/* Of a line of the plan: 0 at its ends. */
static float fade_of(int i) {
  int end = i < RC_PLAN_SIDE - 1 - i ? i : RC_PLAN_SIDE - 1 - i;
  return end < FADE ? (float)end / FADE : 1.f;
}

static void set_bands(rc_plan *tone) {
  for (int y = 0; y < RC_PLAN_SIDE; y++)
    for (int x = 0; x < RC_PLAN_SIDE; x++) {
      float *sums = rc_plan_cell(tone, x, y), known = sums[tone->channels];
      for (int k = 0; k < tone->channels; k++)
        sums[k] = known > LEAST_KNOWN ? sums[k] / known * fade_of(x) * fade_of(y) : 0.f;
    }
}

/* The coarsest level that has a pixel for each cell of the hole. */
static int level_of(const rc_mask *flags, int levels) {
  int exponent = 0;
  while (exponent + 1 < levels &&
         rc_longer_side(rc_box_of(&flags[exponent + 1], RC_TARGET)) >= RC_PLAN_HOLE)
    exponent++;
  return exponent;
}

recede_status rc_tracks_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                             int levels, const rc_chart *chart, double brightness,
                             rc_tracks *tracks) {
  int exponent = level_of(flags, levels);
  const rc_image *image = &images[exponent];
  const rc_mask *own = &flags[exponent];
  rc_chart coarser = rc_chart_coarser(*chart, exponent);
  rc_plan seen, hole, tone;
  float *bands;
  *tracks = (rc_tracks){.alike = 0};
  RC_TRY(RC_NEW(context, RC_PLAN_CELLS * (image->channels + 1), &bands));
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_plan_place(context, own, &coarser, exponent, &tracks->tone));
  hole = seen = tracks->tone;
  RC_TRY(rc_plan_gather(context, NULL, own, RC_TARGET, &coarser, exponent, &hole));
  RC_TRY(rc_plan_gather(context, image, own, RC_SOURCE, &coarser, exponent, &seen));
  RC_TRY(keep_rest(context, true, &seen));
  RC_TRY(broad_tone(context, &seen, &tone));
  RC_TRY(find_direction(context, &tone, &hole, tracks));
  if (tracks->alike >= LEAST_ALIKE && tracks->across >= LEAST_ALIKE_ACROSS &&
      strength_of(&tone) <= FAINT * brightness) {
    seen = tracks->tone;
    RC_TRY(rc_plan_gather(context, image, own, RC_SOURCE, &coarser, exponent, &seen));
    RC_TRY(keep_rest(context, true, &seen));
    RC_TRY(rc_plan_smooth(context, &seen, WIDEST, NARROWEST, &tracks->tone));
    set_bands(&tracks->tone);
    memcpy(bands, tracks->tone.sums, RC_PLAN_CELLS * (size_t)(image->channels + 1) * sizeof *bands);
    tracks->tone.sums = bands;
  }
  rc_release(context, mark);
  return RECEDE_OK;
}

typedef struct application {
  const rc_plan *plan;
  const rc_chart *chart;
  int exponent;
  const rc_mask *flags;
  uint8_t flag;
  float sign;
  rc_image *image;
} application;

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  const rc_plan *plan = a->plan;
  (void)thread;
  for (int x = 0; x < a->image->width; x++) {
    float column, row;
    if (!(*rc_flag(a->flags, x, y) & a->flag) ||
        !rc_plan_at(plan, a->chart, a->exponent, x, y, &column, &row))
      continue;
    if (!(column >= 0.f && row >= 0.f && column < RC_PLAN_SIDE - 1 && row < RC_PLAN_SIDE - 1))
      continue;
    int i = (int)column, j = (int)row;
    const float *upper = rc_plan_cell(plan, i, j), *lower = rc_plan_cell(plan, i, j + 1);
    float right = column - (float)i, down = row - (float)j;
    float *pixel = rc_pixel(a->image, x, y);
    for (int k = 0, next = plan->channels + 1; k < plan->channels; k++, next++) {
      float above = upper[k] + (upper[next] - upper[k]) * right;
      float below = lower[k] + (lower[next] - lower[k]) * right;
      pixel[k] += a->sign * (above + (below - above) * down);
    }
  }
}

recede_status rc_tracks_apply(rc_context *context, const rc_tracks *tracks, const rc_chart *chart,
                              int exponent, const rc_mask *flags, uint8_t flag, float sign,
                              rc_image *image) {
  application a = {&tracks->tone, chart, exponent, flags, flag, sign, image};
  if (!tracks->tone.sums) return RECEDE_OK;
  return rc_parallel(context, image->height, apply_row, &a);
}
