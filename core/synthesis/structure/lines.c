#include "synthesis/structure/lines.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"
#include "synthesis/structure/alone.h"
#include "synthesis/structure/follow.h"

/* Lines are looked for at the finest level whose hole has at most so many border pixels. */
#define MOST_BORDER 800
/* How alike both sides' profiles must be: their correlation, and one's amplitude over the other's,
 * for lines fade. */
#define LEAST_LIKENESS .85f
#define MOST_UNLIKE 4.f
#define STRAIGHT .9945f /* cosine of 6 degrees: both runs and what connects them */
#define SHORTEST_PX 12.f
/* Runs beside the hole get narrower with the ground where w is so many times as much at one end of
 * it. Else that would only blur what is seen. */
#define LEAST_NARROWING 2.f
/* Of a marking wider than half a profile both edges are kept. */
#define LEAST_RISE .8f
#define LEAST_INSIDE .7f /* of a line between its ends */
/* Both ends' runs are looked at turned by so much, in so many steps to each side; where both lead
 * so far beside the other end and are so many times as clear, each belongs to another line: slats
 * taken for their neighbours are 2 to 50 times, a crack that winds 1.1. */
#define OWN_TURN_STEP .008f
#define OWN_TURNS 8
#define MISTAKEN_PX 2.5f
#define MISTAKEN_CLEARER 1.8f
/* Ends are moved by up to so much to where the line is clearest. */
#define REFINED_STEP_PX .5f
#define REFINED_PLACES 17 /* 4 px to each side */

static bool alike(const rc_run *a, const rc_run *b) {
  return rc_profiles_alike(&a->profile, &b->profile, LEAST_LIKENESS, MOST_UNLIKE);
}

/* Its correlation with a step. */
static float rise_of(const rc_profile *p) {
  float dot = 0, square = 1e-12f;
  for (int o = 0; o < RC_PROFILE; o++) {
    dot += o < RC_PROFILE_HALF ? -p->mean[o] : o > RC_PROFILE_HALF ? p->mean[o] : 0;
    square += p->mean[o] * p->mean[o];
  }
  return dot / sqrtf(square * (RC_PROFILE - 1));
}

float rc_part_in_the_hole(const rc_mask *flags, const rc_crossing *c) {
  int inside = 0, samples = 32;
  for (int i = 1; i < samples; i++) {
    float t = (float)i / (float)samples;
    int x = (int)floorf(c->ax + t * (c->bx - c->ax) + .5f);
    int y = (int)floorf(c->ay + t * (c->by - c->ay) + .5f);
    inside += rc_inside(flags->width, flags->height, x, y) && *rc_flag(flags, x, y) & RC_TARGET;
  }
  return (float)inside / (float)samples;
}

bool rc_lies_in_the_hole(const rc_mask *flags, const rc_crossing *c) {
  return rc_part_in_the_hole(flags, c) > LEAST_INSIDE;
}

/* Moves both ends across the line to where it is clearest on both sides. The direction changes with
 * that, so it is done twice. */
static void refine(const rc_ends *ends, float least_strength, rc_crossing *c) {
  rc_run a[REFINED_PLACES], b[REFINED_PLACES];
  for (int round = 0; round < 2; round++) {
    float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy), most = 0;
    float ux = dx / length, uy = dy / length;
    rc_crossing from = *c;
    c->strength = 0;
    for (int i = 0; i < REFINED_PLACES; i++) {
      float across = REFINED_STEP_PX * (float)(i - REFINED_PLACES / 2);
      a[i] =
          rc_run_measure(&ends->picture, from.ax - across * uy, from.ay + across * ux, ux, uy, -1);
      b[i] =
          rc_run_measure(&ends->picture, from.bx - across * uy, from.by + across * ux, ux, uy, 1);
    }
    for (int i = 0; i < REFINED_PLACES; i++)
      for (int k = 0; k < REFINED_PLACES; k++) {
        float strength = fminf(a[i].strength, b[k].strength);
        float clarity = fminf(a[i].clarity, b[k].clarity);
        if (strength < least_strength || clarity <= most || !alike(&a[i], &b[k])) continue;
        float p = REFINED_STEP_PX * (float)(i - REFINED_PLACES / 2);
        float q = REFINED_STEP_PX * (float)(k - REFINED_PLACES / 2);
        most = clarity;
        *c = (rc_crossing){.ax = from.ax - p * uy,
                           .ay = from.ay + p * ux,
                           .bx = from.bx - q * uy,
                           .by = from.by + q * ux,
                           .strength = strength,
                           .rise = rise_of(&a[i].profile)};
      }
    if (c->strength == 0) return;
  }
}

