/* Shape from texture by spectral homogeneity. A texture's power spectrum S in plane coordinates is
 * the same everywhere; the picture shows it through the local affine map J of the plane's
 * coordinates u = (x - x0) / w (so k_image = J^T k_plane) with its density divided by det J. So:
 * pull each cell's spectrum back to the plane, and see how far they differ from their mean.
 * Directions converge, textures coarsen and flatten: all of it is in J, and nothing is assumed
 * about the texture but that it is the same everywhere; neither isotropy nor lines. Contrast varies
 * over a picture, scale does it too: half a cell's mean deviation is excused. */
#include "plane/homogeneity.h"

#include <math.h>

#include "base/memory.h"
#include "plane/approximate.h"

/* The plane's spectrum is compared at half the density of the measured ones. */
#define STEPS (RC_SPECTRA_STEPS / 2)
#define TURNS (RC_SPECTRA_DIRECTIONS / 2)
#define BINS (STEPS * TURNS)
_Static_assert(BINS % 4 == 0, "four at once");

#define EXCUSED_CONTRAST .5f
#define ROUNDS 4
/* Cells that have too few values in common with the rest speak against the plane, as a third of a
 * misfit: were they free, the best planes would be those that leave nothing to compare. At .15 they
 * were, at .5 true planes of slant 70 suffered. So do those beyond the horizon; no more where there
 * may well be a sky, for at .5 dunes were a ceiling's far end. Both cost more where somebody chose
 * what lies on the plane. Of all weight a share must speak. */
#define LEAST_BINS 20
#define MISSING_COST .35
#define SKY_COST .35
#define CHOSEN_MISSING_COST .5
#define CHOSEN_HORIZON_COST .8
#define LEAST_SHARE .3

/* Scratch: values[count][BINS], there[count][BINS] (1 or 0), then what follows. */
typedef struct work {
  float *values, *there, *mean, *importance, *total, *contrast, *misfit, *trust, *bins;
} work;

static size_t per_cell(void) { return 2 * BINS + 4; }

size_t rc_homogeneity_scratch(const rc_homogeneity *h) {
  return ((size_t)h->spectra->count * per_cell() + 3 * BINS) * sizeof(float);
}

static work lay_out(float *scratch, size_t count) {
  work w;
  w.values = scratch;
  w.there = w.values + count * BINS;
  w.mean = w.there + count * BINS;
  w.importance = w.mean + BINS;
  w.total = w.importance + BINS;
  w.contrast = w.total + BINS;
  w.misfit = w.contrast + count;
  w.trust = w.misfit + count;
  w.bins = w.trust + count;
  return w;
}

/* Of the bins. */
typedef struct frequencies {
  rc_four x[BINS / 4], y[BINS / 4];
} frequencies;

/* Bilinear in log frequency and direction; NaN outside what was measured. */
static float power_at(const rc_spectrum *cell, float step, float turn) {
  if (!(step >= 0 && step <= RC_SPECTRA_STEPS - 1)) return NAN;
  int s = (int)step, t = (int)turn;
  if (s > RC_SPECTRA_STEPS - 2) s = RC_SPECTRA_STEPS - 2;
  if (t > RC_SPECTRA_DIRECTIONS - 1) t = RC_SPECTRA_DIRECTIONS - 1;
  float v = step - (float)s, u = turn - (float)t;
  const float *low = &(*cell)[s][t], *high = &(*cell)[s + 1][t];
  return (1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]);
}

