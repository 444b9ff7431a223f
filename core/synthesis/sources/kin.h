/* What may lie where in the hole. Of a thing that the hole only touches at one end, a hen, a path,
 * there is something beside the hole, so that it is neither unlike nor a stranger; but whole copies
 * of it fit far from there as well as any, with what lies around it. */
#ifndef RECEDE_SYNTHESIS_SOURCES_KIN_H
#define RECEDE_SYNTHESIS_SOURCES_KIN_H

#include "base/context.h"
#include "image/image.h"

/* What is beside the hole is divided into so many parts. */
#define RC_KIN_PARTS 16

/* Of a source: how much of each part it looks like, of 255. */
typedef struct rc_likeness {
  uint8_t part[RC_KIN_PARTS];
} rc_likeness;

/* Of a target pixel: how much each part says of it, the nearest most; unit makes 1 of the sum over
 * what usually lies beside the hole there. And which part lies across the pixel from each. */
typedef struct rc_nearness {
  uint8_t part[RC_KIN_PARTS], across[RC_KIN_PARTS];
  float unit; /* 0: nothing is told */
} rc_nearness;

/* images and flags: the pyramid's levels, finest first; likeness and nearness: of the sources and
 * of the target among the pixels of the coarsest. told: so many of the sources are foreign to so
 * much of the hole that there must be several things; else both are undefined. */
recede_status rc_kin_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                          int levels, rc_likeness *likeness, rc_nearness *nearness, bool *told);
/* From 0, what looks like nothing beside the hole there, to 1, what looks like enough of it. */
float rc_kinship(const rc_likeness *source, const rc_nearness *target);

#endif
