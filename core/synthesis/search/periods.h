/* The displacements at which a texture repeats in its plane: bricks, tiles, planks. */
#ifndef RECEDE_SYNTHESIS_SEARCH_PERIODS_H
#define RECEDE_SYNTHESIS_SEARCH_PERIODS_H

#include "synthesis/search/level.h"

#define RC_MOST_PERIODS 60

/* Each displacement is tried at so many points, or at fewer to know what is regular: chance then
 * correlates .03 or .05, and twice that where few of them are shared. */
#define RC_PERIOD_POINTS 1200
#define RC_REGULAR_POINTS 400

/* Flat copies, in the px of the level that they were found at. */
typedef struct rc_periods {
  rc_copy copies[RC_MOST_PERIODS]; /* strongest first, each with its opposite */
  int count;
  bool repeats;    /* the same piece twice is natural, or not seen */
  bool regular;    /* all there is comes again both ways, by these two: */
  rc_copy base[2]; /* short, and far from parallel */
  bool by_joints;  /* regular, but nothing but its joints is */
  bool clear;      /* regular beyond doubt: all correlates wherever they lead */
  bool row;        /* not regular, but comes again one way, by base[0]; base[1] is 0 */
  bool due;        /* patches do not see it as a whole, and it comes again beside the hole */
} rc_periods;

/* Peaks of the masked correlation of the level's sources with themselves, displaced in the plane by
 * up to a part of the level's shorter side, as if nothing had been cut off. count: of points.
 * regular: whether to ask what is regular, or a row, too; joints: what is not by itself may be so
 * by its joints. */
recede_status rc_find_periods(rc_context *context, const rc_level *level, int shorter_px,
                              uint64_t key, int count, bool regular, bool joints,
                              rc_periods *periods);

#endif
