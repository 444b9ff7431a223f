#include "synthesis/structure/boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/structure/axes.h"
#include "synthesis/structure/ends.h"
#include "synthesis/structure/follow.h"
#include "synthesis/structure/lines.h"
#include "synthesis/structure/repeats.h"

/* Stones and grass are noise to a line. So it is looked for so many levels coarser than others are,
 * where it is wide and they are small. */
#define LEAST_COARSER 1
#define MOST_COARSER 2
/* The hole's border has so many pixels there still. */
#define LEAST_BORDER 60
/* At the coarsest level strips beside the line, outside the hole, differ in the same way at both
 * ends; the product of the differences is so much of the picture's variance. Where two textures
 * meet 1.6 to 4.3, joints of bricks and tiles -.1 to .9, and one 1.2 that does not go on. */
#define STRIP_FROM_PX 1.5f
#define STRIP_TO_PX 5.5f
#define STRIP_LENGTH_PX 12
#define MARKED_BESIDE_PX 1
#define LEAST_SEEN 8
#define LEAST_STEP 1.f
/* Others are looked for so far to each side of the line, px where w = 1, none so near as its own
 * step reaches, and lie in the middle of where their step is this part of its greatest. Moved
 * towards the horizon, or to the viewer, a line may get longer than any picture is. */
#define LEAST_BESIDE_PX 4
#define MOST_BESIDE_PX 32
#define PART_OF_PEAK .5f
#define FARTHEST_END_PX 1e4f
/* What is less in the hole lies beside it. */
#define LEAST_PART_IN_THE_HOLE .1f

/* The coarsest level, and the sure lines that were found before. What they reach tells nothing of
 * the ground beside them: a road has the same on both sides of its marking. */
typedef struct coarsest {
  const rc_image *image;
  const rc_mask *flags;
  rc_chart chart;
  rc_crossing markings[RC_MOST_LINES];
  int marking_count;
} coarsest;

typedef struct strip {
  float mean[3];
  int seen;
} strip;

static bool is_marked(const coarsest *c, float x, float y) {
  for (int i = 0; i < c->marking_count; i++) {
    const rc_crossing *m = &c->markings[i];
    float reach = m->reach_px[rc_crossing_is_right(m, x, y)] * rc_chart_w(&c->chart, x, y);
    if (rc_crossing_distance(m, x, y) <= reach + MARKED_BESIDE_PX) return true;
  }
  return false;
}

/* Beside the run that leaves (x, y) along u, from so far on; side -1 or 1 of u. */
static strip look(const coarsest *c, float x, float y, float ux, float uy, float side, int from) {
  const rc_image *image = c->image;
  strip s = {{0, 0, 0}, 0};
  for (int along = from + 1; along <= from + STRIP_LENGTH_PX; along++)
    for (float across = STRIP_FROM_PX; across <= STRIP_TO_PX; across++) {
      int px = (int)floorf(x + ux * (float)along - uy * across * side + .5f);
      int py = (int)floorf(y + uy * (float)along + ux * across * side + .5f);
      if (!rc_inside(image->width, image->height, px, py)) continue;
      if (!(*rc_flag(c->flags, px, py) & RC_SOURCE) || is_marked(c, (float)px, (float)py)) continue;
      for (int k = 0; k < image->channels; k++) s.mean[k] += rc_pixel(image, px, py)[k];
      s.seen++;
    }
  for (int k = 0; k < 3 && s.seen; k++) s.mean[k] /= (float)s.seen;
  return s;
}

/* The product of both ends' steps, so far from the hole; 0: too little is known there. */
static float step_across(const coarsest *in, const rc_crossing *c, int from) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy), sum = 0;
  float ux = dx / length, uy = dy / length;
  strip a = look(in, c->ax, c->ay, -ux, -uy, -1, from);
  strip b = look(in, c->ax, c->ay, -ux, -uy, 1, from);
  strip p = look(in, c->bx, c->by, ux, uy, 1, from);
  strip q = look(in, c->bx, c->by, ux, uy, -1, from);
  if (a.seen < LEAST_SEEN || b.seen < LEAST_SEEN || p.seen < LEAST_SEEN || q.seen < LEAST_SEEN)
    return 0;
  for (int k = 0; k < in->image->channels; k++)
    sum += (a.mean[k] - b.mean[k]) * (p.mean[k] - q.mean[k]);
  return sum;
}

