/* A wide Gaussian was tried first: it takes planks', crests' and ripples' own tone away. A linear
 * trend leaves a dark middle where a photo is brightest in its own middle. */
#include "image/tone.h"

#include <math.h>
#include <string.h>

#include "base/cholesky.h"
#include "base/parallel.h"

/* Part of the variance that a trend must explain: below, it is lost in the texture. */
#define LEAST_EXPLAINED .3
/* And part of the differences between the neighbours of so many by so many places. Where two things
 * meet, a road and its verge, brightness steps, and a trend across the step is wrong nearly
 * everywhere: six such scenes -.24 .. .00, ten photos whose light drifts .03 .. .22. */
#define LEAST_EXPLAINED_NEARBY .01
#define PLACES 8
/* And beside the hole, so much of its longer side away, it must not do this harm: a dark pier
 * between bright water is light to both sides by a trend, but dark by itself. Photos whose light
 * drifts -.03 .. .22, two piers between water and a dune below the sky -.06, -.14 and -.21. Of
 * other depths the trend says nothing. */
#define LEAST_EXPLAINED_BESIDE -.04
#define BESIDE_OF_HOLE .25
/* Where more than half of the hole lies beyond the box of the sources, as when a picture is
 * extended, copies come from one side only, and what a trend has of things and not of light tints
 * them: there it must explain such a part of what differs from place to place. Textures in a light
 * that drifts by half and more .92 .. .998, photos of streets, piers, dunes and roofs
 * .62 .. .88. */
#define MOST_BEYOND .5
#define LEAST_EXPLAINED_BEYOND .91
/* Light makes all colours brighter alike, or nearly: where more than this part of what trends
 * spread by is colour they are of things, as of red hens to one side of a lawn, and so is the
 * colour. Dunes, tea, piers and a ruin .02 .. .13; a tree before a brick wall .14, hens .28, lit
 * columns .30 .. .38. */
#define MOST_COLOURED .133
/* Enough for six decimals of a trend. */
#define MOST_SAMPLES 400000
#define TERMS RC_TONE_TERMS
/* The trend is added to so many pixels of a row at once. */
#define COLUMNS 64

static int within(int v, int low, int end) { return v < low ? low : v >= end ? end - 1 : v; }

static double unit_x(const rc_tone *tone, int px) {
  return (px - tone->middle_x) / tone->half_width;
}

static double unit_y(const rc_tone *tone, int py) {
  return (py - tone->middle_y) / tone->half_height;
}

static void basis(const rc_tone *tone, int px, int py, double terms[TERMS]) {
  double x = unit_x(tone, px), y = unit_y(tone, py);
  terms[0] = 1, terms[1] = x, terms[2] = y;
  terms[3] = x * x, terms[4] = x * y, terms[5] = y * y;
}

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

static int sample_step(const rc_box *box) {
  double area = (double)(box->x1 - box->x0) * (box->y1 - box->y0);
  return area > MOST_SAMPLES ? (int)ceil(sqrt(area / MOST_SAMPLES)) : 1;
}

static bool is_sample(const rc_mask *flags, const rc_band *band, int x, int y) {
  return *rc_flag(flags, x, y) & RC_SOURCE && (!band || rc_band_holds(band, x, y));
}

static void gather(const rc_image *image, const rc_mask *flags, const rc_band *band, rc_tone *tone,
                   sums *s) {
  double terms[TERMS];
  rc_box all = {0, 0, image->width, image->height}, *box = &tone->box;
  int step = sample_step(&all);
  *box = (rc_box){image->width, image->height, 0, 0};
  for (int y = 0; y < image->height; y += step)
    for (int x = 0; x < image->width; x += step) {
      if (!is_sample(flags, band, x, y)) continue;
      if (x < box->x0) box->x0 = x;
      if (x >= box->x1) box->x1 = x + 1;
      if (y < box->y0) box->y0 = y;
      box->y1 = y + 1;
      basis(tone, x, y, terms);
      add(s, terms, rc_pixel(image, x, y), image->channels);
    }
}

/* Part of the variance about the mean that the terms explain. */
static double explained(const rc_tone *tone, const sums *s, double count) {
  double fitted = 0, mean = 0;
  for (int k = 0; k < tone->channels; k++) {
    mean += s->value[k][0] * s->value[k][0] / count;
    for (int i = 0; i < TERMS; i++) fitted += tone->terms[k][i] * s->value[k][i];
  }
  return s->square > mean ? (fitted - mean) / (s->square - mean) : 0;
}

static double value_of(const rc_tone *tone, int channel, const double terms[TERMS]) {
  double value = 0;
  for (int i = 0; i < TERMS; i++) value += tone->terms[channel][i] * terms[i];
  return value;
}

/* A part of a box: sums over its samples. */
typedef struct place {
  double count, value[3], trend[3];
} place;