/* By how much a line's run is turned from it, a tangent, where it is clearest; times: as it is so
 * many times. */
static float own_turn(const rc_seen *seen, float x, float y, float ux, float uy, float outwards,
                      float *times) {
  float most = 0, turn = 0, straight = 0;
  for (int n = -OWN_TURNS; n <= OWN_TURNS; n++) {
    float by = OWN_TURN_STEP * (float)n, length = sqrtf(1 + by * by);
    float strength = rc_run_fine_strength(seen, x, y, (ux - by * uy) / length,
                                          (uy + by * ux) / length, outwards);
    if (strength > most) most = strength, turn = by;
    if (n == 0) straight = strength;
  }
  *times = fminf(most / fmaxf(straight, 1e-6f), *times);
  return turn;
}

/* Whether both runs lead past each other the same way: of narrow slats one was taken for the next.
 */
static bool is_mistaken(const rc_seen *seen, const rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy);
  float times = INFINITY;
  float a = own_turn(seen, c->ax, c->ay, dx / length, dy / length, -1, &times);
  float b = own_turn(seen, c->bx, c->by, dx / length, dy / length, 1, &times);
  float least = fminf(fabsf(a), fabsf(b));
  return a * b > 0 && least * length >= MISTAKEN_PX && times >= MISTAKEN_CLEARER;
}

/* A thin line seen by whole pixels seems to wobble, and where lines get narrower all do. */
static void look_closer(const rc_seen *seen, rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy);
  float ux = dx / length, uy = dy / length;
  if (!seen->narrows) return;
  c->strength = fmaxf(c->strength, fminf(rc_run_fine_strength(seen, c->ax, c->ay, ux, uy, -1),
                                         rc_run_fine_strength(seen, c->bx, c->by, ux, uy, 1)));
}

static bool run_into_one_another(const rc_crossing *p, const rc_crossing *q) {
  return rc_crossing_distance(p, q->ax, q->ay) <= RC_PROFILE ||
         rc_crossing_distance(p, q->bx, q->by) <= RC_PROFILE;
}

/* Both are clear, and one rises where the other falls. */
static bool rise_against_each_other(const rc_crossing *p, const rc_crossing *q) {
  if (fminf(p->strength, q->strength) < RC_CLEAR_STRENGTH) return false;
  float along = (p->bx - p->ax) * (q->bx - q->ax) + (p->by - p->ay) * (q->by - q->ay);
  float rises = along > 0 ? -q->rise : q->rise;
  return fminf(p->rise, rises) > LEAST_RISE || fmaxf(p->rise, rises) < -LEAST_RISE;
}

/* Strongest first; of lines that run into one another the stronger stays. */
static void keep(rc_crossing lines[RC_MOST_LINES], int *count, rc_crossing c) {
  int at = 0;
  for (int i = 0; i < *count; i++) {
    rc_crossing *old = &lines[i];
    if (!run_into_one_another(old, &c) || rise_against_each_other(old, &c)) continue;
    if (old->strength >= c.strength) return;
    memmove(old, old + 1, (size_t)(*count - i - 1) * sizeof *old);
    (*count)--, i--;
  }
  while (at < *count && lines[at].strength >= c.strength) at++;
  if (at == RC_MOST_LINES) return;
  int moved = (*count < RC_MOST_LINES ? *count : RC_MOST_LINES - 1) - at;
  memmove(&lines[at + 1], &lines[at], (size_t)moved * sizeof c);
  lines[at] = c;
  if (*count < RC_MOST_LINES) (*count)++;
}