/* dx, dy from the reference; w there is 1, its gradient l. Returns how many bins it filled. */
static int pull_back(const rc_spectrum *cell, const frequencies *plane, float dx, float dy, float w,
                     const float l[2], bool raised, float *values, float *there) {
  const float lowest = -1.4739311883f - 4; /* log2 .36 - 4 octaves */
  rc_four step[BINS / 4], turn[BINS / 4];
  float a = 1 / w, b = 0, c = 0, d = 1 / w;
  if (!raised) {
    a -= dx * l[0] / (w * w), b -= dx * l[1] / (w * w);
    c -= dy * l[0] / (w * w), d -= dy * l[1] / (w * w);
  }
  float density = rc_log2(fabsf(a * d - b * c));
  int count = 0;
  for (int i = 0; i < BINS / 4; i++) {
    rc_four kx = a * plane->x[i] + c * plane->y[i];
    rc_four ky = b * plane->x[i] + d * plane->y[i];
    step[i] = (.5f * rc_log2_of_four(kx * kx + ky * ky) - lowest) * RC_SPECTRA_PER_OCTAVE - .5f;
    turn[i] = rc_half_turns_of_four(kx, ky) * RC_SPECTRA_DIRECTIONS;
  }
  for (int i = 0; i < BINS; i++) {
    float value = power_at(cell, step[i / 4][i % 4], turn[i / 4][i % 4]) + density;
    bool known = isfinite(value);
    values[i] = known ? value : 0;
    there[i] = known ? 1 : 0;
    count += known;
  }
  return count;
}

static void fill_frequencies(frequencies *to) {
  for (int s = 0; s < STEPS; s++)
    for (int t = 0; t < TURNS; t++) {
      double k = RC_SPECTRA_LOWEST * exp2((s + .5) * RC_SPECTRA_OCTAVES / STEPS);
      int i = s * TURNS + t;
      to->x[i / 4][i % 4] = (float)(k * cos(M_PI * t / TURNS));
      to->y[i / 4][i % 4] = (float)(k * sin(M_PI * t / TURNS));
    }
}

/* Pulls every cell back; trust 0 and misfit NaN or infinite where nothing can be compared. */
static bool sample(const rc_homogeneity *h, rc_lean lean, const work *to) {
  frequencies plane;
  double n[3], f = h->focal_px;
  rc_lean_normal(lean, n);
  double w0 =
      (n[0] * (h->ref_x - .5 * (h->width - 1)) + n[1] * (h->ref_y - .5 * (h->height - 1))) / f +
      n[2];
  if (w0 < .02) return false;
  const float l[2] = {(float)(n[0] / (f * w0)), (float)(n[1] / (f * w0))};
  fill_frequencies(&plane);
  for (int i = 0; i < h->spectra->count; i++) {
    float dx = h->spectra->x[i] - (float)h->ref_x, dy = h->spectra->y[i] - (float)h->ref_y;
    float w = 1 + l[0] * dx + l[1] * dy;
    to->contrast[i] = 0;
    to->misfit[i] = INFINITY;
    to->trust[i] = 0;
    if (w < (float)RC_RESOLVED_W) continue;
    int bins = pull_back(&h->spectra->power[i], &plane, dx, dy, w, l, h->raised,
                         to->values + (size_t)i * BINS, to->there + (size_t)i * BINS);
    to->misfit[i] = NAN;
    to->trust[i] = bins >= LEAST_BINS ? 1 : 0;
  }
  return true;
}

/* The texture's spectrum: the cells' weighted mean. */
static void take_mean(const rc_homogeneity *h, const work *w) {
  for (int b = 0; b < BINS; b++) w->mean[b] = 0, w->total[b] = 1e-9f;
  for (int i = 0; i < h->spectra->count; i++) {
    float weight = h->weight[i] * w->trust[i], excuse = EXCUSED_CONTRAST * w->contrast[i];
    if (weight == 0) continue;
    const float *values = w->values + (size_t)i * BINS, *there = w->there + (size_t)i * BINS;
    for (int b = 0; b < BINS; b++) {
      w->mean[b] += weight * there[b] * (values[b] - excuse);
      w->total[b] += weight * there[b];
    }
  }
  for (int b = 0; b < BINS; b++) w->mean[b] /= w->total[b];
}

/* Directions far weaker than the strongest of their frequency hold what leaks out of the window's
 * transform, fixed to the picture. */
