/* The price of taking the same source again. Bland patches resemble everything: without it they
 * spread through a hole of stones or flowers until none is left. */
#ifndef RECEDE_SYNTHESIS_USAGE_H
#define RECEDE_SYNTHESIS_USAGE_H

#include "synthesis/level.h"

/* How much of a source's pixel one copy of it takes: a target pixel covers 1 / area scale. */
static inline float rc_use_of(const rc_place *place) {
  return 1.f / (place->ratio * place->ratio * place->ratio);
}
/* uses, level->width * level->height: how often the field takes each pixel now. */
void rc_count_uses(const rc_level *level, float *uses);
/* price, level->width * level->height, byte^2: what a copy from each pixel costs more, by how often
 * the field takes the pixels around it now. */
recede_status rc_usage_prices(rc_context *context, const rc_level *level, float *price);

#endif
