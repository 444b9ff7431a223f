/* The edge between two labelled textures as it is seen outside the hole: where it leads from the
 * hole's border. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_EDGES_H
#define RECEDE_SYNTHESIS_STRUCTURE_EDGES_H

#include <math.h>

#include "synthesis/structure/groups.h"

/* The border of the hole is so wide. */
#define RC_BORDER_PX 2

/* label: of each of around's pixels: -1, 1, or 0 where it is not known. */
typedef struct rc_labels {
  const rc_around *around;
  const int8_t *label;
} rc_labels;

/* Where the edge of the textures meets that of the hole. Places are px of the box around it. */
typedef struct rc_change {
  float x, y;
  float ux, uy; /* the edge's direction outwards, a unit vector, or 0 */
} rc_change;

static inline float rc_apart(const rc_change *a, const rc_change *b) {
  return sqrtf((a->x - b->x) * (a->x - b->x) + (a->y - b->y) * (a->y - b->y));
}

/* Whether a pixel beside the hole has a label. */
bool rc_on_border(const rc_labels *labels, int x, int y);
/* Whether the two have opposite labels. */
bool rc_labels_differ(const rc_labels *labels, int x, int y, int other_x, int other_y);
/* Sets the direction in which the edge leads outwards, 0 where it leads nowhere. */
void rc_edge_follow(const rc_labels *labels, rc_change *change);
/* The straight line that the edge follows as far as it goes on the way it began: where it turns
 * soon, no farther. x, y: a place on it. */
rc_change rc_edge_straight(const rc_labels *labels, const rc_change *change);
/* The arc of a circle on which the edges at both ends lie: points of the pieces of the way from one
 * to the other through the hole, both ends among them. Returns how many pieces, 0: no arc. */
#define RC_MOST_ARC_PIECES 10
int rc_edge_arc(const rc_labels *labels, const rc_change *from, const rc_change *to,
                rc_change points[RC_MOST_ARC_PIECES + 1]);

#endif
