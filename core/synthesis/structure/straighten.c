#include "synthesis/structure/straighten.h"

#include <math.h>

/* It is turned until it lies where the line is so far away, and twice as far and so on: within so
 * many px of where the turn before puts it, and where its profile correlates by so much. */
#define STEP_PX 24.f
#define STEPS 4
#define WITHIN_PX 2.f
#define WITHIN_STEP_PX .25f
#define LEAST_LIKENESS .75f

/* The correlation of what lies so far out, and so far across, with own; -1: nothing is known. */
static float likeness_at(const rc_ruler *ruler, const rc_crossing *line, float along, float across,
                         const rc_profile *own) {
  rc_profile here;
  if (!rc_profile_mean(ruler, line->bx - ruler->uy * across, line->by + ruler->ux * across, along,
                       1, RC_PROFILE_NEAR_PX, &here))
    return -1;
  float square = rc_profile_dot(&here, &here) * rc_profile_dot(own, own);
  return square > 0 ? rc_profile_dot(&here, own) / sqrtf(square) : -1;
}

void rc_straighten(rc_ruler *ruler, const rc_profile *own, rc_crossing *line) {
  for (int n = 1; n <= STEPS; n++) {
    float along = STEP_PX * (float)n, most = LEAST_LIKENESS, off = NAN;
    for (float across = -WITHIN_PX; across <= WITHIN_PX; across += WITHIN_STEP_PX) {
      float likeness = likeness_at(ruler, line, along, across, own);
      if (likeness > most) most = likeness, off = across;
    }
    if (isnan(off)) return;
    float turn = off / (along + RC_PROFILE_NEAR_PX / 2.f), length = rc_crossing_length(line);
    line->ax = line->bx - length * (ruler->ux - turn * ruler->uy);
    line->ay = line->by - length * (ruler->uy + turn * ruler->ux);
    length = rc_crossing_length(line);
    ruler->ux = (line->bx - line->ax) / length, ruler->uy = (line->by - line->ay) / length;
  }
}
