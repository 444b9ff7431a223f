#include "synthesis/structure/branches.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "synthesis/structure/alone.h"
#include "synthesis/structure/ends.h"
#include "synthesis/structure/follow.h"

/* Shorter ones a patch carries on. */
#define SHORTEST_PX 8.f
/* Two meet at such an angle: sine. */
#define LEAST_SINE .4f
/* A direction is looked for so much to each side of the best of all, in so many steps. */
#define TURN_STEP .008f
#define TURNS 4
/* And across, px. */
#define ACROSS_STEP_PX .5f
#define ACROSS 4
/* Where the hole reaches to where the ground is so much narrower than at a line's end, little would
 * be seen of it behind, and often something stands there. */
#define FAR_AWAY_TIMES 5.5f
/* So many ends, the strongest, are looked at. */
#define MOST_ENDS 16

/* A line at the border that nothing continues yet. */
typedef struct loose {
  float x, y, out[2], strength, as_strong;
} loose;

typedef struct work {
  const rc_seen *seen;
  const rc_chart *chart; /* of the level */
  int reach_px;          /* of what is looked at beside a line */
  rc_crossing *lines;    /* px of the level */
  int line_count;
  loose ends[MOST_ENDS];
  int end_count;
} work;

static void turn_by(float by, const float from[2], float to[2]) {
  float x = from[0] - by * from[1], y = from[1] + by * from[0], length = sqrtf(x * x + y * y);
  to[0] = x / length, to[1] = y / length;
}

/* The place and direction near those of a border pixel where the line is clearest. */
static loose refine(const rc_ends *ends, int item) {
  int width = ends->picture.flags->width;
  float x = (float)(ends->border[item] % width), y = (float)(ends->border[item] / width), most = 0;
  const float *best = ends->direction[ends->best_direction[item]];
  loose found = {.strength = 0};
  for (int turn = -TURNS; turn <= TURNS; turn++)
    for (int step = -ACROSS; step <= ACROSS; step++) {
      float u[2], across = ACROSS_STEP_PX * (float)step;
      turn_by(TURN_STEP * (float)turn, best, u);
      float px = x - across * u[1], py = y + across * u[0];
      rc_run run = rc_run_measure(&ends->picture, px, py, u[0], u[1], 1);
      if (run.strength < RC_SURE_STRENGTH || run.clarity <= most) continue;
      most = run.clarity;
      found = (loose){px, py, {u[0], u[1]}, run.strength, 0};
    }
  return found;
}

static bool is_at_end_of(const rc_crossing *line, float x, float y) {
  float to_a = line->ends_inside ? INFINITY : fmaxf(fabsf(line->ax - x), fabsf(line->ay - y));
  return fminf(to_a, fmaxf(fabsf(line->bx - x), fabsf(line->by - y))) <= RC_PROFILE;
}

static bool is_continued(const work *w, const loose *end) {
  for (int i = 0; i < w->line_count; i++)
    if (is_at_end_of(&w->lines[i], end->x, end->y) ||
        (!w->lines[i].ends_inside &&
         rc_crossing_distance(&w->lines[i], end->x, end->y) <= RC_PROFILE))
      return true;
  return false;
}

/* Whether it is part of a broad line that leaves, too. */
static bool lies_in_another(const work *w, const loose *end) {
  for (int i = 0; i < w->line_count; i++) {
    const rc_crossing *c = &w->lines[i];
    float reach_px = c->reach_px[rc_crossing_is_right(c, end->x, end->y)];
    if (c->leaves && rc_crossing_distance(c, end->x, end->y) <=
                         RC_PROFILE_HALF + reach_px * rc_chart_w(w->chart, end->x, end->y))
      return true;
  }
  return false;
}

/* Strongest first; of those beside one another, as of a line's two edges, the stronger stays. */
static void keep(work *w, loose end) {
  int at = 0;
  for (int i = 0; i < w->end_count; i++) {
    loose *old = &w->ends[i];
    if (fmaxf(fabsf(old->x - end.x), fabsf(old->y - end.y)) > RC_PROFILE) continue;
    if (old->strength >= end.strength) return;
    memmove(old, old + 1, (size_t)(w->end_count - i - 1) * sizeof end);
    w->end_count--, i--;
  }
  while (at < w->end_count && w->ends[at].strength >= end.strength) at++;
  if (at == MOST_ENDS) return;
  int moved = (w->end_count < MOST_ENDS ? w->end_count : MOST_ENDS - 1) - at;
  memmove(&w->ends[at + 1], &w->ends[at], (size_t)moved * sizeof end);
  w->ends[at] = end;
  if (w->end_count < MOST_ENDS) w->end_count++;
}