/* Seen coarser, by 2^exponent, the hole reaches to what lies beside it. */
static void drop_beside(const rc_mask *finest, int exponent, rc_crossing *lines, int *count) {
  int kept = 0;
  for (int i = 0; i < *count; i++) {
    rc_crossing c = rc_crossing_coarser(lines[i], -exponent);
    if (rc_part_in_the_hole(finest, &c) > LEAST_PART_IN_THE_HOLE) lines[kept++] = lines[i];
  }
  *count = kept;
}

/* The line with the greatest step among those that go on by themselves, of faint ones among those
 * that would be bands; *found false: there is none. Of the others the strongest band becomes *band,
 * unless that is one. */
static recede_status choose(rc_context *context, const coarsest *in, int coarser,
                            const rc_seen *seen, const rc_chart *chart, float least,
                            const rc_crossing *lines, int count, rc_crossing *best,
                            rc_crossing *band, bool *found) {
  const float least_of_any = least;
  *found = false;
  for (int i = 0; i < count; i++) {
    RC_TRY(rc_poll(context));
    rc_crossing c = lines[i], there = rc_crossing_coarser(c, coarser);
    float step = step_across(in, &there, 0);
    bool steps = step >= least, one_ground = step < least_of_any && !band->band;
    if (!(steps || one_ground) || !rc_follow(seen, chart, rc_windows_of(&c, true), &c)) continue;
    rc_crossing_tell_band(&c, true);
    if (steps && c.strength < RC_LEAST_STRENGTH && !c.band) continue;
    if (steps) c.band = false;
    rc_crossing_forget_chance(&c);
    if (steps)
      *best = c, least = step, *found = true;
    else if (c.band)
      *band = c;
  }
  return RECEDE_OK;
}

static rc_boundary boundary_of(const rc_chart *chart, const rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy);
  float nx = -dy / length, ny = dx / length;
  return (rc_boundary){nx, ny, nx * (chart->x0 - c->ax) + ny * (chart->y0 - c->ay)};
}

/* The line moved across by so many px of where w = 1, its ends where it leaves the hole; beside the
 * hole, where they come to lie. False: beyond the horizon. */
static bool move_across(const coarsest *in, const rc_crossing *line, float px, rc_crossing *moved) {
  rc_chart flat = rc_chart_flat(in->chart);
  rc_copy along = rc_crossing_direction(&in->chart, line);
  rc_copy move = {-px * along.b, px * along.a, 0};
  rc_place a = rc_copy_place(&flat, move, line->ax - flat.x0, line->ay - flat.y0);
  rc_place b = rc_copy_place(&flat, move, line->bx - flat.x0, line->by - flat.y0);
  float dx = b.x - a.x, dy = b.y - a.y, length = sqrtf(dx * dx + dy * dy);
  if (a.beyond || b.beyond || !(length >= 1 && length < FARTHEST_END_PX)) return false;
  float x = a.x + flat.x0, y = a.y + flat.y0, ux = dx / length, uy = dy / length;
  int first = 0, last = 0, far = (int)length + in->flags->width + in->flags->height;
  for (int k = -far; k <= far; k++) {
    int ix = (int)floorf(x + ux * (float)k + .5f), iy = (int)floorf(y + uy * (float)k + .5f);
    if (!rc_inside(in->flags->width, in->flags->height, ix, iy)) continue;
    if (!(*rc_flag(in->flags, ix, iy) & RC_TARGET)) continue;
    if (first == last) first = k;
    last = k + 1;
  }
  *moved = *line;
  if (first == last) first = 0, last = (int)length;
  moved->ax = x + ux * (float)first, moved->ay = y + uy * (float)first;
  moved->bx = x + ux * (float)last, moved->by = y + uy * (float)last;
  return true;
}

/* Where a strip of a third texture lies beside the line, as a kerb does, it ends in a parallel line
 * that steps, too. in: the coarsest level, line: the first one there. */
