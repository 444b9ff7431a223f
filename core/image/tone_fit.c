/* A wide Gaussian was tried first: it takes planks', crests' and ripples' own tone away. A linear
 * trend leaves a dark middle where a photo is brightest in its own middle. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/cholesky.h"
#include "base/memory.h"
#include "image/trend.h"

/* Part of the variance that a trend must explain: below, it is lost in the texture. */
#define LEAST_EXPLAINED .3
/* Light makes all colours brighter alike, or nearly: where more than this part of what trends
 * spread by is colour they are of things, as of red hens to one side of a lawn, and so is the
 * colour. Dunes, tea, piers and a ruin .02 .. .13; a tree before a brick wall .14, hens .28, lit
 * columns .30 .. .38. */
#define MOST_COLOURED .133
/* Least squares bend a trend across the step between a dark pier and bright water until it fits
 * neither. One that is fitted to what neighbouring places differ by, steps left out, is taken where
 * it explains so much more of that, and beside the hole more and so much of it: the pier .04 to .16
 * more, and .10 to .56; dunes, tea and fields one or none of both. Of the variance it may explain
 * little, for most of that are the things. */
#define LEAST_BETTER .02
#define LEAST_BETTER_BESIDE .1
/* A place counts if such a part of it are samples; and a trend needs so many differences. */
#define LEAST_OF_PLACE .25
#define LEAST_DIFFERENCES 20
/* Of the weights that leave steps out; six decimals stay as they are after so many. */
#define ROUNDS 15
#define TERMS RC_TONE_TERMS

/* The normal equations: the sources' terms with each other, and with each channel's values. */
typedef struct sums {
  double product[TERMS][TERMS], value[3][TERMS], square;
} sums;

static void add(sums *s, const double terms[TERMS], const float *pixel, int channels) {
  for (int i = 0; i < TERMS; i++)
    for (int j = 0; j <= i; j++) s->product[i][j] += terms[i] * terms[j];
  for (int k = 0; k < channels; k++) {
    s->square += (double)pixel[k] * pixel[k];
    for (int i = 0; i < TERMS; i++) s->value[k][i] += terms[i] * pixel[k];
  }
}

static void gather(const rc_samples *samples, rc_tone *tone, sums *s) {
  const rc_image *image = samples->image;
  double terms[TERMS];
  rc_box all = {0, 0, image->width, image->height}, *box = &tone->box;
  int step = rc_sample_step(all);
  *box = (rc_box){image->width, image->height, 0, 0};
  for (int y = 0; y < image->height; y += step)
    for (int x = 0; x < image->width; x += step) {
      if (!rc_is_sample(samples, x, y)) continue;
      if (x < box->x0) box->x0 = x;
      if (x >= box->x1) box->x1 = x + 1;
      if (y < box->y0) box->y0 = y;
      box->y1 = y + 1;
      rc_tone_terms(tone, x, y, terms);
      add(s, terms, rc_pixel(image, x, y), image->channels);
    }
}

/* Part of the variance about the mean that the terms explain. */
static double explained(const rc_tone *tone, const sums *s) {
  double fitted = 0, mean = 0;
  for (int k = 0; k < tone->channels; k++) {
    mean += s->value[k][0] * s->value[k][0] / s->product[0][0];
    for (int i = 0; i < TERMS; i++) fitted += tone->terms[k][i] * s->value[k][i];
  }
  return s->square > mean ? (fitted - mean) / (s->square - mean) : 0;
}

/* By how much the trends spread the samples, squared. */
static double spread_of(const rc_tone *tone, const sums *s) {
  double spread = 0;
  for (int k = 0; k < tone->channels; k++)
    for (int i = 1; i < TERMS; i++)
      for (int j = 1; j < TERMS; j++) {
        double product = s->product[i > j ? i : j][i > j ? j : i];
        double means = s->product[i][0] * s->product[j][0] / s->product[0][0];
        spread += tone->terms[k][i] * tone->terms[k][j] * (product - means);
      }
  return spread;
}