static void take_importance(const work *w) {
  for (int s = 0; s < STEPS; s++) {
    const float *mean = w->mean + s * TURNS;
    float *importance = w->importance + s * TURNS, strongest = mean[0];
    for (int t = 1; t < TURNS; t++) strongest = fmaxf(strongest, mean[t]);
    for (int t = 0; t < TURNS; t++) {
      float below = strongest - mean[t];
      importance[t] = 1 / (1 + below * (.2f + below * .03f)); /* about 2^(-.3 below) */
    }
  }
}

static float dot(const float *a, const float *b, const float *c) {
  float product[BINS], sum = 0;
  for (int i = 0; i < BINS; i++) product[i] = a[i] * b[i] * c[i];
  for (int i = 0; i < BINS; i++) sum += product[i];
  return sum;
}

static void judge_cell(const rc_homogeneity *h, const work *w, int i) {
  const float *values = w->values + (size_t)i * BINS, *there = w->there + (size_t)i * BINS;
  float residual[BINS], excuse, weight = 1e-6f, sum = 0, square = 0;
  for (int b = 0; b < BINS; b++) residual[b] = values[b] - w->mean[b];
  weight += dot(there, w->importance, there);
  sum = dot(there, w->importance, residual);
  w->contrast[i] = sum / weight;
  excuse = EXCUSED_CONTRAST * w->contrast[i];
  for (int b = 0; b < BINS; b++) {
    float left = residual[b] - excuse;
    residual[b] = there[b] * w->importance[b] * left * left;
  }
  for (int b = 0; b < BINS; b++) square += residual[b];
  w->misfit[i] = square / weight;
  float ratio = w->misfit[i] / h->saturation;
  w->trust[i] = 1 / (1 + ratio * ratio);
}

static double total_cost(const rc_homogeneity *h, const work *w) {
  double judged = 0, judged_cost = 0, missing = 0, beyond = 0;
  for (int i = 0; i < h->spectra->count; i++) {
    double weight = h->weight[i], misfit = w->misfit[i];
    if (isnan(misfit)) {
      missing += weight;
    } else if (isinf(misfit)) {
      beyond += weight;
    } else {
      judged += weight;
      judged_cost += weight * misfit / (1 + misfit / h->saturation);
    }
  }
  double all = judged + missing + beyond;
  if (judged < LEAST_SHARE * all || judged == 0) return RC_IMPOSSIBLE;
  double missing_cost = h->chosen ? CHOSEN_MISSING_COST : MISSING_COST;
  double horizon_cost = h->chosen ? CHOSEN_HORIZON_COST : SKY_COST;
  return (judged_cost + h->saturation * (missing * missing_cost + beyond * horizon_cost)) / all;
}

double rc_homogeneity_cost(const rc_homogeneity *h, rc_lean lean, float *scratch, float *misfit) {
  int count = h->spectra->count;
  work w = lay_out(scratch, (size_t)count);
  if (!sample(h, lean, &w)) return RC_IMPOSSIBLE;
  for (int round = 0; round < ROUNDS; round++) {
    take_mean(h, &w);
    take_importance(&w);
    for (int i = 0; i < count; i++)
      if (w.trust[i] > 0) judge_cell(h, &w, i);
  }
  for (int i = 0; misfit && i < count; i++) misfit[i] = w.misfit[i];
  return total_cost(h, &w);
}

static float median(float *values, int count) {
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && values[j] < values[j - 1]; j--) {
      float held = values[j];
      values[j] = values[j - 1];
      values[j - 1] = held;
    }
  return values[count / 2];
}

recede_status rc_homogeneity_saturate(rc_context *context, rc_homogeneity *h, float *scratch) {
  int known = 0;
  float *misfit;
  RC_TRY(RC_NEW(context, h->spectra->count, &misfit));
  h->saturation = 1e9f;
  rc_homogeneity_cost(h, (rc_lean){0, 0}, scratch, misfit);
  for (int i = 0; i < h->spectra->count; i++)
    if (isfinite(misfit[i])) misfit[known++] = misfit[i];
  h->saturation = known ? fmaxf(2 * median(misfit, known), 1e-3f) : 1;
  return RECEDE_OK;
}
