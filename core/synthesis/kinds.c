#include "synthesis/kinds.h"

#include <math.h>

#include "synthesis/standing.h"
#include "synthesis/surface.h"

/* The surface is judged on a picture of about this width. */
#define SURFACE_LONGEST_PX 1100
/* Raised when it is likely: most flat textures measure .4 .. 1.2 (their contrast within a texel
 * leans less than they do), stones 0 .. .1, an old pier's boards .15 .. .2. With nothing to lean
 * both maps are the same, and the raised one keeps to whole pixels but along lines. */
#define LEAN_OF_RAISED .32

/* What stands is judged on this level. */
static int level_of(const rc_image *images, int levels) {
  int exponent = 0;
  while (exponent + 1 < levels && images[exponent].width > SURFACE_LONGEST_PX) exponent++;
  return exponent;
}

recede_status rc_choose_surface(rc_context *context, const rc_problem *problem,
                                const rc_image *images, const rc_mask *masks, int levels,
                                recede_surface asked, bool *raised) {
  int n = level_of(images, levels);
  double lean, error = 0;
  if (asked != RECEDE_SURFACE_AUTO) {
    *raised = asked == RECEDE_SURFACE_RAISED;
    return RECEDE_OK;
  }
  RC_TRY(rc_measure_lean(context, problem, &images[n], &masks[n], n, &lean, &error));
  if (!isnan(lean)) *raised = lean + error < LEAN_OF_RAISED;
  return RECEDE_OK;
}

recede_status rc_find_standing(rc_context *context, const rc_problem *problem,
                               const rc_image *images, const rc_mask *masks, int levels,
                               rc_chart *chart) {
  int n = level_of(images, levels);
  return rc_measure_standing(context, problem, &images[n], &masks[n], n, chart, &chart->standing_w);
}
