/* Faint bands of tone that run along the plane: wheel tracks, a polished aisle, stripes of a mown
 * lawn. Copies bring bands of their own, which end at the hole and begin again behind it. So they
 * are taken away before anything is copied, and led through the hole. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_TRACKS_H
#define RECEDE_SYNTHESIS_STRUCTURE_TRACKS_H

#include "synthesis/copy.h"
#include "synthesis/structure/plan.h"

typedef struct rc_tracks {
  rc_plan tone;        /* of the bands; sums NULL: there are none */
  float alike, across; /* correlations of what lies along them, anywhere and beyond the hole */
} rc_tracks;

/* images and flags: the pyramid's levels, finest first; chart: of the finest; brightness: what
 * faint is told by. */
recede_status rc_tracks_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                             int levels, const rc_chart *chart, double brightness,
                             rc_tracks *tracks);
/* Adds sign times the bands' tone to the pixels with that flag of a level, of which chart is. */
recede_status rc_tracks_apply(rc_context *context, const rc_tracks *tracks, const rc_chart *chart,
                              int exponent, const rc_mask *flags, uint8_t flag, float sign,
                              rc_image *image);

#endif
