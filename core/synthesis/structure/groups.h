/* Whether what lies around a hole looks like two things: a wall and tiles, a path and a lawn. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_GROUPS_H
#define RECEDE_SYNTHESIS_STRUCTURE_GROUPS_H

#include "base/context.h"
#include "image/image.h"
#include "synthesis/sources/looks.h"

/* Part of a level around a hole; arrays hold its pixels row by row. */
typedef struct rc_around {
  const rc_image *image;
  const rc_mask *flags;
  rc_box box;
  int width, height; /* of the box */
  size_t pixels;
  uint8_t *from_hole; /* px; 0: in the hole */
} rc_around;

/* A way to tell two things apart: by how far their looks lie along an axis. */
typedef struct rc_way {
  double axis[RC_LOOKS];
  float at;         /* where one ends and the other begins */
  double explained; /* how much of how looks vary along the axis, 0..1 */
} rc_way;

typedef struct rc_groups {
  rc_looks *looks; /* of the pixels around the hole */
  uint8_t *seen;   /* pixels that have looks */
  rc_way ways[RC_LOOKS];
  int count; /* 0: there are no two things. The way that explains most is the first. */
} rc_groups;

/* beside_px: pixels so far from the hole say what two things there are. */
recede_status rc_groups_find(rc_context *context, const rc_around *around, int beside_px,
                             rc_groups *groups);
/* Labels known pixels by what they look like, -1 or 1, others 0. */
recede_status rc_groups_label(rc_context *context, const rc_around *around, const rc_groups *groups,
                              const rc_way *way, int8_t *label);
/* Each known pixel becomes what most of the square around it is. */
recede_status rc_groups_smooth(rc_context *context, const rc_around *around, int8_t *label);

#endif