static void find_beside(const coarsest *in, float least, const rc_crossing *line, rc_sides *sides) {
  float steps[2 * MOST_BESIDE_PX + 1];
  rc_crossing moved;
  for (int k = 0; k <= 2 * MOST_BESIDE_PX; k++)
    steps[k] =
        move_across(in, line, (float)(k - MOST_BESIDE_PX), &moved) ? step_across(in, &moved, 0) : 0;
  while (sides->boundary_count < RC_MOST_BOUNDARIES) {
    int most = 0, low, high;
    float sum = 0, place = 0;
    for (int k = 0; k <= 2 * MOST_BESIDE_PX; k++)
      if (abs(k - MOST_BESIDE_PX) >= LEAST_BESIDE_PX && steps[k] > steps[most]) most = k;
    if (abs(most - MOST_BESIDE_PX) < LEAST_BESIDE_PX || !(steps[most] > least)) return;
    for (low = most; low > 0 && steps[low - 1] > PART_OF_PEAK * steps[most]; low--) continue;
    for (high = most; high < 2 * MOST_BESIDE_PX && steps[high + 1] > PART_OF_PEAK * steps[most];
         high++)
      continue;
    for (int k = low; k <= high; k++)
      sum += steps[k], place += steps[k] * (float)(k - MOST_BESIDE_PX);
    bool own = low <= MOST_BESIDE_PX && high >= MOST_BESIDE_PX;
    for (int k = low - LEAST_BESIDE_PX; k <= high + LEAST_BESIDE_PX; k++)
      if (k >= 0 && k <= 2 * MOST_BESIDE_PX) steps[k] = 0;
    if (own || !move_across(in, line, place / sum, &moved)) continue;
    float farther = step_across(in, &moved, STRIP_LENGTH_PX);
    if (farther != 0 && farther < least) continue;
    sides->boundaries[sides->boundary_count++] = boundary_of(&in->chart, &moved);
  }
}

/* By the colour that varies most, then by what tells textures apart, then, for bands alone, by
 * contrast: a kerb as dark as half of the setts is even where they are not. */
enum { VARIES, TELLS, IS_EVEN };

/* before: lines that were found. Searches the levels for the line between two textures, px of the
 * finest level; *apart_px: no other is nearer. sides: that one and those beside it. *found false:
 * there is none, but there may be a band. */
static recede_status search(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, int from, const rc_chart *chart, const rc_crossing *before,
                            int before_count, rc_crossing *line, float *apart_px, bool *found,
                            rc_sides *sides, rc_crossing *band) {
  int last = levels - 1, count;
  coarsest in = {&images[last], &masks[last], rc_chart_coarser(*chart, last), .marking_count = 0};
  rc_covariance far = rc_covariance_of(in.image, in.flags);
  bool faint = false;
  rc_crossing lines[RC_MOST_LINES], best;
  *found = false;
  *band = (rc_crossing){.band = false};
  for (int i = 0; i < before_count; i++)
    if (rc_crossing_is_sure(&before[i]))
      in.markings[in.marking_count++] = rc_crossing_coarser(before[i], last);
  float least = LEAST_STEP * (float)rc_covariance_trace(&far);
  if (!(least > 0)) return RECEDE_OK; /* there are no two textures */
  for (int exponent = from + LEAST_COARSER;
       exponent <= from + MOST_COARSER && exponent < levels && !*found; exponent++) {
    rc_seen seen;
    rc_chart here = rc_chart_coarser(*chart, exponent);
    if (rc_border_length(&masks[exponent]) < LEAST_BORDER) return RECEDE_OK;
    rc_covariance all = rc_covariance_of(&images[exponent], &masks[exponent]);
    for (int way = VARIES; way <= IS_EVEN && !*found; way++) {
      if ((way == TELLS && in.image->channels == 1) || (way == IS_EVEN && band->band)) continue;
      rc_block *mark = rc_mark(context);
      if (way == TELLS)
        rc_telling_axis(&all, &far, line->axis);
      else
        rc_principal_axis(&all, line->axis);
      RC_TRY(rc_see(context, &images[exponent], &masks[exponent], line->axis, &seen));
      if (way == IS_EVEN) RC_TRY(rc_see_contrast(context, &seen));
      RC_TRY(rc_lines_at(context, &seen, true, lines, &count));
      drop_beside(&masks[0], exponent, lines, &count);
      faint = way > VARIES;
      rc_crossing another = {.band = band->band};
      RC_TRY(choose(context, &in, last - exponent, &seen, &here, least, lines, count, &best,
                    &another, found));
      if (way == IS_EVEN) *found = false; /* that is for bands */
      if (!band->band && another.band) {
        *band = rc_crossing_coarser(another, -exponent);
        band->faint = faint;
        memcpy(band->axis, line->axis, sizeof band->axis);
      }
      rc_release(context, mark);
    }
    if (!*found) continue;
    memcpy(best.axis, line->axis, sizeof best.axis);
    best.faint = faint;
    *line = rc_crossing_coarser(best, -exponent);
    *apart_px = (float)(RC_PROFILE << exponent);
    sides->boundaries[0] = boundary_of(chart, line);
    sides->boundary_count = 1;
    best = rc_crossing_coarser(*line, last);
    find_beside(&in, least, &best, sides);
    for (int i = 1; i < sides->boundary_count; i++) sides->boundaries[i].at *= (float)(1 << last);
  }
  return RECEDE_OK;
}

