/* What a texture changes by where the plane is moved. It tells whether it runs or repeats. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_MOVES_H
#define RECEDE_SYNTHESIS_STRUCTURE_MOVES_H

#include "image/image.h"
#include "synthesis/copy.h"
#include "synthesis/structure/seen.h"
#include "synthesis/structure/sides.h"

#define RC_MOVES_POINTS 2000
/* Where so many of them are not seen twice nothing is told. */
#define RC_MOVES_LEAST_SEEN 50

/* Points of a level's sources that are looked at, of scales near the hole's. */
typedef struct rc_moves {
  rc_seen picture; /* its brightness */
  rc_chart chart;
  double most_change; /* squared: of any point no more counts; INFINITY: all does */
  int count;
  int32_t points[RC_MOVES_POINTS];
} rc_moves;

/* near_hole: within half of the hole's longer side from it. beside: only where its distance is
 * positive; NULL: all. */
recede_status rc_moves_set(rc_context *context, const rc_image *image, const rc_mask *flags,
                           rc_chart chart, bool near_hole, const rc_boundary *beside,
                           rc_moves *moves);

/* What one point changes by, squared, where the plane is moved by (a, b); NAN: that is not seen. */
float rc_moves_change_of(const rc_moves *moves, int point, float a, float b);

typedef struct rc_change_sum {
  double squares, seen;
} rc_change_sum;

/* Adds what all points change by. */
void rc_moves_look(const rc_moves *moves, float a, float b, rc_change_sum *sum);
/* The mean; INFINITY: too little was seen. */
double rc_moves_mean(const rc_change_sum *sum);
/* Moved by so many px along the unit vector (a, b), and across it. */
double rc_moves_along(const rc_moves *moves, float a, float b, float px);
double rc_moves_across(const rc_moves *moves, float a, float b, float px);

/* What most points differ by, squared. */
double rc_moves_usual_change(const rc_moves *moves);

#endif
