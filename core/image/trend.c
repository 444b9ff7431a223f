#include "image/trend.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

#define MOST_SAMPLES 400000
/* A trend must explain such a part of the differences between the neighbours of so many by so many
 * places. Where two things meet, a road and its verge, brightness steps, and a trend across the
 * step is wrong nearly everywhere: six such scenes -.24 .. .00, ten photos whose light drifts
 * .03 .. .22. */
#define LEAST_EXPLAINED_NEARBY .01
#define PLACES 8
/* And beside the hole, so much of its longer side away, it must not do this harm: a dark pier
 * between bright water is light to both sides by a trend, but dark by itself. Photos whose light
 * drifts -.03 .. .22, two piers between water and a dune below the sky -.06, -.14 and -.21. Of
 * other depths the trend says nothing. */
#define LEAST_EXPLAINED_BESIDE -.04
#define BESIDE_OF_HOLE .25
/* Nor this one to what lies right around the hole, so much of its longer side, from any place there
 * to any other: holes in the dark boards of a pier, which the water's trend does not touch, got
 * water. These -.22 .. -1.2, photos whose light drifts -.13 and more. */
#define LEAST_EXPLAINED_AROUND -.18
#define AROUND_OF_HOLE (1. / 16)
#define LEAST_AROUND_PX 8
#define AROUND_STEPS 4
#define MOST_OF_BORDER 4000
/* Where more than half of the hole lies beyond the box of the sources, as when a picture is
 * extended, copies come from one side only, and what a trend has of things and not of light tints
 * them: there it must explain such a part of what differs from place to place. Textures in a light
 * that drifts by half and more .92 .. .998, photos of streets, piers, dunes and roofs
 * .62 .. .88. */
#define MOST_BEYOND .5
#define LEAST_EXPLAINED_BEYOND .91

int rc_sample_step(rc_box box) {
  double area = (double)(box.x1 - box.x0) * (box.y1 - box.y0);
  return area > MOST_SAMPLES ? (int)ceil(sqrt(area / MOST_SAMPLES)) : 1;
}

static void add_sample(const rc_samples *samples, const rc_tone *tone, rc_box box, int x, int y,
                       rc_tone_places *places) {
  double terms[RC_TONE_TERMS];
  if (!rc_is_sample(samples, x, y)) return;
  rc_tone_place *p = &places->of[(y - box.y0) * places->side / (box.y1 - box.y0)]
                                [(x - box.x0) * places->side / (box.x1 - box.x0)];
  rc_tone_terms(tone, x, y, terms);
  p->count++;
  for (int k = 0; k < samples->image->channels; k++)
    p->value[k] += rc_pixel(samples->image, x, y)[k];
  for (int i = 0; i < RC_TONE_TERMS; i++) p->terms[i] += terms[i];
}

void rc_places_sum(const rc_samples *samples, const rc_tone *tone, rc_box box, int side,
                   rc_tone_places *places) {
  int step = rc_sample_step(box);
  memset(places, 0, sizeof *places);
  places->side = side;
  for (int y = box.y0; y < box.y1; y += step)
    for (int x = box.x0; x < box.x1; x += step) add_sample(samples, tone, box, x, y, places);
}

