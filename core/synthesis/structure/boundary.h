/* Where two textures meet in a straight line that crosses the hole: a road and its verge, a wall
 * and the roof it stands on. The line is moved in as other lines are, and what lies to one side of
 * it is copied from that side. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_BOUNDARY_H
#define RECEDE_SYNTHESIS_STRUCTURE_BOUNDARY_H

#include "synthesis/structure/rails.h"

/* Looks for one, and for others parallel to it. The first joins the lines, of which only those
 * parallel to it stay, and of these not those of a texture that repeats, but for one that stands
 * alone; a texture that runs another way than it does no longer runs, nor one that runs along it,
 * if a clear line lies there and only one side runs. Without one, or where the texture runs along
 * it otherwise, all stays as it is, and the sides have no boundary. images and masks: the pyramid's
 * levels, finest first; from: what rc_lines_level says. */
recede_status rc_boundary_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                               int levels, int from, const rc_chart *chart,
                               rc_crossing lines[RC_MOST_LINES], int *count, rc_rails *rails,
                               rc_sides *sides);
/* Where there are no sides: of a band that is not clear, sides on one ground. A kerb looks so much
 * like the setts beside it that pieces of it would lie about among them. */
void rc_boundary_of_band(const rc_chart *chart, const rc_crossing *lines, int count,
                         rc_sides *sides);

#endif
