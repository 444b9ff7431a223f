/* How textures go on along the lines that cross the hole. Boards run: moved along they stay what
 * they are, and such a hole is filled from what lies along it. Bricks and tiles repeat: each line
 * moved by itself would break the joints between them. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_RAILS_H
#define RECEDE_SYNTHESIS_STRUCTURE_RAILS_H

#include "synthesis/structure/lines.h"
#include "synthesis/structure/sides.h"

/* A direction of the plane, a unit vector; 0, 0: the texture does not run. Where its boards all
 * have one width, that is the gauge, px where w = 1, and joints lie where the distance across from
 * the chart's origin is joint + a multiple of it: moves across by up to so many rows keep them
 * there. Else rows is 0. */
typedef struct rc_rails {
  float a, b;
  float gauge, joint;
  int rows;
} rc_rails;

static inline bool rc_runs(const rc_rails *rails) { return rails->a != 0.f || rails->b != 0.f; }

/* The same rails at a level 2^exponent times coarser. */
static inline rc_rails rc_rails_coarser(rc_rails rails, int exponent) {
  rails.gauge /= (float)(1 << exponent), rails.joint /= (float)(1 << exponent);
  return rails;
}

/* Rails of the finest level, the chart that they are told in, and whether a fill kept to them. */
typedef struct rc_known_rails {
  rc_rails rails;
  rc_chart chart;
  bool kept;
} rc_known_rails;

/* The same in another chart of the plane. */
rc_rails rc_rails_in_chart(const rc_known_rails *known, const rc_chart *chart);

/* The copy that takes target (x, y) where moving the plane by (a, b) takes it; a = NAN: beyond the
 * horizon. */
rc_copy rc_copy_of_move(const rc_chart *chart, float x, float y, float a, float b);
/* The copy that takes target (x, y) from (to_x, to_y) or, were that off the rails by more than the
 * tolerance (px where w = 1), from the nearest point that is not. */
rc_copy rc_copy_on_rails(const rc_rails *rails, const rc_chart *chart, float tolerance, float x,
                         float y, float to_x, float to_y);

/* From the lines that cross the hole or, where none does and it nearly reaches the picture's end,
 * from how the texture beside it changes in all directions; sharpened by how alike the texture is
 * along them. may_repeat: where, beside the hole, it repeats, only lone lines stay. images and
 * masks: the pyramid's levels, finest first; from: that of the lines; chart: of the finest. */
recede_status rc_rails_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, int from, const rc_chart *chart, bool may_repeat,
                            rc_crossing *lines, int *count, rc_rails *rails);

/* Whether the texture runs along the rails on both sides of the boundary, px of the finest level.
 */
recede_status rc_runs_on_both_sides(rc_context *context, const rc_image *images,
                                    const rc_mask *masks, int levels, const rc_chart *chart,
                                    const rc_rails *rails, const rc_boundary *boundary, bool *runs);

#endif