/* Makes a channel's mean over the samples what it is. */
static void set_mean(const sums *s, int channel, rc_tone *tone) {
  double *terms = tone->terms[channel], count = s->product[0][0];
  terms[0] = s->value[channel][0] / count;
  for (int i = 1; i < TERMS; i++) terms[0] -= terms[i] * s->product[i][0] / count;
}

/* Takes from coloured trends all but what lies along the mean colour. Where that is negative, as
 * floats may be, it is no colour. */
static void keep_light(rc_tone *tone, const sums *s) {
  double colour[3] = {0, 0, 0}, square = 0;
  rc_tone light = *tone;
  for (int k = 0; k < tone->channels; k++) {
    colour[k] = s->value[k][0] / s->product[0][0], square += colour[k] * colour[k];
    if (tone->channels == 1 || !(colour[k] > 0)) return;
  }
  for (int i = 1; i < TERMS; i++) {
    double sum = 0;
    for (int k = 0; k < tone->channels; k++) sum += colour[k] * tone->terms[k][i];
    for (int k = 0; k < tone->channels; k++) light.terms[k][i] = colour[k] * sum / square;
  }
  for (int k = 0; k < tone->channels; k++) set_mean(s, k, &light);
  if (spread_of(&light, s) < (1 - MOST_COLOURED) * spread_of(tone, s)) *tone = light;
}

static bool fit_squares(const sums *s, rc_tone *tone) {
  double factored[TERMS][TERMS];
  memcpy(factored, s->product, sizeof factored);
  if (!rc_factor(TERMS, factored[0])) return false;
  for (int k = 0; k < tone->channels; k++) {
    memcpy(tone->terms[k], s->value[k], sizeof s->value[k]);
    rc_substitute(TERMS, factored[0], tone->terms[k]);
  }
  keep_light(tone, s);
  return true;
}

#define MOST_DIFFERENCES (2 * RC_PLACES * RC_PLACES)

/* What places differ by from their neighbours, and the squares of what a trend leaves of that. */
typedef struct differences {
  int count;
  rc_tone_place of[MOST_DIFFERENCES];
  double left[MOST_DIFFERENCES], sorted[MOST_DIFFERENCES];
  rc_tone_places places;
} differences;

static void add_difference(const rc_tone_place *p, const rc_tone_place *q, double least,
                           differences *d) {
  if (p->count < least || q->count < least || !rc_places_differ(p, q, &d->of[d->count])) return;
  d->left[d->count++] = 0;
}

static void find_differences(const rc_samples *samples, const rc_tone *tone, differences *d) {
  rc_tone_places *places = &d->places;
  rc_box box = tone->box;
  double step = rc_sample_step(box), area = (double)(box.x1 - box.x0) * (box.y1 - box.y0);
  double least = LEAST_OF_PLACE * area / (step * step) / (RC_PLACES * RC_PLACES);
  d->count = 0;
  rc_places_sum(samples, tone, box, RC_PLACES, places);
  for (int y = 0; y < RC_PLACES; y++)
    for (int x = 0; x < RC_PLACES; x++) {
      if (x + 1 < RC_PLACES) add_difference(&places->of[y][x], &places->of[y][x + 1], least, d);
      if (y + 1 < RC_PLACES) add_difference(&places->of[y][x], &places->of[y + 1][x], least, d);
    }
}

static int by_size(const void *a, const void *b) {
  const double *p = a, *q = b;
  return (*p > *q) - (*p < *q);
}

/* Least squares, where a difference counts 1 / (1 + left / usual); all terms but the first. */
static bool fit_weighted(const differences *d, double usual, rc_tone *tone) {
  enum { SLOPES = TERMS - 1 };
  double product[SLOPES][SLOPES] = {{0}}, value[3][SLOPES] = {{0}};
  for (int n = 0; n < d->count; n++) {
    double weight = 1 / (1 + d->left[n] / usual);
    const double *slope = d->of[n].terms + 1;
    for (int i = 0; i < SLOPES; i++) {
      for (int j = 0; j <= i; j++) product[i][j] += weight * slope[i] * slope[j];
      for (int k = 0; k < tone->channels; k++) value[k][i] += weight * slope[i] * d->of[n].value[k];
    }
  }
  if (!rc_factor(SLOPES, product[0])) return false;
  for (int k = 0; k < tone->channels; k++) {
    rc_substitute(SLOPES, product[0], value[k]);
    memcpy(tone->terms[k] + 1, value[k], sizeof value[k]);
  }
  return true;
}