static void sum_places(const rc_image *image, const rc_mask *flags, const rc_band *band,
                       const rc_box *box, const rc_tone *tone, place places[PLACES][PLACES]) {
  int step = sample_step(box);
  double terms[TERMS];
  for (int y = box->y0; y < box->y1; y += step)
    for (int x = box->x0; x < box->x1; x += step) {
      if (!is_sample(flags, band, x, y)) continue;
      place *p = &places[(y - box->y0) * PLACES / (box->y1 - box->y0)]
                        [(x - box->x0) * PLACES / (box->x1 - box->x0)];
      basis(tone, x, y, terms);
      p->count++;
      for (int k = 0; k < tone->channels; k++)
        p->value[k] += rc_pixel(image, x, y)[k], p->trend[k] += value_of(tone, k, terms);
    }
}

/* Adds how the two differ, and how much of that the trend leaves. */
static void add_difference(const place *p, const place *q, int channels, double *all,
                           double *left) {
  for (int k = 0; k < channels && p->count > 0 && q->count > 0; k++) {
    double difference = q->value[k] / q->count - p->value[k] / p->count;
    double trend = q->trend[k] / q->count - p->trend[k] / p->count;
    *all += fabs(difference), *left += fabs(difference - trend);
  }
}

/* Part of the differences between neighbouring places of a box that the trend explains. */
static double explained_nearby(const rc_image *image, const rc_mask *flags, const rc_band *band,
                               const rc_box *box, const rc_tone *tone) {
  place places[PLACES][PLACES];
  double all = 0, left = 0;
  memset(places, 0, sizeof places);
  sum_places(image, flags, band, box, tone, places);
  for (int y = 0; y < PLACES; y++)
    for (int x = 0; x < PLACES; x++) {
      if (x + 1 < PLACES)
        add_difference(&places[y][x], &places[y][x + 1], tone->channels, &all, &left);
      if (y + 1 < PLACES)
        add_difference(&places[y][x], &places[y + 1][x], tone->channels, &all, &left);
    }
  return all > 0 ? (all - left) / all : 0;
}

/* Part of what differs between the places of the sources' box that the trend explains. */
static double explained_by_places(const rc_image *image, const rc_mask *flags, const rc_band *band,
                                  const rc_tone *tone) {
  place places[PLACES][PLACES], sum = {0, {0, 0, 0}, {0, 0, 0}};
  const place *first = places[0];
  double all = 0, left = 0;
  memset(places, 0, sizeof places);
  sum_places(image, flags, band, &tone->box, tone, places);
  for (int i = 0; i < PLACES * PLACES; i++) {
    sum.count += first[i].count;
    for (int k = 0; k < tone->channels; k++) sum.value[k] += first[i].value[k];
  }
  for (int i = 0; i < PLACES * PLACES; i++)
    for (int k = 0; k < tone->channels && first[i].count > 0; k++) {
      double value = first[i].value[k] / first[i].count, mean = sum.value[k] / sum.count;
      double trend = first[i].trend[k] / first[i].count;
      all += first[i].count * (value - mean) * (value - mean);
      left += first[i].count * (value - trend) * (value - trend);
    }
  return all > 0 ? (all - left) / all : 0;
}

static bool lies_beyond(const rc_mask *flags, const rc_box *hole, const rc_box *box) {
  int64_t target = 0, within_box = 0;
  if (hole->x0 >= box->x0 && hole->y0 >= box->y0 && hole->x1 <= box->x1 && hole->y1 <= box->y1)
    return false;
  for (int y = hole->y0; y < hole->y1; y++)
    for (int x = hole->x0; x < hole->x1; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET)) continue;
      target++, within_box += x >= box->x0 && x < box->x1 && y >= box->y0 && y < box->y1;
    }
  return (double)(target - within_box) > MOST_BEYOND * (double)target;
}