static void collect(const rc_ends *ends, work *w) {
  for (int i = 0; i < ends->border_count; i++) {
    if (!rc_end_stands_out(ends, i, RC_SURE_STRENGTH)) continue;
    loose end = refine(ends, i);
    rc_crossing line = {end.x, end.y, end.x + end.out[0], end.y + end.out[1],
                        .strength = end.strength};
    if (!(end.strength > 0) || is_continued(w, &end) || lies_in_another(w, &end)) continue;
    end.as_strong = rc_ends_as_strong(ends, &line);
    if (end.as_strong <= RC_MOST_AS_STRONG) keep(w, end);
  }
}

/* How far inwards an end meets the line through (x, y) along u; infinite: not, or at a flat angle.
 * at: where on that line. */
static float way_to(const loose *end, float x, float y, const float u[2], float *at) {
  float sine = u[0] * end->out[1] - u[1] * end->out[0];
  if (fabsf(sine) < LEAST_SINE) return INFINITY;
  float ox = end->x - x, oy = end->y - y, way = (u[0] * oy - u[1] * ox) / sine;
  *at = (ox - way * end->out[0]) * u[0] + (oy - way * end->out[1]) * u[1];
  return way > 0 ? way : INFINITY;
}

/* To the first line that it meets between its ends. */
static float way_to_lines(const work *w, const loose *end) {
  float first = INFINITY, at = 0;
  for (int i = 0; i < w->line_count; i++) {
    const rc_crossing *c = &w->lines[i];
    float length = rc_crossing_length(c);
    float u[2] = {(c->bx - c->ax) / length, (c->by - c->ay) / length};
    float way = way_to(end, c->ax, c->ay, u, &at);
    if (way < first && at >= 0 && at <= length) first = way;
  }
  return first;
}

static bool is_target(const rc_mask *flags, float x, float y) {
  int column = rc_floor(x + .5f), row = rc_floor(y + .5f);
  return rc_inside(flags->width, flags->height, column, row) &&
         *rc_flag(flags, column, row) & RC_TARGET;
}

/* Takes a line in that ends inside, so far from its end, if it can be followed and is no chance. */
static bool try_branch(const work *w, const loose *end, float way, rc_crossing *branch) {
  *branch = (rc_crossing){.ax = end->x - way * end->out[0],
                          .ay = end->y - way * end->out[1],
                          .bx = end->x,
                          .by = end->y,
                          .strength = end->strength,
                          .as_strong = end->as_strong,
                          .ends_inside = true};
  return way >= SHORTEST_PX && is_target(w->seen->flags, branch->ax, branch->ay) &&
         rc_lies_in_the_hole(w->seen->flags, branch) &&
         rc_follow_branch(w->seen, w->chart, rc_windows_of(branch, false), branch) &&
         rc_crossing_is_sure(branch) && rc_end_stands_alone(w->seen, w->chart, branch, w->reach_px);
}

static void drop_end(work *w, int i) {
  memmove(&w->ends[i], &w->ends[i + 1], (size_t)(w->end_count - i - 1) * sizeof *w->ends);
  w->end_count--;
}

/* The loose end that has the shortest way to a line goes on to it. False: none has. */
static bool end_at_line(work *w) {
  float least = INFINITY;
  int which = -1;
  for (int i = 0; i < w->end_count; i++) {
    float way = way_to_lines(w, &w->ends[i]);
    if (way < least) least = way, which = i;
  }
  if (which < 0) return false;
  loose end = w->ends[which];
  drop_end(w, which);
  if (try_branch(w, &end, least, &w->lines[w->line_count])) w->line_count++;
  return true;
}