/* What lies in a square around every n-th pixel of the hole's border, the more often the nearer. */
static recede_status sum_around(rc_context *context, const rc_samples *samples, const rc_tone *tone,
                                rc_box hole, rc_tone_places *places) {
  const rc_mask *flags = samples->flags;
  int px = (int)(AROUND_OF_HOLE * rc_longer_side(hole)), border = 0, seen = 0;
  uint8_t *at;
  if (px < LEAST_AROUND_PX) px = LEAST_AROUND_PX;
  int step = px / AROUND_STEPS;
  rc_box box = rc_box_grown(hole, px, flags->width, flags->height);
  memset(places, 0, sizeof *places);
  places->side = PLACES;
  RC_TRY(RC_NEW(context, hole.x1 - hole.x0, &at));
  for (int y = hole.y0; y < hole.y1; y++) {
    rc_border_of_row(flags, y, hole.x0, hole.x1, at);
    for (int x = hole.x0; x < hole.x1; x++) border += at[x - hole.x0];
  }
  int every = border / MOST_OF_BORDER + 1;
  for (int y = hole.y0; y < hole.y1; y++) {
    RC_TRY(rc_poll(context));
    rc_border_of_row(flags, y, hole.x0, hole.x1, at);
    for (int x = hole.x0; x < hole.x1; x++) {
      if (!at[x - hole.x0] || seen++ % every) continue;
      for (int j = y - px; j <= y + px; j += step)
        for (int i = x - px; i <= x + px; i += step)
          if (i >= box.x0 && i < box.x1 && j >= box.y0 && j < box.y1)
            add_sample(samples, tone, box, i, j, places);
    }
  }
  RC_FREE(context, &at);
  return RECEDE_OK;
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

recede_status rc_trend_view_set(rc_context *context, const rc_samples *samples, const rc_tone *tone,
                                rc_trend_view *view) {
  const rc_mask *flags = samples->flags;
  rc_box hole = rc_box_of(flags, RC_TARGET);
  int px = (int)(BESIDE_OF_HOLE * rc_longer_side(hole));
  rc_box beside = rc_box_grown(hole, px, flags->width, flags->height);
  rc_places_sum(samples, tone, tone->box, PLACES, &view->all);
  RC_TRY(rc_poll(context));
  rc_places_sum(samples, tone, beside, PLACES, &view->beside);
  RC_TRY(sum_around(context, samples, tone, hole, &view->around));
  view->beyond = lies_beyond(flags, &hole, &tone->box);
  return rc_poll(context);
}

bool rc_places_differ(const rc_tone_place *p, const rc_tone_place *q, rc_tone_place *difference) {
  if (!(p->count > 0 && q->count > 0)) return false;
  difference->count = 1;
  for (int k = 0; k < 3; k++)
    difference->value[k] = q->value[k] / q->count - p->value[k] / p->count;
  for (int i = 0; i < RC_TONE_TERMS; i++)
    difference->terms[i] = q->terms[i] / q->count - p->terms[i] / p->count;
  return true;
}

/* How much places differ, and how much of that a trend leaves. */
typedef struct differences {
  double all, left;
} differences;

static void add_difference(const rc_tone *trend, const rc_tone_place *p, const rc_tone_place *q,
                           double weight, differences *sum) {
  rc_tone_place d;
  if (!rc_places_differ(p, q, &d)) return;
  for (int k = 0; k < trend->channels; k++) {
    sum->all += weight * fabs(d.value[k]);
    sum->left += weight * fabs(d.value[k] - rc_tone_value(trend, k, d.terms));
  }
}

static double explained(const differences *d) {
  return d->all > 0 ? (d->all - d->left) / d->all : 0;
}

double rc_trend_explains(const rc_tone *trend, const rc_tone_places *places) {
  differences sum = {0, 0};
  for (int y = 0; y < places->side; y++)
    for (int x = 0; x < places->side; x++) {
      const rc_tone_place *p = &places->of[y][x];
      if (x + 1 < places->side) add_difference(trend, p, &places->of[y][x + 1], 1, &sum);
      if (y + 1 < places->side) add_difference(trend, p, &places->of[y + 1][x], 1, &sum);
    }
  return explained(&sum);
}

/* Part of what any sample's place differs by from any other's. */
static double explains_all(const rc_tone *trend, const rc_tone_places *places) {
  differences sum = {0, 0};
  int side = places->side;
  for (int i = 1; i < side * side; i++)
    for (int k = 0; k < i; k++) {
      const rc_tone_place *p = &places->of[i / side][i % side],
                          *q = &places->of[k / side][k % side];
      add_difference(trend, p, q, p->count * q->count, &sum);
    }
  return explained(&sum);
}

/* Part of the places' variance. */
static double explains_variance(const rc_tone *trend, const rc_tone_places *places) {
  rc_tone_place sum = {0};
  double all = 0, left = 0;
  int side = places->side;
  for (int i = 0; i < side * side; i++) {
    const rc_tone_place *p = &places->of[i / side][i % side];
    sum.count += p->count;
    for (int k = 0; k < trend->channels; k++) sum.value[k] += p->value[k];
  }
  for (int i = 0; i < side * side; i++) {
    const rc_tone_place *p = &places->of[i / side][i % side];
    for (int k = 0; k < trend->channels && p->count > 0; k++) {
      double value = p->value[k] / p->count, mean = sum.value[k] / sum.count;
      double fitted = rc_tone_value(trend, k, p->terms) / p->count;
      all += p->count * (value - mean) * (value - mean);
      left += p->count * (value - fitted) * (value - fitted);
    }
  }
  return all > 0 ? (all - left) / all : 0;
}

bool rc_trend_is_light(const rc_tone *trend, const rc_trend_view *view) {
  return rc_trend_explains(trend, &view->all) >= LEAST_EXPLAINED_NEARBY &&
         rc_trend_explains(trend, &view->beside) >= LEAST_EXPLAINED_BESIDE &&
         explains_all(trend, &view->around) >= LEAST_EXPLAINED_AROUND &&
         (!view->beyond || explains_variance(trend, &view->all) >= LEAST_EXPLAINED_BEYOND);
}