static bool is_light(const rc_image *image, const rc_mask *flags, const rc_band *band,
                     const rc_tone *tone) {
  rc_box hole = rc_box_of(flags, RC_TARGET);
  int px = (int)(BESIDE_OF_HOLE * rc_longer_side(hole));
  rc_box beside = rc_box_grown(hole, px, flags->width, flags->height);
  return explained_nearby(image, flags, band, &tone->box, tone) >= LEAST_EXPLAINED_NEARBY &&
         explained_nearby(image, flags, band, &beside, tone) >= LEAST_EXPLAINED_BESIDE &&
         (!lies_beyond(flags, &hole, &tone->box) ||
          explained_by_places(image, flags, band, tone) >= LEAST_EXPLAINED_BEYOND);
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

/* Takes from coloured trends all but what lies along the mean colour. Where that is negative, as
 * floats may be, it is no colour. */
static void keep_light(rc_tone *tone, const sums *s) {
  double colour[3] = {0, 0, 0}, square = 0, count = s->product[0][0];
  rc_tone light = *tone;
  for (int k = 0; k < tone->channels; k++) {
    colour[k] = s->value[k][0] / count, square += colour[k] * colour[k];
    if (tone->channels == 1 || !(colour[k] > 0)) return;
  }
  for (int i = 1; i < TERMS; i++) {
    double sum = 0;
    for (int k = 0; k < tone->channels; k++) sum += colour[k] * tone->terms[k][i];
    for (int k = 0; k < tone->channels; k++) light.terms[k][i] = colour[k] * sum / square;
  }
  for (int k = 0; k < tone->channels; k++) {
    light.terms[k][0] = colour[k];
    for (int i = 1; i < TERMS; i++)
      light.terms[k][0] -= light.terms[k][i] * s->product[i][0] / count;
  }
  if (spread_of(&light, s) < (1 - MOST_COLOURED) * spread_of(tone, s)) *tone = light;
}

void rc_tone_fit(const rc_image *image, const rc_mask *flags, const rc_band *band, bool drift,
                 rc_tone *tone) {
  sums s;
  memset(&s, 0, sizeof s);
  memset(tone, 0, sizeof *tone);
  tone->channels = image->channels;
  tone->middle_x = (image->width - 1) / 2., tone->middle_y = (image->height - 1) / 2.;
  tone->half_width = image->width / 2., tone->half_height = image->height / 2.;
  gather(image, flags, band, tone, &s);
  if (!(s.product[0][0] > 0)) gather(image, flags, band = NULL, tone, &s);
  double count = s.product[0][0];
  if (!(count > 0)) return;
  double factored[TERMS][TERMS];
  memcpy(factored, s.product, sizeof factored);
  if (drift && rc_factor(TERMS, factored[0])) {
    for (int k = 0; k < tone->channels; k++) {
      memcpy(tone->terms[k], s.value[k], sizeof s.value[k]);
      rc_substitute(TERMS, factored[0], tone->terms[k]);
    }
    keep_light(tone, &s);
    if (explained(tone, &s, count) >= LEAST_EXPLAINED && is_light(image, flags, band, tone)) return;
  }
  memset(tone->terms, 0, sizeof tone->terms);
  for (int k = 0; k < tone->channels; k++) tone->terms[k][0] = s.value[k][0] / count;
}

void rc_tone_at(const rc_tone *tone, int x, int y, double values[3]) {
  double terms[TERMS];
  basis(tone, within(x, tone->box.x0, tone->box.x1), within(y, tone->box.y0, tone->box.y1), terms);
  for (int k = 0; k < tone->channels; k++) values[k] = value_of(tone, k, terms);
}

bool rc_tone_drifts(const rc_tone *tone) {
  for (int k = 0; k < tone->channels; k++)
    for (int i = 1; i < TERMS; i++)
      if (tone->terms[k][i] != 0) return true;
  return false;
}

typedef struct application {
  const rc_tone *tone;
  const rc_mask *flags;
  uint8_t flag;
  float sign;
  rc_image *image;
} application;

static bool has_any(const uint8_t *flags, int count, uint8_t flag) {
  uint8_t any = 0;
  for (int i = 0; i < count; i++) any |= flags[i];
  return any & flag;
}

static void apply_row(void *user, int y, int thread) {
  const application *a = user;
  const rc_tone *tone = a->tone;
  double v = unit_y(tone, within(y, tone->box.y0, tone->box.y1));
  (void)thread;
  for (int first = 0; first < a->image->width; first += COLUMNS) {
    double u[COLUMNS], trend[COLUMNS];
    int count = a->image->width - first < COLUMNS ? a->image->width - first : COLUMNS;
    const uint8_t *flags = rc_flag(a->flags, first, y);
    float *pixels = rc_pixel(a->image, first, y);
    if (!has_any(flags, count, a->flag)) continue;
    for (int i = 0; i < COLUMNS; i++)
      u[i] = unit_x(tone, within(first + i, tone->box.x0, tone->box.x1));
    for (int k = 0; k < tone->channels; k++) {
      const double *own = tone->terms[k]; /* in basis()'s order; the compiler makes vectors of it */
      for (int i = 0; i < COLUMNS; i++)
        trend[i] = own[0] + own[1] * u[i] + own[2] * v + own[3] * (u[i] * u[i]) +
                   own[4] * (u[i] * v) + own[5] * (v * v);
      for (int i = 0; i < count; i++)
        if (flags[i] & a->flag) pixels[i * tone->channels + k] += a->sign * (float)trend[i];
    }
  }
}

recede_status rc_tone_apply(rc_context *context, const rc_tone *tone, const rc_mask *flags,
                            uint8_t flag, float sign, rc_image *image) {
  application a = {tone, flags, flag, sign, image};
  return rc_parallel(context, image->height, apply_row, &a);
}