/* Of two that meet each other those go on that have the shortest way together. */
static bool end_at_each_other(work *w) {
  float least = INFINITY, ways[2] = {0, 0}, at = 0;
  int p = -1, q = -1;
  for (int i = 0; i < w->end_count; i++)
    for (int j = 0; j < i; j++) {
      const loose *a = &w->ends[i], *b = &w->ends[j];
      float way = way_to(a, b->x, b->y, b->out, &at);
      if (!(way + fabsf(at) < least) || at >= 0) continue;
      least = way - at, p = i, q = j, ways[0] = way, ways[1] = -at;
    }
  if (p < 0) return false;
  loose a = w->ends[p], b = w->ends[q];
  rc_crossing *made = &w->lines[w->line_count];
  drop_end(w, p); /* the later one */
  if (!try_branch(w, &a, ways[0], &made[0])) return true;
  drop_end(w, q);
  if (try_branch(w, &b, ways[1], &made[1])) w->line_count += 2;
  return true;
}

/* Those that cross the hole in other directions. */
static recede_status add_crossing(rc_context *context, const rc_crossing *all, int count, work *w) {
  for (int i = 0; i < count && w->line_count < RC_ALL_LINES; i++) {
    RC_TRY(rc_poll(context));
    rc_crossing c = all[i];
    loose a = {c.ax, c.ay, {0, 0}, 0, 0}, b = {c.bx, c.by, {0, 0}, 0, 0};
    bool clear = c.strength >= RC_CLEAR_STRENGTH && c.as_strong <= RC_HARDLY_AS_STRONG;
    int far_px = clear ? w->reach_px / 2 : w->reach_px; /* the picture may end there */
    if (is_continued(w, &a) || is_continued(w, &b) || c.as_strong > RC_MOST_AS_STRONG ||
        !rc_stands_alone(w->seen, w->chart, &c, far_px, NULL) ||
        !rc_follow(w->seen, w->chart, rc_windows_of(&c, false), &c) || !rc_crossing_is_sure(&c))
      continue;
    w->lines[w->line_count++] = c; /* not alone: rows of a chess board are no rails */
  }
  return RECEDE_OK;
}

static work work_at(const rc_seen *seen, const rc_chart *here, int exponent, rc_crossing *lines,
                    int count) {
  work w = {.seen = seen, .chart = here, .lines = lines, .line_count = count};
  w.reach_px = rc_longer_side(rc_box_of(seen->flags, RC_TARGET));
  for (int i = 0; i < count; i++) lines[i] = rc_crossing_coarser(lines[i], exponent);
  return w;
}

/* The lines are in px of the finest level again, those from before on seen by brightness. */
static void give_back(const work *w, int exponent, int before, const float *axis, int *count) {
  *count = w->line_count;
  for (int i = 0; i < *count; i++) {
    w->lines[i] = rc_crossing_coarser(w->lines[i], -exponent);
    if (i >= before) memcpy(w->lines[i].axis, axis, sizeof w->lines[i].axis);
  }
}

recede_status rc_branches_add(rc_context *context, const rc_image *image, const rc_mask *mask,
                              int exponent, const rc_chart *chart, rc_crossing lines[RC_ALL_LINES],
                              int *count) {
  rc_chart here = rc_chart_coarser(*chart, exponent);
  rc_crossing all[RC_MOST_LINES];
  rc_seen seen;
  rc_ends ends;
  int all_count = 0, before = *count;
  const float *axis = rc_brightness_axis(image);
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_see(context, image, mask, axis, &seen));
  RC_TRY(rc_ends_find(context, &seen, &ends));
  work w = work_at(&seen, &here, exponent, lines, *count);
  rc_lines_pair_up(&ends, RC_SURE_STRENGTH, all, &all_count);
  RC_TRY(add_crossing(context, all, all_count, &w));
  collect(&ends, &w);
  while (w.line_count + 2 <= RC_ALL_LINES && (end_at_line(&w) || end_at_each_other(&w)))
    RC_TRY(rc_poll(context));
  give_back(&w, exponent, before, axis, count);
  rc_release(context, mark);
  return rc_poll(context);
}

/* How far inwards an end leaves the hole where the picture ends, or nearly so, or gets too far away
 * in it; else infinite. */
