/* The paper's histogram matching, applied to detail: what a chain of resampled copies and joins
 * loses or gains in fine contrast is given back, measured on known pixels of the same scale. */
#ifndef RECEDE_SYNTHESIS_COMPOSITION_DETAIL_H
#define RECEDE_SYNTHESIS_COMPOSITION_DETAIL_H

#include "synthesis/search/level.h"

recede_status rc_match_detail(rc_context *context, const rc_level *level, rc_image *residual);

#endif