void rc_boundary_of_band(const rc_chart *chart, const rc_crossing *lines, int count,
                         rc_sides *sides) {
  for (int i = 0; i < count && !rc_has_sides(sides); i++) {
    if (!lines[i].band || lines[i].strength >= RC_CLEAR_STRENGTH) continue;
    sides->boundaries[sides->boundary_count++] = boundary_of(chart, &lines[i]);
    sides->one_ground = true;
  }
}

/* A sleeper's edge may step as a boundary does, but the rail across it is certain. */
static bool crosses_a_lone_line(const rc_chart *chart, rc_copy direction, const rc_crossing *lines,
                                int count) {
  for (int i = 0; i < count; i++)
    if (rc_crossing_is_marking(&lines[i]) &&
        !rc_parallel_in_plane(direction, rc_crossing_direction(chart, &lines[i])))
      return true;
  return false;
}

static bool is_the_same(const rc_crossing *line, float apart_px, const rc_crossing *other) {
  return rc_crossing_distance(line, other->ax, other->ay) < apart_px &&
         rc_crossing_distance(line, other->bx, other->by) < apart_px;
}

/* As the edge of a beam between boards and water does. Boards' joints are not as clear. */
static bool lies_along_a_clear_line(const rc_crossing *line, float apart_px,
                                    const rc_crossing *lines, int count) {
  for (int i = 0; i < count; i++)
    if (lines[i].strength >= RC_CLEAR_STRENGTH && is_the_same(line, apart_px, &lines[i]))
      return true;
  return false;
}

recede_status rc_boundary_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                               int levels, int from, const rc_chart *chart,
                               rc_crossing lines[RC_MOST_LINES], int *count, rc_rails *rails,
                               rc_sides *sides) {
  rc_crossing line, band, kept[RC_MOST_LINES];
  float apart_px = 0;
  bool found, again = false, boards;
  int kept_count = 0;
  rc_sides sought = {.boundary_count = 0};
  sides->boundary_count = 0;
  RC_TRY(search(context, images, masks, levels, from, chart, lines, *count, &line, &apart_px,
                &found, &sought, &band));
  if (!found && band.band && !*count && !rc_runs(rails)) lines[(*count)++] = band;
  if (!found) return RECEDE_OK;
  rc_copy direction = rc_crossing_direction(chart, &line);
  bool as_rails = rc_parallel_in_plane(direction, (rc_copy){rails->a, rails->b, 0});
  if (as_rails && !lies_along_a_clear_line(&line, apart_px, lines, *count)) return RECEDE_OK;
  const rc_boundary *between = &sought.boundaries[0];
  RC_TRY(rc_runs_on_both_sides(context, images, masks, levels, chart, rails, between, &boards));
  if (boards) return RECEDE_OK; /* light and dark boards, or their ends in a row */
  if (crosses_a_lone_line(chart, direction, lines, *count)) return RECEDE_OK;
  *rails = (rc_rails){0};
  *sides = sought;
  for (int i = 0; i < *count; i++) {
    bool repeats = false;
    if (!rc_parallel_in_plane(direction, rc_crossing_direction(chart, &lines[i]))) continue;
    bool same = is_the_same(&line, apart_px, &lines[i]);
    if (!same && !lines[i].alone)
      RC_TRY(rc_repeats_beside(context, images, masks, levels, chart, &lines[i], between,
                               lines[i].ax, lines[i].ay, &repeats));
    if (!repeats) kept[kept_count++] = lines[i];
    again = again || same;
  }
  /* Where it was found among the others, too, its place is known better. */
  if (!again && kept_count == RC_MOST_LINES) kept_count--;
  int at = kept_count; /* strongest first */
  for (; !again && at > 0 && kept[at - 1].strength < line.strength; at--) kept[at] = kept[at - 1];
  if (!again) kept[at] = line, kept_count++;
  memcpy(lines, kept, (size_t)kept_count * sizeof *lines);
  *count = kept_count;
  return RECEDE_OK;
}
