/* What may lie where in the hole. Of a thing that the hole only touches at one end, a hen, a path,
 * there is something beside the hole, so that it is neither unlike nor a stranger; but whole copies
 * of it fit far from there as well as any, with what lies around it. */
#ifndef RECEDE_SYNTHESIS_SOURCES_KIN_H
#define RECEDE_SYNTHESIS_SOURCES_KIN_H

#include "base/context.h"
#include "image/image.h"
#include "synthesis/sources/materials.h"

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

/* What is beside the hole. */
typedef struct rc_kin {
  const rc_mask *flags;
  const rc_material *materials;  /* of each pixel */
  struct rc_kin_sample *samples; /* in the order of their parts */
  int count, first[RC_KIN_PARTS + 1];
  float middle[RC_KIN_PARTS][2];
  float among[RC_KIN_PARTS][RC_KIN_PARTS]; /* how much of one part looks like the other */
  float most[RC_KIN_PARTS]; /* square of the distance up to which what looks like it is alike */
} rc_kin;

/* images and flags: the pyramid's levels, finest first; flags and memory must stay. told: so many
 * of the sources are foreign to so much of the hole that there must be several things; else kin is
 * undefined. */
recede_status rc_kin_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                          int levels, rc_kin *kin, bool *told);
/* Memory it takes at the most, of each pixel of the coarsest level. */
#define RC_KIN_BYTES_PER_PX 68
/* Of a pixel of the coarsest level. */
rc_likeness rc_likeness_at(const rc_kin *kin, int x, int y);
rc_nearness rc_nearness_at(const rc_kin *kin, int x, int y);
/* From 0, what looks like nothing beside the hole there, to 1, what looks like enough of it. */
float rc_kinship(const rc_likeness *source, const rc_nearness *target);

#endif
