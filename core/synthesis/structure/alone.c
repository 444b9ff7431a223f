#include "synthesis/structure/alone.h"

#include "synthesis/structure/follow.h"

/* Profiles are averaged along so many samples outside the hole. */
#define RUN 16
#define STEP_PX 2.f
/* Another line looks the same if their profiles correlate by so much, and neither has so many times
 * the other's contrast. */
#define LEAST_LIKENESS .8f
#define MOST_UNLIKE 2.f
/* So many may: there are two kerbs and two rails. Of bricks, tiles and boards 3 to 15 do. */
#define MOST_AGAIN 1
/* Of the angle between a line and a period that leads away from it. */
#define LEAST_SINE .3f
/* Periods are found at the coarsest level: here they are off by up to so many px. */
#define OFF_PX 3

typedef struct beside {
  const rc_seen *picture;
  const rc_crossing *line;
  rc_chart flat;
  rc_copy along; /* its direction in the plane, a unit vector */
} beside;

/* Of the line so moved, at its end b or, outwards being -1, a. */
static bool profile_of(const beside *at, rc_copy move, float outwards, rc_profile *profile) {
  const rc_crossing *c = at->line;
  rc_place a = rc_copy_place(&at->flat, move, c->ax - at->flat.x0, c->ay - at->flat.y0);
  rc_place b = rc_copy_place(&at->flat, move, c->bx - at->flat.x0, c->by - at->flat.y0);
  const rc_place *end = outwards < 0 ? &a : &b;
  float dx = b.x - a.x, dy = b.y - a.y, length = sqrtf(dx * dx + dy * dy);
  if (a.beyond || b.beyond || !(length > 0)) return false;
  rc_ruler ruler = {at->picture, dx / length, dy / length, NULL};
  return rc_profile_mean(&ruler, end->x + at->flat.x0, end->y + at->flat.y0,
                         outwards * RC_PROFILE_FROM_PX, outwards * STEP_PX, RUN, profile);
}

static bool alike(const rc_profile *p, const rc_profile *q) {
  return rc_profiles_alike(p, q, LEAST_LIKENESS, MOST_UNLIKE);
}

/* How often it comes again, in places next to one another once, until that is too often; and how
 * many were seen. */
static int count_again(const beside *at, float outwards, float px, int reach_px, int *seen) {
  rc_profile own, other;
  int count = 0;
  bool before = false;
  if (!profile_of(at, (rc_copy){0, 0, 0}, outwards, &own)) return 0;
  for (int k = -reach_px; k <= reach_px && count <= MOST_AGAIN; k++) {
    float across = (float)k * px;
    rc_copy move = {-across * at->along.b, across * at->along.a, 0};
    bool known = (k < -RC_PROFILE || k > RC_PROFILE) && profile_of(at, move, outwards, &other);
    bool again = known && alike(&own, &other);
    *seen += known, count += again && !before;
    before = again;
  }
  return count;
}

/* Whether a period that leads away from the line leads to one that looks the same, or out of what
 * is known. */
static bool comes_again_by(const beside *at, rc_copy period, float a_px, float b_px) {
  float length = sqrtf(period.a * period.a + period.b * period.b);
  int seen = 0;
  if (fabsf(period.a * at->along.b - period.b * at->along.a) < LEAST_SINE * length) return true;
  for (int n = 0; n < 4; n++) {
    float sign = n % 2 ? 1 : -1, outwards = n / 2 ? 1 : -1;
    rc_profile own;
    if (!profile_of(at, (rc_copy){0, 0, 0}, outwards, &own)) continue;
    float px = outwards < 0 ? a_px : b_px;
    for (int k = -OFF_PX; k <= OFF_PX; k++) {
      rc_copy move = {sign * period.a - (float)k * px * at->along.b,
                      sign * period.b + (float)k * px * at->along.a, 0};
      rc_profile other;
      if (!profile_of(at, move, outwards, &other)) continue;
      if (alike(&own, &other)) return true;
      seen++;
    }
  }
  return !seen;
}

bool rc_end_stands_alone(const rc_seen *picture, const rc_chart *chart, const rc_crossing *line,
                         int reach_px) {
  beside at = {picture, line, rc_chart_flat(*chart), rc_crossing_direction(chart, line)};
  float w = rc_chart_w(chart, line->bx, line->by);
  int seen = 0;
  return w > 0 && count_again(&at, 1, 1 / w, reach_px, &seen) <= MOST_AGAIN && seen >= reach_px / 2;
}

bool rc_stands_alone(const rc_seen *picture, const rc_chart *chart, const rc_crossing *line,
                     int reach_px, const rc_copy periods[2]) {
  beside at = {picture, line, rc_chart_flat(*chart), rc_crossing_direction(chart, line)};
  float a = rc_chart_w(chart, line->ax, line->ay), b = rc_chart_w(chart, line->bx, line->by);
  int seen = 0;
  if (!(a > 0 && b > 0)) return false;
  if (periods && comes_again_by(&at, periods[0], 1 / a, 1 / b) &&
      comes_again_by(&at, periods[1], 1 / a, 1 / b))
    return false;
  return count_again(&at, -1, 1 / a, reach_px, &seen) <= MOST_AGAIN &&
         count_again(&at, 1, 1 / b, reach_px, &seen) <= MOST_AGAIN && seen >= reach_px;
}