void rc_lines_pair_up(const rc_ends *ends, float least_strength, rc_crossing lines[RC_MOST_LINES],
                      int *count) {
  int width = ends->picture.flags->width;
  for (int i = 0; i < ends->border_count; i++) {
    if (!rc_end_stands_out(ends, i, least_strength)) continue;
    for (int j = i + 1; j < ends->border_count; j++) {
      if (ends->best[j].strength < least_strength) continue;
      const float *u = ends->direction[ends->best_direction[i]],
                  *v = ends->direction[ends->best_direction[j]];
      rc_crossing c = {.ax = (float)(ends->border[i] % width),
                       .ay = (float)(ends->border[i] / width),
                       .bx = (float)(ends->border[j] % width),
                       .by = (float)(ends->border[j] / width)};
      float dx = c.ax - c.bx, dy = c.ay - c.by, length = sqrtf(dx * dx + dy * dy);
      if (length < SHORTEST_PX || dx * u[0] + dy * u[1] < STRAIGHT * length ||
          dx * v[0] + dy * v[1] > -STRAIGHT * length ||
          !rc_lies_in_the_hole(ends->picture.flags, &c) ||
          !rc_end_stands_out(ends, j, least_strength))
        continue;
      refine(ends, least_strength, &c);
      if (c.strength < least_strength || is_mistaken(&ends->picture, &c)) continue;
      c.as_strong = rc_ends_as_strong(ends, &c);
      look_closer(&ends->picture, &c);
      keep(lines, count, c);
    }
  }
}

/* Lines that are followed beside each other. */
typedef struct followed {
  const rc_seen *seen;
  const rc_chart *chart;
  bool by_itself; /* in as many windows as one must go on in that no other vouches for */
  const rc_crossing *from;
  rc_crossing to[RC_MOST_LINES];
  bool found[RC_MOST_LINES];
} followed;

static void follow_one(void *user, int i, int thread) {
  followed *f = user;
  rc_crossing *c = &f->to[i];
  (void)thread;
  *c = f->from[i];
  f->found[i] = rc_follow(f->seen, f->chart, f->by_itself ? rc_windows_of(c, false) : 0, c);
}

/* Whether one goes on by itself. */
static recede_status find_one(rc_context *context, followed *f, int count, bool *found) {
  const rc_crossing *first = f->from;
  f->by_itself = true;
  *found = false;
  for (int at = 0; at < count && !*found; at += context->threads) {
    int some = count - at < context->threads ? count - at : context->threads;
    f->from = first + at;
    RC_TRY(rc_parallel(context, some, follow_one, f));
    for (int i = 0; i < some; i++) *found = *found || f->found[i];
  }
  f->from = first, f->by_itself = false;
  return RECEDE_OK;
}

/* Keeps what can be continued, in px of the finest level. One must go on by itself, and vouches for
 * those parallel to it. */
static recede_status follow(rc_context *context, const rc_seen *seen, const rc_chart *chart,
                            int exponent, rc_crossing lines[RC_MOST_LINES], int *count) {
  followed f = {.seen = seen, .chart = chart, .from = lines};
  int kept = 0;
  bool found;
  RC_TRY(find_one(context, &f, *count, &found));
  if (found) RC_TRY(rc_parallel(context, *count, follow_one, &f));
  for (int i = 0; i < *count && found; i++) {
    rc_crossing *c = &f.to[i];
    if (!f.found[i]) continue;
    rc_crossing_tell_band(c, false);
    rc_crossing_forget_chance(c);
    lines[kept++] = rc_crossing_coarser(*c, -exponent);
  }
  *count = kept;
  return RECEDE_OK;
}

static bool same_ends(const rc_crossing *p, const rc_crossing *q) {
  return p->ax == q->ax && p->ay == q->ay && p->bx == q->bx && p->by == q->by;
}

/* Of the leading direction, or, where none of that goes on, of the next. */
static recede_status follow_parallel(rc_context *context, const rc_seen *seen,
                                     const rc_chart *chart, int exponent,
                                     rc_crossing lines[RC_MOST_LINES], int *count) {
  rc_crossing left[RC_MOST_LINES];
  int left_count = *count;
  memcpy(left, lines, (size_t)*count * sizeof *left);
  do {
    int others = 0;
    memcpy(lines, left, (size_t)left_count * sizeof *left);
    *count = left_count;
    rc_crossings_keep_parallel(chart, lines, count);
    if (!*count) break;
    for (int i = 0, kept = 0; i < left_count; i++)
      if (kept < *count && same_ends(&left[i], &lines[kept]))
        kept++;
      else
        left[others++] = left[i];
    left_count = others;
    RC_TRY(follow(context, seen, chart, exponent, lines, count));
  } while (!*count);
  return RECEDE_OK;
}

