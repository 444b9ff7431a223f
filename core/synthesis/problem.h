/* What every method is asked: these pixels, these to fill, those to copy from, this plane. */
#ifndef RECEDE_SYNTHESIS_PROBLEM_H
#define RECEDE_SYNTHESIS_PROBLEM_H

#include "image/image.h"
#include "image/line.h"

typedef struct rc_problem {
  rc_image image; /* the part of the picture that matters; 0 where not KNOWN */
  rc_mask flags;  /* RC_TARGET, RC_KNOWN, RC_SOURCE */
  rc_box target;  /* bounding box of the TARGET pixels */
  rc_line line;   /* w: 1 at the target's centroid, proportional to 1 / depth, 0 on the horizon; all
                     that matters for copying within the plane */
  recede_plane plane;     /* of the whole picture */
  int origin_x, origin_y; /* of image in the whole picture */
  /* Columns and rows before image's first that lie beyond the horizon, and the shorter side of what
   * was looked at with them: what is decided by chance and by size goes by these. */
  int cut_x, cut_y, shorter_px;
  int exemplar_x, exemplar_y; /* synthesis: exemplar's pixel at image's (0, 0) */
  bool synthesis;             /* all of the exemplar is wanted */
  float least;                /* of a laid exemplar's known values, or 0 if that is less */
} rc_problem;

/* Each fills the TARGET pixels of *filled, which starts as problem->image (for method plane it IS
 * problem->image, whose other pixels may then be overwritten, and takes RC_SOURCE from what is far
 * from the hole or looks like nothing beside it); progress runs over 0.05..0.97. */
recede_status rc_fill_in_steps(rc_context *context, const rc_problem *problem,
                               const recede_params *params, rc_image *filled);
/* Methods paper and kwatra: params->method says which. */
recede_status rc_fill_paper(rc_context *context, const rc_problem *problem,
                            const recede_params *params, rc_image *filled);
/* The paper's section 4: exemplar (flags: RC_SOURCE where usable) to result's size; plane is the
 * exemplar's. result is allocated by the caller. */
recede_status rc_synthesize_paper(rc_context *context, const rc_image *exemplar,
                                  const rc_mask *flags, const recede_plane *plane,
                                  const recede_params *params, rc_image *result);

/* Upper bounds of memory beyond the problem itself (and the result), bytes: for so many pixels
 * looked at, and (method plane) the target's bounding box. */
uint64_t rc_plane_bytes(uint64_t pixels, uint64_t columns, uint64_t rows, int channels,
                        const recede_params *params);
uint64_t rc_paper_bytes(uint64_t exemplar_pixels, int channels, const recede_params *params);

#endif