static float way_out(const work *w, const loose *end, bool *recedes) {
  const rc_mask *flags = w->seen->flags;
  float far_away = rc_chart_w(w->chart, end->x, end->y) / FAR_AWAY_TIMES;
  int last = 0;
  *recedes = false;
  for (int way = 1;; way++) {
    float x = end->x - (float)way * end->out[0], y = end->y - (float)way * end->out[1];
    if (!rc_inside(flags->width, flags->height, rc_floor(x + .5f), rc_floor(y + .5f)))
      return last ? (float)last : INFINITY;
    if (is_target(flags, x, y)) {
      *recedes = rc_chart_w(w->chart, x, y) <= far_away;
      if (*recedes) return last ? (float)last : INFINITY;
      last = way;
    } else if (way - last > RC_STRIP_PX) {
      return INFINITY;
    }
  }
}

static bool is_known(const rc_mask *flags, float x, float y) {
  int px = rc_floor(x + .5f), py = rc_floor(y + .5f);
  return rc_inside(flags->width, flags->height, px, py) && *rc_flag(flags, px, py) & RC_KNOWN;
}

/* Whether beside most of the line there is something known, no farther than profiles reach: it
 * would be seen there. A joint of boards that the hole cut by a pixel or two was led on into water.
 */
static bool lies_along_the_border(const rc_mask *flags, const rc_crossing *c) {
  float length = rc_crossing_length(c);
  float across_x = RC_PROFILE * (c->ay - c->by) / length;
  float across_y = RC_PROFILE * (c->bx - c->ax) / length;
  int beside = 0, samples = 32;
  for (int i = 1; i < samples; i++) {
    float t = (float)i / (float)samples;
    float x = c->ax + t * (c->bx - c->ax), y = c->ay + t * (c->by - c->ay);
    beside +=
        is_known(flags, x + across_x, y + across_y) || is_known(flags, x - across_x, y - across_y);
  }
  return 2 * beside > samples;
}

static bool is_near_the_end(const rc_mask *mask, rc_box hole) {
  return hole.x0 <= RC_STRIP_PX || hole.y0 <= RC_STRIP_PX || hole.x1 + RC_STRIP_PX >= mask->width ||
         hole.y1 + RC_STRIP_PX >= mask->height;
}

recede_status rc_leaving_add(rc_context *context, const rc_image *image, const rc_mask *mask,
                             int exponent, const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                             int *count) {
  rc_chart here = rc_chart_coarser(*chart, exponent);
  rc_seen seen;
  rc_ends ends;
  int before = *count;
  rc_box hole = rc_box_of(mask, RC_TARGET);
  if (!(is_near_the_end(mask, hole) || rc_narrows_in(&here, hole, FAR_AWAY_TIMES)) ||
      *count == RC_MOST_LINES)
    return RECEDE_OK;
  const float *axis = rc_brightness_axis(image);
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_see(context, image, mask, axis, &seen));
  RC_TRY(rc_ends_find(context, &seen, &ends));
  work w = work_at(&seen, &here, exponent, lines, *count);
  collect(&ends, &w);
  for (int i = 0; i < w.end_count && w.line_count < RC_MOST_LINES; i++) {
    const loose *end = &w.ends[i];
    bool recedes;
    float way = way_out(&w, end, &recedes);
    RC_TRY(rc_poll(context));
    if (!(end->strength >= RC_CLEAR_STRENGTH && end->as_strong <= RC_HARDLY_AS_STRONG &&
          way >= SHORTEST_PX && way < INFINITY) ||
        lies_in_another(&w, end))
      continue;
    rc_crossing c = {.ax = end->x - way * end->out[0],
                     .ay = end->y - way * end->out[1],
                     .bx = end->x,
                     .by = end->y,
                     .strength = end->strength,
                     .as_strong = end->as_strong,
                     .ends_inside = true,
                     .leaves = true,
                     .recedes = recedes};
    /* Beside it, too, the picture ends: half as far is looked. */
    c.alone =
        rc_chart_w(&here, c.ax, c.ay) > 0 && rc_end_stands_alone(&seen, &here, &c, w.reach_px / 2);
    if (c.alone && !lies_along_the_border(mask, &c) &&
        rc_follow(&seen, &here, rc_windows_of(&c, false), &c) && rc_crossing_is_lone(&c) &&
        rc_chart_w(&here, c.ax, c.ay) > 0)
      lines[w.line_count++] = c;
  }
  give_back(&w, exponent, before, axis, count);
  rc_release(context, mark);
  return rc_poll(context);
}