int rc_lines_level(const rc_mask *masks, int levels) {
  for (int exponent = 0; exponent < levels; exponent++) {
    int border_count = rc_border_length(&masks[exponent]);
    if (border_count <= MOST_BORDER) return border_count ? exponent : -1;
  }
  return -1;
}

recede_status rc_lines_at(rc_context *context, const rc_seen *seen, bool faint,
                          rc_crossing lines[RC_MOST_LINES], int *count) {
  rc_ends ends;
  rc_block *mark = rc_mark(context);
  *count = 0;
  RC_TRY(rc_ends_find(context, seen, &ends));
  rc_lines_pair_up(&ends, RC_LEAST_STRENGTH, lines, count);
  if (faint && !*count) rc_lines_pair_up(&ends, RC_LEAST_FAINT_STRENGTH, lines, count);
  rc_release(context, mark);
  return RECEDE_OK;
}

/* Where hardly anything is as strong, a line that others cross beside the hole: they are noise to
 * it, and make it faint or, where no other is found, hide it. */
static recede_status find_crossed(rc_context *context, rc_seen *seen,
                                  rc_crossing lines[RC_MOST_LINES], int *count) {
  int kept = 0;
  bool hidden = !*count;
  seen->without_crossings = true;
  if (hidden) RC_TRY(rc_lines_at(context, seen, false, lines, count));
  for (int i = 0; i < *count; i++) {
    rc_crossing *c = &lines[i];
    bool stands_out = c->as_strong <= RC_HARDLY_AS_STRONG;
    if (stands_out && !hidden) {
      float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy);
      rc_run a = rc_run_measure(seen, c->ax, c->ay, dx / length, dy / length, -1);
      rc_run b = rc_run_measure(seen, c->bx, c->by, dx / length, dy / length, 1);
      c->strength = fmaxf(c->strength, fminf(a.strength, b.strength));
    }
    if (stands_out || !hidden) lines[kept++] = *c;
  }
  *count = kept;
  rc_crossings_sort(lines, kept);
  seen->without_crossings = false;
  return RECEDE_OK;
}

bool rc_narrows_in(const rc_chart *chart, rc_box hole, float times) {
  float least = INFINITY, most = 0;
  for (int k = 0; k < 4; k++) {
    int x = k & 1 ? hole.x0 : hole.x1, y = k & 2 ? hole.y0 : hole.y1;
    float w = rc_chart_w(chart, (float)x, (float)y);
    least = fminf(least, w), most = fmaxf(most, w);
  }
  return most > times * least;
}

recede_status rc_lines_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                            int exponent, bool corners, const rc_chart *chart,
                            const rc_copy periods[2], rc_crossing lines[RC_MOST_LINES],
                            int *count) {
  const float *axis = rc_brightness_axis(image);
  rc_seen seen;
  rc_block *mark = rc_mark(context);
  rc_chart here = rc_chart_coarser(*chart, exponent);
  rc_box hole = rc_box_of(mask, RC_TARGET);
  int reach_px = rc_longer_side(hole);
  RC_TRY(rc_see(context, image, mask, axis, &seen));
  if (rc_narrows_in(&here, hole, LEAST_NARROWING)) seen.narrows = &here;
  RC_TRY(rc_lines_at(context, &seen, false, lines, count));
  RC_TRY(find_crossed(context, &seen, lines, count));
  if (corners) rc_crossings_keep_corners(mask, lines, count);
  rc_copy here_by[2];
  for (int k = 0; periods && k < 2; k++)
    here_by[k] =
        (rc_copy){periods[k].a / (float)(1 << exponent), periods[k].b / (float)(1 << exponent), 0};
  for (int i = 0; i < *count; i++)
    lines[i].alone = rc_stands_alone(&seen, &here, &lines[i], reach_px, periods ? here_by : NULL);
  RC_TRY(follow_parallel(context, &seen, &here, exponent, lines, count));
  if (*count == 1 && lines->as_strong > RC_MOST_AS_STRONG) *count = 0;
  for (int i = 0; i < *count; i++) memcpy(lines[i].axis, axis, sizeof lines[i].axis);
  rc_release(context, mark);
  return rc_poll(context);
}
