/* What may lie where in the hole. Of a thing that the hole only touches at one end, a hen, a path,
 * there is something beside the hole, so that it is neither unlike nor a stranger; but whole copies
 * of it fit far from there as well as any, with what lies around it. */
#ifndef RECEDE_SYNTHESIS_SOURCES_KIN_H
#define RECEDE_SYNTHESIS_SOURCES_KIN_H

#include "base/context.h"
#include "image/image.h"

/* Parts of what is beside the hole, a bit for each: of a source those that it looks like, of a
 * target pixel those that lie near it. Where they have none in common the source is no kin of what
 * lies there. All: nothing is known. */
typedef uint32_t rc_kin;
#define RC_ALL_KIN UINT32_MAX

/* image and flags: the coarsest level; kin: of each of its pixels. told: so many of the
 * sources are no kin of so much of the hole that there must be several things; else all of kin is
 * undefined. */
recede_status rc_kin_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                          rc_kin *kin, bool *told);

#endif
