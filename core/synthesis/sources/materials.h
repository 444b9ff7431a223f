/* What the surface at a place is made of: its colour and its grain, as far as they tell one
 * material from another. */
#ifndef RECEDE_SYNTHESIS_SOURCES_MATERIALS_H
#define RECEDE_SYNTHESIS_SOURCES_MATERIALS_H

#include "base/context.h"
#include "image/image.h"

#define RC_MATERIAL 6

/* Brightness, two differences of colours, the deviation of brightness, and how much neighbours
 * differ along and across the rows; each in units of what it differs by from one place to the next,
 * so that hardly any difference of colours counts on grey stone, and every one of brightness. */
typedef struct rc_material {
  float value[RC_MATERIAL]; /* [0] is NaN: too little is known */
} rc_material;

/* How far two are from each other, squared. */
static inline float rc_material_square(const rc_material *p, const rc_material *q) {
  float sum = 0;
  for (int k = 0; k < RC_MATERIAL; k++)
    sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
  return sum;
}

/* images and flags: the pyramid's levels, finest first; materials: of each pixel of the coarsest,
 * what the square up to half_px from it is made of. The grain is that of the next finer level. */
recede_status rc_materials_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                                int levels, int half_px, rc_material *materials);

#endif
