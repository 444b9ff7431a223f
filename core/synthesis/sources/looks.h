/* What a place looks like from afar: the mean colour and the deviation of brightness in the square
 * around it. */
#ifndef RECEDE_SYNTHESIS_SOURCES_LOOKS_H
#define RECEDE_SYNTHESIS_SOURCES_LOOKS_H

#include "image/image.h"

#define RC_LOOKS 4

typedef struct rc_looks {
  float value[RC_LOOKS]; /* three colours, which weigh as one, and the deviation */
} rc_looks;

/* How far two are from each other, squared. */
static inline float rc_looks_square(const rc_looks *p, const rc_looks *q) {
  float sum = 0;
  for (int k = 0; k < RC_LOOKS; k++)
    sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
  return sum;
}
/* Of the known pixels up to half_px from (x, y). False where too few are known. */
bool rc_look(const rc_image *image, const rc_mask *flags, int x, int y, int half_px, rc_looks *out);

#endif
