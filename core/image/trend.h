/* Trends of the tone: the samples one is fitted to, and what speaks for its being light. */
#ifndef RECEDE_IMAGE_TREND_H
#define RECEDE_IMAGE_TREND_H

#include "image/tone.h"

/* SOURCE pixels of the band; band NULL: all of them. */
typedef struct rc_samples {
  const rc_image *image;
  const rc_mask *flags;
  const rc_band *band;
} rc_samples;

static inline bool rc_is_sample(const rc_samples *samples, int x, int y) {
  return *rc_flag(samples->flags, x, y) & RC_SOURCE &&
         (!samples->band || rc_band_holds(samples->band, x, y));
}
/* Every n-th column and row of a box are enough for six decimals of a trend. */
int rc_sample_step(rc_box box);

/* Parts of a box, so many by so many: sums over their samples. */
#define RC_PLACES 16
typedef struct rc_tone_place {
  double count, value[3], terms[RC_TONE_TERMS];
} rc_tone_place;

typedef struct rc_tone_places {
  int side; /* RC_PLACES or less by as many */
  rc_tone_place of[RC_PLACES][RC_PLACES];
} rc_tone_places;

/* tone: says where terms are 0 and 1. */
void rc_places_sum(const rc_samples *samples, const rc_tone *tone, rc_box box, int side,
                   rc_tone_places *places);
/* What two places' means differ by; false: one has no samples. */
bool rc_places_differ(const rc_tone_place *p, const rc_tone_place *q, rc_tone_place *difference);

/* Where the sources lie, beside the hole and right around it. */
typedef struct rc_trend_view {
  rc_tone_places all, beside, around;
  bool beyond; /* most of the hole lies outside the sources' box */
} rc_trend_view;

recede_status rc_trend_view_set(rc_context *context, const rc_samples *samples, const rc_tone *tone,
                                rc_trend_view *view);
/* Part of the differences between neighbouring places that a trend explains. */
double rc_trend_explains(const rc_tone *trend, const rc_tone_places *places);
bool rc_trend_is_light(const rc_tone *trend, const rc_trend_view *view);

#endif