/* Gets what the trend leaves, and of that the median. */
static double measure_left(const rc_tone *tone, differences *d) {
  double *sorted = d->sorted;
  for (int n = 0; n < d->count; n++) {
    d->left[n] = 0;
    for (int k = 0; k < tone->channels; k++) {
      double off = d->of[n].value[k] - rc_tone_value(tone, k, d->of[n].terms);
      d->left[n] += off * off;
    }
  }
  memcpy(sorted, d->left, (size_t)d->count * sizeof *sorted);
  qsort(sorted, (size_t)d->count, sizeof *sorted, by_size);
  return fmax(sorted[d->count / 2], 1e-12);
}

/* A trend that steps do not bend. False: too little is known. */
static bool fit_between_steps(const rc_samples *samples, const sums *s, differences *d,
                              rc_tone *tone) {
  double usual = 1;
  find_differences(samples, tone, d);
  if (d->count < LEAST_DIFFERENCES) return false;
  for (int round = 0; round < ROUNDS; round++) {
    if (!fit_weighted(d, usual, tone)) return false;
    usual = measure_left(tone, d);
  }
  for (int k = 0; k < tone->channels; k++) set_mean(s, k, tone);
  keep_light(tone, s);
  return true;
}

static bool is_better(const rc_tone *trend, const rc_tone *other, const rc_trend_view *view) {
  double beside = rc_trend_explains(trend, &view->beside);
  return rc_trend_explains(trend, &view->all) >
             rc_trend_explains(other, &view->all) + LEAST_BETTER &&
         beside >= LEAST_BETTER_BESIDE && beside > rc_trend_explains(other, &view->beside) &&
         rc_trend_is_light(trend, view);
}

/* What is too large for a stack. */
typedef struct workspace {
  rc_trend_view view;
  differences differences;
} workspace;

/* Makes the tone, fitted by least squares, the better one; light false: none of both is. */
static recede_status choose(rc_context *context, const rc_samples *samples, const sums *s,
                            rc_tone *tone, bool *light) {
  rc_tone between = *tone;
  workspace *w;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &w));
  RC_TRY(rc_trend_view_set(context, samples, tone, &w->view));
  *light = rc_trend_is_light(tone, &w->view);
  if (fit_between_steps(samples, s, &w->differences, &between) &&
      is_better(&between, tone, &w->view))
    *tone = between, *light = true;
  rc_release(context, mark);
  return rc_poll(context);
}

recede_status rc_tone_fit(rc_context *context, const rc_image *image, const rc_mask *flags,
                          const rc_band *band, bool drift, rc_tone *tone) {
  rc_samples samples = {image, flags, band};
  bool light = false;
  sums s;
  memset(&s, 0, sizeof s);
  memset(tone, 0, sizeof *tone);
  tone->channels = image->channels;
  tone->middle_x = (image->width - 1) / 2., tone->middle_y = (image->height - 1) / 2.;
  tone->half_width = image->width / 2., tone->half_height = image->height / 2.;
  gather(&samples, tone, &s);
  if (!(s.product[0][0] > 0)) {
    samples.band = NULL;
    gather(&samples, tone, &s);
  }
  if (!(s.product[0][0] > 0)) return RECEDE_OK;
  if (drift && fit_squares(&s, tone) && explained(tone, &s) >= LEAST_EXPLAINED)
    RC_TRY(choose(context, &samples, &s, tone, &light));
  if (light) return RECEDE_OK;
  memset(tone->terms, 0, sizeof tone->terms);
  for (int k = 0; k < tone->channels; k++) tone->terms[k][0] = s.value[k][0] / s.product[0][0];
  return RECEDE_OK;
}
