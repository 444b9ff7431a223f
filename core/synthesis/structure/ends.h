/* Where lines meet the hole's border, each seen from outside. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_ENDS_H
#define RECEDE_SYNTHESIS_STRUCTURE_ENDS_H

#include "synthesis/structure/crossing.h"
#include "synthesis/structure/profile.h"
#include "synthesis/structure/seen.h"

#define RC_END_DIRECTIONS 128

/* What a run looks like, read across it. */
typedef struct rc_run {
  rc_profile profile;
  float strength; /* signal to noise; 0: not enough known pixels */
  float clarity;  /* how much changes in its middle */
} rc_run;

typedef struct rc_ends {
  rc_seen picture;
  const int32_t *border; /* pixels */
  int border_count;
  float direction[RC_END_DIRECTIONS][2];
  rc_run *best; /* of each border pixel, its strongest direction outwards */
  int *best_direction;
} rc_ends;

/* Target pixels that touch known ones. */
int rc_border_length(const rc_mask *flags);
recede_status rc_ends_find(rc_context *context, const rc_seen *seen, rc_ends *ends);
/* The run that begins at (x, y) and leaves along outwards u, read across u. */
rc_run rc_run_measure(const rc_seen *seen, float x, float y, float ux, float uy, float outwards);
/* Its strength, read between the pixels. */
float rc_run_fine_strength(const rc_seen *seen, float x, float y, float ux, float uy,
                           float outwards);
/* Whether a border pixel has a line of this strength, and of those around it the strongest. */
bool rc_end_stands_out(const rc_ends *ends, int item, float least_strength);
/* Large stones have straight edges of 20 to 100, and one may by chance point at another: where
 * more than this part of the rest of the hole's border has a line as strong, one alone is none. A
 * stone .17; cracks and a row of tiles .02 to .08. */
#define RC_MOST_AS_STRONG .12f
/* Of the border pixels away from a line the part that is as strong; of few pixels no small one. */
float rc_ends_as_strong(const rc_ends *ends, const rc_crossing *line);

#endif
