/* The price of taking the same source again. Bland patches resemble everything: without it they
 * spread through a hole of stones or flowers until none is left. */
#ifndef RECEDE_SYNTHESIS_SEARCH_USAGE_H
#define RECEDE_SYNTHESIS_SEARCH_USAGE_H

#include "synthesis/search/level.h"

/* How many of the source's pixels a target pixel shows: the area scale, of raised copies that of
 * their one scale. */
static inline float rc_use_of(rc_copy copy, const rc_place *place) {
  float scale = place->ratio / place->mismatch;
  return copy.r > 0.f ? scale * scale : scale * scale * scale;
}
/* uses, level->width * level->height: how often the field shows each pixel now, 1 on the mean for
 * what one copy shows; those of other scales leave gaps and heaps. */
void rc_count_uses(const rc_level *level, float *uses);
/* price, level->width * level->height, byte^2: what a copy from each pixel costs the search more,
 * by how often the field takes the pixels around it now. */
recede_status rc_usage_prices(rc_context *context, const rc_level *level, float *price);

#endif
