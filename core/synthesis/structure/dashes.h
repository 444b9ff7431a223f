/* Dashes: what is brighter than the plane around it and longer than wide, as those of a road. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_DASHES_H
#define RECEDE_SYNTHESIS_STRUCTURE_DASHES_H

#include <math.h>

#include "image/image.h"
#include "synthesis/structure/ground.h"

/* More are a texture. */
#define RC_MOST_DASHES 96

/* Places and lengths are those on the ground. */
typedef struct rc_dash {
  double u, v;          /* its middle */
  double a, b;          /* a unit vector: the way it is long */
  double length, width; /* of the rectangle with its moments */
  double w;             /* at its middle */
  double contrast;      /* to what lies around */
  bool complete;        /* nothing of it lies in the hole or out of the picture */
  double uu, uv, vv;    /* its second moments */
  double cut_u, cut_v;  /* the middle of where it ends so, if it does */
} rc_dash;

typedef struct rc_dashes {
  int width, height; /* of the level */
  float *off;        /* how far each pixel is from the mean around it; NAN: not looked at */
  rc_dash found[RC_MOST_DASHES];
  int count; /* 0 where there are too many */
} rc_dashes;

/* Of the pixel next to a place. False: it is not looked at. */
static inline bool rc_dashes_off(const rc_dashes *dashes, double x, double y, double *off) {
  int px = (int)floor(x + .5), py = (int)floor(y + .5);
  if (!rc_inside(dashes->width, dashes->height, px, py)) return false;
  *off = (double)dashes->off[(size_t)py * (size_t)dashes->width + (size_t)px];
  return !isnan(*off);
}

/* In a level 2^exponent times coarser than the finest; only what is or was a source is looked at.
 */
recede_status rc_dashes_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                             const rc_ground *ground, int exponent, rc_dashes *dashes);
/* The same dashes on another ground, nearly: what a px is there is not looked at anew, and their
 * moments and where they are cut stay as they were. */
void rc_dashes_move(const rc_dashes *from, const rc_ground *old, const rc_ground *ground,
                    rc_dashes *to);

#endif
