/* Places of the coarsest level, looked at one by one to say which may not be copied. */
#ifndef RECEDE_SYNTHESIS_SOURCES_PLACES_H
#define RECEDE_SYNTHESIS_SOURCES_PLACES_H

#include "image/line.h"
#include "synthesis/sources/looks.h"

/* A place's looks are those of the square around it, so far to each side: half a hole wide, unless
 * the hole is thin. */
#define RC_LOOKS_PX 4
/* How far from the hole beside it ends. */
#define RC_BESIDE_PX 9
/* And what is near ends: a thing that the hole cuts goes on, while one of some people may stand
 * beside it. */
#define RC_TOUCHING_PX 4
/* Small things are looked for in so many places; a level that has more is that of a long and thin
 * hole, of which patches see both sides. */
#define RC_MOST_LOOKED_AT (1 << 19)
static inline bool rc_is_looked_at(const rc_mask *coarsest) {
  return (int64_t)coarsest->width * coarsest->height <= RC_MOST_LOOKED_AT;
}

typedef struct rc_places {
  const rc_image *image; /* the coarsest level */
  const rc_mask *flags;
  int levels;
  uint8_t *beside; /* of each pixel: its distance from the hole if it is source beside it, else 0 */
  int step;        /* px from one place to the next */
  int columns, rows; /* of places */
  uint8_t *unlike;   /* of each: how much speaks against copying it; 0: nothing */
} rc_places;

/* images and flags: the pyramid's levels, finest first. Of a level with more pixels than most only
 * every n-th is a place. */
recede_status rc_places_new(rc_context *context, const rc_image *images, const rc_mask *flags,
                            int levels, int most, rc_places *places);
/* The sources' variance, mean over the channels. */
double rc_source_variance(const rc_image *image, const rc_mask *flags);
/* What the pixel looks like, that is, the square around it. False: not enough of it is known. */
bool rc_look_at(const rc_places *places, int x, int y, rc_looks *looks);
/* What the middle of a place looks like. False: it is not known. */
bool rc_look_at_place(const rc_places *places, int column, int row, rc_looks *looks);
/* Whether some of the place is source beside the hole. */
bool rc_is_beside(const rc_places *places, int column, int row);
/* What lies there and, for its edge fades into them, in the places around may not be copied. */
void rc_places_mark_around(const rc_places *places, int column, int row);
/* Takes RC_SOURCE from what may not be copied, at all levels; where too little of the hole's own
 * scales would be left, only from what is the most unlike. band: where those are, of the finest
 * level; taken: the part of the sources that lost it. */
recede_status rc_places_take(rc_context *context, const rc_places *places, const rc_band *band,
                             const rc_mask *flags, double *taken);

#endif
