/* Lines that run through the hole: cracks, kerbs, markings, the joints of boards. A patch sees too
 * little of one to carry it across. So they are found on both sides of the hole, followed there,
 * and the texture along them is moved in by pieces that keep each line where it must be. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_LINES_H
#define RECEDE_SYNTHESIS_STRUCTURE_LINES_H

#include "image/image.h"
#include "synthesis/copy.h"

#define RC_MOST_LINES 8
#define RC_LINE_PIECES 8

/* Signal to noise of what is no chance: markings and kerbs have 100 and more. */
#define RC_CLEAR_STRENGTH 100.f

/* A line from the hole's border at a to that at b, px of the finest level. */
typedef struct rc_crossing {
  float ax, ay, bx, by;
  float strength;  /* signal to noise of its weaker side */
  float rise;      /* -1..1: how far a is a step across */
  float as_strong; /* the part of the rest of the hole's border where some line is as strong */
  float axis[3];   /* the weights of colours it was seen by */
  float from_x[RC_LINE_PIECES], from_y[RC_LINE_PIECES]; /* where each piece's middle comes from */
} rc_crossing;

float rc_crossing_length(const rc_crossing *line);
/* Distance of (x, y) from the line, however far beyond its ends. */
float rc_crossing_distance(const rc_crossing *line, float x, float y);
/* Its direction in the plane, a unit vector. chart: of the same level. */
rc_copy rc_crossing_direction(const rc_chart *chart, const rc_crossing *line);
/* Of two such directions, within 4 degrees. */
bool rc_parallel_in_plane(rc_copy a, rc_copy b);
/* The same line in px of a level 2^exponent times coarser; a negative exponent: finer. */
rc_crossing rc_crossing_coarser(rc_crossing line, int exponent);
/* One level of the picture, as lines are looked for in it. */
typedef struct rc_seen {
  const rc_mask *flags;
  const float *value;
} rc_seen;

/* The level's pixels by these weights of their channels. */
recede_status rc_see(rc_context *context, const rc_image *image, const rc_mask *flags,
                     const float axis[3], rc_seen *seen);
/* The finest level that lines are looked for in; -1: there is none, or no border. */
int rc_lines_level(const rc_mask *masks, int levels);
/* Target pixels that touch known ones. */
int rc_border_length(const rc_mask *flags);
/* All that look the same on both sides of the hole, strongest first, px of that level. */
recede_status rc_lines_at(rc_context *context, const rc_seen *seen,
                          rc_crossing lines[RC_MOST_LINES], int *count);
/* Parallel lines of the plane that cross the hole and can be continued, strongest first. image and
 * mask: the level rc_lines_level says, 2^exponent times coarser than the finest, of which chart is.
 */
recede_status rc_lines_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                            int exponent, const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                            int *count);

#endif
