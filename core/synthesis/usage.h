/* The price of taking the same source again. Bland patches resemble everything: without it they
 * spread through a hole of stones or flowers until none is left. */
#ifndef RECEDE_SYNTHESIS_USAGE_H
#define RECEDE_SYNTHESIS_USAGE_H

#include "synthesis/level.h"

/* price, level->width * level->height, byte^2: what a copy from each pixel costs more, by how often
 * the field takes the pixels around it now. */
recede_status rc_usage_prices(rc_context *context, const rc_level *level, float *price);

#endif
