/* Where the edge between two labelled textures meets the border of a hole, and how it may go on in
 * there: along straight chords from where one texture changes into the other to where they change
 * again, round a corner, or out of the picture. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_CHORDS_H
#define RECEDE_SYNTHESIS_STRUCTURE_CHORDS_H

#include "synthesis/copy.h"
#include "synthesis/structure/edges.h"

#define RC_MOST_CHORDS 4
/* An arc has the most. */
#define RC_MOST_CHORD_PIECES RC_MOST_ARC_PIECES
#define RC_MOST_CHANGES 32

typedef struct rc_chords {
  rc_change end[RC_MOST_CHORD_PIECES][2]; /* of each straight piece */
  int piece_count;
  int count;  /* of chords, each of one piece, of two in a corner, or of those of an arc. 0:
               * they cannot be told */
  float turn; /* from the edges' directions, of all together */
  rc_change changes[RC_MOST_CHANGES]; /* all there are, spurs too; none: there are too many */
  int change_count;
} rc_chords;

/* chart: of the level. */
recede_status rc_chords_find(rc_context *context, const rc_around *around, const rc_chart *chart,
                             const int8_t *label, rc_chords *chords);

#endif
