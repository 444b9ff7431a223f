/* The conditions under which a place was taken: how blurred it is, in what light, and what it looks
 * like. What is out of focus is even, so that averages of anything fit it, but a blurred copy among
 * sharp stones is seen at once; and what is relit has the contrast of its old light. */
#ifndef RECEDE_SYNTHESIS_SOURCES_CONDITIONS_H
#define RECEDE_SYNTHESIS_SOURCES_CONDITIONS_H

#include "image/tone.h"
#include "synthesis/sources/kin.h"

typedef struct rc_condition {
  float blur;           /* octaves; 0: sharp */
  float light[3];       /* the tone, in deviations of the texture */
  rc_likeness likeness; /* of what is source there */
  rc_nearness nearness; /* where it is target */
} rc_condition;

/* A table of cells, NULL where they are all the same. */
typedef struct rc_conditions {
  rc_condition *cells;
  int width, height;
  int exponent; /* a cell is 2^exponent px of this level wide */
} rc_conditions;

static inline rc_conditions rc_conditions_coarser(rc_conditions conditions, int exponent) {
  conditions.exponent -= exponent;
  return conditions;
}
/* Of a pixel of its level; there must be some. */
static inline const rc_condition *rc_condition_at(const rc_conditions *conditions, int x, int y) {
  int column = x >> conditions->exponent, row = y >> conditions->exponent;
  return &conditions->cells[row * conditions->width + column];
}

/* images and flags: the pyramid's levels, finest first, without the tone; deviation: the texture's,
 * of a channel. focus, kin, light: whether they are to count. The table's memory is the context's,
 * about 1.1 bytes for each pixel of the finest level at the most. */
recede_status rc_conditions_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                                 int levels, const rc_tone *tone, float deviation, bool focus,
                                 bool kin, bool light, rc_conditions *conditions);
/* From now on nothing is foreign. */
void rc_conditions_forget_kin(rc_conditions *conditions);
/* What a copy costs that comes from under other conditions, in units of the texture's variance. */
float rc_conditions_price(const rc_condition *source, const rc_condition *target);

#endif
