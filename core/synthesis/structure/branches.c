#include "synthesis/structure/branches.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/structure/alone.h"
#include "synthesis/structure/ends.h"
#include "synthesis/structure/follow.h"

/* Shorter ones a patch carries on. */
#define SHORTEST_PX 8.f
/* It must lie so much in the hole, and meet the line at such an angle: sine. */
#define LEAST_INSIDE .7f
#define LEAST_SINE .4f
/* Its direction is looked for so much to each side of the best of all, in so many steps. */
#define TURN_STEP .008f
#define TURNS 4
/* And across, px. */
#define ACROSS_STEP_PX .5f
#define ACROSS 4

static void turn_by(float by, const float from[2], float to[2]) {
  float x = from[0] - by * from[1], y = from[1] + by * from[0], length = sqrtf(x * x + y * y);
  to[0] = x / length, to[1] = y / length;
}

/* The place and direction near those of a border pixel where the line is clearest. */
static void refine(const rc_ends *ends, int item, float at[2], float out[2], rc_run *run) {
  int width = ends->picture.flags->width;
  float x = (float)(ends->border[item] % width), y = (float)(ends->border[item] / width);
  const float *best = ends->direction[ends->best_direction[item]];
  *run = (rc_run){.strength = 0};
  for (int turn = -TURNS; turn <= TURNS; turn++)
    for (int step = -ACROSS; step <= ACROSS; step++) {
      float u[2], across = ACROSS_STEP_PX * (float)step;
      turn_by(TURN_STEP * (float)turn, best, u);
      float px = x - across * u[1], py = y + across * u[0];
      rc_run here = rc_run_measure(&ends->picture, px, py, u[0], u[1], 1);
      if (here.strength < RC_LEAST_STRENGTH || here.clarity <= run->clarity) continue;
      *run = here;
      memcpy(out, u, sizeof u), at[0] = px, at[1] = py;
    }
}

/* How far inwards it meets a line between its ends; infinite: nowhere, or at a flat angle. */
static float way_to(const rc_crossing *line, const float at[2], const float out[2]) {
  float dx = line->bx - line->ax, dy = line->by - line->ay, length = sqrtf(dx * dx + dy * dy);
  float sine = (dx * out[1] - dy * out[0]) / length;
  if (fabsf(sine) < LEAST_SINE) return INFINITY;
  float ox = at[0] - line->ax, oy = at[1] - line->ay;
  float way = (dx * oy - dy * ox) / (length * sine);
  float along = ((ox - way * out[0]) * dx + (oy - way * out[1]) * dy) / (length * length);
  return way > 0 && along > 0 && along < 1 ? way : INFINITY;
}

static bool lies_in_the_hole(const rc_mask *flags, const rc_crossing *c) {
  int inside = 0, samples = 32;
  for (int i = 1; i < samples; i++) {
    float t = (float)i / (float)samples;
    int x = (int)floorf(c->ax + t * (c->bx - c->ax) + .5f);
    int y = (int)floorf(c->ay + t * (c->by - c->ay) + .5f);
    inside += (*rc_flag(flags, x, y) & RC_TARGET) != 0;
  }
  return (float)inside > LEAST_INSIDE * (float)samples;
}

/* One of a line's own ends, or the other edge of one that is wide. */
static bool is_of(const rc_crossing *line, const rc_crossing *c) {
  return rc_crossing_distance(line, c->bx, c->by) <= RC_PROFILE ||
         (line->ends_inside && fabsf(line->bx - c->bx) <= RC_PROFILE &&
          fabsf(line->by - c->by) <= RC_PROFILE);
}

static bool meets_one(const rc_ends *ends, int item, const rc_crossing *lines, int line_count,
                      rc_crossing *branch) {
  float at[2], out[2], way = INFINITY;
  rc_run run;
  refine(ends, item, at, out, &run);
  if (!(run.clarity > 0)) return false;
  for (int i = 0; i < line_count; i++) way = fminf(way, way_to(&lines[i], at, out));
  *branch = (rc_crossing){.bx = at[0], .by = at[1], .strength = run.strength, .ends_inside = true};
  if (!(way >= SHORTEST_PX) || way == INFINITY) return false;
  branch->ax = at[0] - way * out[0], branch->ay = at[1] - way * out[1];
  for (int i = 0; i < line_count; i++)
    if (is_of(&lines[i], branch)) return false;
  branch->as_strong = rc_ends_as_strong(ends, branch);
  return branch->as_strong <= RC_MOST_AS_STRONG && lies_in_the_hole(ends->picture.flags, branch);
}

/* Strongest first; of those beside one another the stronger stays. */
static void keep(rc_crossing branches[RC_MOST_BRANCHES], int *count, rc_crossing c) {
  int at = 0;
  for (int i = 0; i < *count; i++) {
    if (!is_of(&branches[i], &c)) continue;
    if (branches[i].strength >= c.strength) return;
    memmove(&branches[i], &branches[i + 1], (size_t)(*count - i - 1) * sizeof c);
    (*count)--, i--;
  }
  while (at < *count && branches[at].strength >= c.strength) at++;
  if (at == RC_MOST_BRANCHES) return;
  int moved = (*count < RC_MOST_BRANCHES ? *count : RC_MOST_BRANCHES - 1) - at;
  memmove(&branches[at + 1], &branches[at], (size_t)moved * sizeof c);
  branches[at] = c;
  if (*count < RC_MOST_BRANCHES) (*count)++;
}

recede_status rc_branches_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                               int exponent, const rc_chart *chart, const rc_crossing *lines,
                               int line_count, rc_crossing branches[RC_MOST_BRANCHES],
                               int *count) {
  rc_chart here = rc_chart_coarser(*chart, exponent);
  rc_crossing there[RC_MOST_LINES];
  rc_seen seen;
  rc_ends ends;
  int kept = 0, reach_px = rc_longer_side(rc_box_of(mask, RC_TARGET));
  rc_block *mark = rc_mark(context);
  *count = 0;
  RC_TRY(rc_see(context, image, mask, lines->axis, &seen));
  RC_TRY(rc_ends_find(context, &seen, &ends));
  for (int i = 0; i < line_count; i++) there[i] = rc_crossing_coarser(lines[i], exponent);
  for (int i = 0; i < ends.border_count; i++) {
    rc_crossing branch;
    if (rc_end_stands_out(&ends, i, RC_LEAST_STRENGTH) &&
        meets_one(&ends, i, there, line_count, &branch))
      keep(branches, count, branch);
  }
  for (int i = 0; i < *count; i++) {
    rc_crossing c = branches[i];
    if (!rc_follow_branch(&seen, &here, rc_windows_of(&c, false), &c) ||
        !rc_crossing_is_sure(&c) || !rc_end_stands_alone(&seen, &here, &c, reach_px))
      continue;
    branches[kept++] = rc_crossing_coarser(c, -exponent);
  }
  *count = kept;
  rc_release(context, mark);
  return rc_poll(context);
}
