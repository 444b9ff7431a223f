/* What the pixels of a level are compared by: colour, and the detail finer than the level itself,
 * which its colours no longer show. The squares of a parquet all have one colour; a level too
 * coarse for their strips still sees which way these run. */
#ifndef RECEDE_SYNTHESIS_SEARCH_TRAITS_H
#define RECEDE_SYNTHESIS_SEARCH_TRAITS_H

#include "image/image.h"
#include "kernels/kernels.h"
#include "synthesis/copy.h"

typedef struct rc_traits {
  uint32_t *pixels; /* a byte for each component; NULL: red, green, blue and 0 */
  /* What a component says of each colour, but for one factor: a colour is about their sum. */
  float colours[RC_COMPONENTS][3];
} rc_traits;

/* Of all levels but the finest, which has no finer detail. chart: of the finest level. */
recede_status rc_traits_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                             int levels, const rc_chart *chart, rc_traits *traits);

#endif
