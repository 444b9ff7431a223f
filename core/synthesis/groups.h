/* Whether what lies around a hole looks like two things: a wall and tiles, a path and a lawn. */
#ifndef RECEDE_SYNTHESIS_GROUPS_H
#define RECEDE_SYNTHESIS_GROUPS_H

#include "base/context.h"
#include "image/image.h"

/* Part of a level around a hole; arrays hold its pixels row by row. */
typedef struct rc_around {
  const rc_image *image;
  const rc_mask *flags;
  rc_box box;
  int width, height; /* of the box */
  size_t pixels;
  uint8_t *from_hole; /* px; 0: in the hole */
} rc_around;

/* Labels known pixels by what they look like, -1 or 1, others 0. beside_px: pixels so far from the
 * hole say what two things there are. explained: how much of how their looks vary, along the axis
 * that tells them apart, 0..1; 0: there are no two. */
recede_status rc_two_groups(rc_context *context, const rc_around *around, int beside_px,
                            int8_t *label, double *explained);

#endif
