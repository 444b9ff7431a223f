/* Lines that run through the hole: cracks, kerbs, markings, the joints of boards. A patch sees too
 * little of one to carry it across. So they are found on both sides of the hole, followed there,
 * and the texture along them is moved in by pieces that keep each line where it must be. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_LINES_H
#define RECEDE_SYNTHESIS_STRUCTURE_LINES_H

#include "synthesis/structure/crossing.h"
#include "synthesis/structure/ends.h"

/* Signal to noise of a line on both sides of the hole. Edges of stones reach 7. Where nothing does
 * fainter ones may be asked for: even a kerb among setts has no more. */
#define RC_LEAST_STRENGTH 8.f
#define RC_LEAST_FAINT_STRENGTH 5.f

/* The finest level that lines are looked for in; -1: there is none, or no border. */
int rc_lines_level(const rc_mask *masks, int levels);
/* How much of a line's way between its ends is in the hole, 0..1, and whether nearly all of it is.
 * flags: of the same level. */
float rc_part_in_the_hole(const rc_mask *flags, const rc_crossing *line);
bool rc_lies_in_the_hole(const rc_mask *flags, const rc_crossing *line);
/* All that look the same on both sides of the hole, strongest first, px of that level. faint: if
 * there are none, fainter ones. */
recede_status rc_lines_at(rc_context *context, const rc_seen *seen, bool faint,
                          rc_crossing lines[RC_MOST_LINES], int *count);
/* The same of ends that are known. */
void rc_lines_pair_up(const rc_ends *ends, float least_strength, rc_crossing lines[RC_MOST_LINES],
                      int *count);
/* Parallel lines of the plane that cross the hole and can be continued, strongest first. image and
 * mask: the level rc_lines_level says, 2^exponent times coarser than the finest, of which chart is.
 * corners: only those that cut a corner off the hole. One that leaves it at a flat angle has the
 * hole beside it for long, and is seen better at the next coarser level. periods: as of
 * rc_stands_alone, px of the finest level. */
recede_status rc_lines_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                            int exponent, bool corners, const rc_chart *chart,
                            const rc_copy periods[2], rc_crossing lines[RC_MOST_LINES], int *count);

/* A strip between the hole and the picture's end that is no longer along a line, px of the lines'
 * level, shows no run of it. */
#define RC_STRIP_PX 32

/* Whether what leads away from the viewer may be more than so many times as narrow at one end of
 * the hole's box as at the other. chart: of the same level. */
bool rc_narrows_in(const rc_chart *chart, rc_box hole, float times);

#endif
