/* What crosses a line, or ends at it: pieces that are moved in with it would repeat that. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_STRAYS_H
#define RECEDE_SYNTHESIS_STRUCTURE_STRAYS_H

#include "synthesis/structure/profile.h"

/* So many samples to each side of a line move in with it, or nearly. */
#define RC_WIDE_HALF 7
#define RC_WIDE (2 * RC_WIDE_HALF + 1)

/* A line as it is in the mean; where something crosses it that shows in this but little. */
typedef struct rc_clean {
  float mean[RC_WIDE];
  float usual; /* how far single rows of it are from that, squared */
} rc_clean;

/* Its run outside the hole from (x, y) on, outwards being -1 or 1. False: it is not seen. */
bool rc_clean_measure(const rc_ruler *ruler, float x, float y, float outwards, rc_clean *clean);
/* Whether some row of so many px along it, (x, y) being their middle, is far more unlike it than
 * usual, or most cannot be seen. */
bool rc_strays_at(const rc_ruler *ruler, const rc_clean *clean, float x, float y, int length_px);

#endif
