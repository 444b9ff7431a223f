/* Two textures that meet in the hole along an edge that is not straight, or along two: a verge of
 * grass, a chimney among tiles, a path through a lawn. Beside the hole they are told apart by what
 * they look like; in it straight chords lead from where one changes into the other to where they
 * change again, or out of the picture. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_REGIONS_H
#define RECEDE_SYNTHESIS_STRUCTURE_REGIONS_H

#include "base/context.h"
#include "image/image.h"
#include "synthesis/structure/sides.h"

/* image, flags and chart: the coarsest level. two: what lies around the hole looks like two things,
 * and each has part of its border. regions: x0, y0, width, height and distance, which is NULL where
 * there are no two, or where chords cannot be told. chord_count: 0 to 4. */
recede_status rc_regions_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const rc_chart *chart, rc_regions *regions, bool *two,
                              int *chord_count);

#endif
