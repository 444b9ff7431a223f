/* How well one texture, lying on one plane, explains a picture's local spectra. */
#ifndef RECEDE_PLANE_HOMOGENEITY_H
#define RECEDE_PLANE_HOMOGENEITY_H

#include "plane/lean.h"
#include "plane/spectra.h"

typedef struct rc_homogeneity {
  const rc_spectra *spectra;
  int width, height; /* of the picture, px */
  double focal_px;
  double ref_x, ref_y; /* px: lies on the plane */
  float *weight;       /* of each spectrum */
  bool chosen;         /* all of them are said to lie on the plane */
  bool raised;         /* the texture stands up from the plane: it shrinks but does not flatten */
  float saturation;    /* a cell's squared misfit from which on it counts as not of the plane */
} rc_homogeneity;

/* w over that at the reference, below which a cell is too near the horizon to be resolved. */
#define RC_RESOLVED_W .08
/* What a plane costs that leaves too little to compare. */
#define RC_IMPOSSIBLE 99.

/* Bytes of scratch memory that one call of rc_homogeneity_cost() needs. */
size_t rc_homogeneity_scratch(const rc_homogeneity *h);
/* Mean squared misfit in log2 of power, outliers saturated, or RC_IMPOSSIBLE.
 * misfit (may be NULL): that of every cell, NaN where the plane leaves too little to compare,
 * infinite beyond the horizon. */
double rc_homogeneity_cost(const rc_homogeneity *h, rc_lean lean, float *scratch, float *misfit);
/* Sets the saturation: twice the median misfit of the frontal plane. Real planes halve it where
 * they hold. */
recede_status rc_homogeneity_saturate(rc_context *context, rc_homogeneity *h, float *scratch);

#endif
