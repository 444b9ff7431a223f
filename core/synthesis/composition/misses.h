/* What copies miss the known pixels beside them by, along the hole's border. What a stretch of the
 * border has in common is tone, which goes on into the hole; what only a few of its pixels have is
 * a thing that the border cuts, whose colour must not. */
#ifndef RECEDE_SYNTHESIS_COMPOSITION_MISSES_H
#define RECEDE_SYNTHESIS_COMPOSITION_MISSES_H

#include "image/image.h"

/* Rounds of adding all misses of the border, after each of which the common ones are settled. */
#define RC_MISS_ROUNDS 4

/* Squares of the picture that the border may lie in. */
typedef struct rc_misses {
  int x0, y0, columns, rows, channels;
  float unit;           /* the mean miss, a distance */
  float *sums, *common; /* of each square: channels, and their weight */
  bool settled;         /* once: common can be asked */
} rc_misses;

recede_status rc_misses_new(rc_context *context, rc_box box, int channels, float unit,
                            rc_misses *misses);
/* A miss at (x, y), which counts the less the less it has in common with those of the last round.
 */
void rc_misses_add(rc_misses *misses, int x, int y, const float *miss);
void rc_misses_settle(rc_misses *misses);
/* The part of a miss at (x, y) that is tone. */
void rc_misses_tone(const rc_misses *misses, int x, int y, const float *miss, float *tone);

#endif
