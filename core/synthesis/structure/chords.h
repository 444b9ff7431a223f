/* Where the edge between two labelled textures meets the border of a hole, and how it may go on in
 * there: along straight chords from where one texture changes into the other to where they change
 * again, round a corner, or out of the picture. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_CHORDS_H
#define RECEDE_SYNTHESIS_STRUCTURE_CHORDS_H

#include <math.h>

#include "synthesis/copy.h"
#include "synthesis/structure/groups.h"

#define RC_MOST_CHORDS 4
#define RC_MOST_CHANGES 32

/* Where the edge of the textures meets that of the hole. Places are px of the box around it. */
typedef struct rc_change {
  float x, y;
  float ux, uy; /* the edge's direction outwards, a unit vector, or 0 */
} rc_change;

typedef struct rc_chords {
  rc_change end[RC_MOST_CHORDS][2]; /* of each straight piece */
  int piece_count;
  int count;                          /* of chords, each of one piece or, in a corner, of two. 0:
                                       * they cannot be told */
  float turn;                         /* from the edges' directions, of all together */
  rc_change changes[RC_MOST_CHANGES]; /* all there are, spurs too; none: there are too many */
  int change_count;
} rc_chords;

/* Whether a pixel beside the hole has a label. */
bool rc_on_border(const rc_around *around, const int8_t *label, int x, int y);
static inline float rc_apart(const rc_change *a, const rc_change *b) {
  return sqrtf((a->x - b->x) * (a->x - b->x) + (a->y - b->y) * (a->y - b->y));
}

/* chart: of the level. */
recede_status rc_chords_find(rc_context *context, const rc_around *around, const rc_chart *chart,
                             const int8_t *label, rc_chords *chords);

#endif
