#include "synthesis/structure/reach.h"

#include <math.h>
#include <stdlib.h>

/* Samples to each side, and twice as many of what is broad, so many px from the hole, which else
 * lies beside it. */
#define SAMPLES 14
#define BROAD_FROM_PX 16.f
/* Its grounds may differ by so much of what stands out, and where less of that is left it ends. */
#define MOST_OF_STEP .35f
#define LEAST_OF_LINE .25f

static void measure(const rc_ruler *ruler, float outwards, float x, float y, int far, float from_px,
                    float reach_px[2]) {
  float values[4 * SAMPLES + 1], *at = values + far, most = 0;
  int middle = 0;
  for (int o = -far; o <= far; o++)
    if (!rc_ruler_mean(ruler, x, y, (float)o, outwards * from_px, outwards, RC_PROFILE_NEAR_PX,
                       &at[o]))
      return;
  float left = (at[-far] + at[1 - far]) / 2, right = (at[far] + at[far - 1]) / 2;
  float w = rc_chart_w(ruler->chart, x, y), px = rc_ruler_px(ruler->chart, x, y), unit = px / w;
  float ground = (left + right) / 2;
  for (int o = -RC_PROFILE_HALF; o <= RC_PROFILE_HALF; o++)
    if (fabsf(at[o] - ground) > most) most = fabsf(at[o] - ground), middle = o;
  if (!(w >= px) || fabsf(left - right) > MOST_OF_STEP * most) return;
  for (int side = 0; side < 2; side++) {
    int o = middle, step = side ? 1 : -1;
    while (abs(o) < far && fabsf(at[o] - ground) > LEAST_OF_LINE * most) o += step;
    if (abs(o) < far) reach_px[side] = fmaxf(reach_px[side], (float)(step * o) * unit);
  }
}

void rc_reach_measure(const rc_ruler *ruler, float outwards, float x, float y, bool may_be_broad,
                      float reach_px[2]) {
  measure(ruler, outwards, x, y, SAMPLES, RC_PROFILE_FROM_PX, reach_px);
  if (may_be_broad && reach_px[0] == 0 && reach_px[1] == 0)
    measure(ruler, outwards, x, y, 2 * SAMPLES, BROAD_FROM_PX, reach_px);
}
