/* Makes the problem of a fill or a synthesis from the caller's views. */
#ifndef RECEDE_SYNTHESIS_PROBLEM_BUILD_H
#define RECEDE_SYNTHESIS_PROBLEM_BUILD_H

#include "image/shrink.h"
#include "synthesis/problem.h"

typedef struct rc_target_summary {
  rc_box box; /* of the mask's pixels above 0 */
  uint64_t pixels;
  double x, y; /* centroid */
  rc_box looked_at;
} rc_target_summary;

/* Of what the mask has there: below the line through (line[0], line[1]) and (line[2], line[3]), all
 * where line is NULL. No pixels: the rest says nothing. */
recede_status rc_sum_target(rc_context *context, const recede_view *mask, rc_box within,
                            const double line[4], rc_target_summary *summary);
/* Of all the mask. RECEDE_EMPTY_TARGET when it selects nothing. */
recede_status rc_summarize_target(rc_context *context, const recede_view *mask,
                                  rc_target_summary *summary);
/* Sets the part of the picture that a fill looks at: the target's box with its surroundings, and
 * all of a source mask that has hardly anything there. */
recede_status rc_look_around(rc_context *context, const rc_views *views,
                             rc_target_summary *summary);
/* Target pixels on or beyond the horizon are refused: counted in the report, left as they were. */
recede_status rc_problem_of_fill(rc_context *context, const rc_views *views,
                                 const recede_plane *plane, const rc_target_summary *summary,
                                 rc_problem *problem);
/* A canvas of plane->width x plane->height, the exemplar in its middle, or laid onto the plane
 * (lay.h); the rest is to be filled. RECEDE_NO_PLANE where that lies beyond the horizon. */
recede_status rc_problem_of_synthesis(rc_context *context, const rc_views *exemplar,
                                      const recede_plane *plane, bool laid, rc_problem *problem);

#endif
