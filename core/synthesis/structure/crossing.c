#include "synthesis/structure/crossing.h"

#include <math.h>

#include "base/real.h"
#include "kernels/kernels.h"

/* Signal to noise of one that the others may be parallel to. */
#define LEAST_LEADING_STRENGTH 12.f
#define PARALLEL .9976f /* cosine of 4 degrees, in the plane */
#define SURE_KEPT .9f   /* at such a strength */
/* Beside setts even a kerb is no stronger than they are. It is no chance if, of the hole's border,
 * so much is as strong, this part of its contrast is kept, and no patch holds it across: kerbs
 * reach 10 px, cracks in a road, whose texture moves in with nothing, 4. Seen coarser, where setts
 * are small, hardly anything is as strong, more is kept, and no crack is seen: of 280 fills, most
 * of them of photos, by its colour one other thing is like that, a path's edge. */
#define BAND_AS_STRONG .05f
#define BAND_KEPT .7f
#define COARSE_BAND_AS_STRONG .02f
#define COARSE_BAND_KEPT .85f
#define MOST_OF_CORNER .1f /* of the hole */

float rc_crossing_length(const rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay;
  return sqrtf(dx * dx + dy * dy);
}

/* How far from the line through both of its ends, times its length; negative to the right. */
static float side(const rc_crossing *line, float x, float y) {
  return (x - line->ax) * (line->by - line->ay) - (y - line->ay) * (line->bx - line->ax);
}

float rc_crossing_distance(const rc_crossing *line, float x, float y) {
  return fabsf(side(line, x, y)) / rc_crossing_length(line);
}

bool rc_crossing_is_right(const rc_crossing *line, float x, float y) {
  return side(line, x, y) < 0;
}

bool rc_crossing_is_sure(const rc_crossing *line) {
  return line->band || (line->strength >= RC_SURE_STRENGTH && line->kept >= SURE_KEPT);
}

void rc_crossing_tell_band(rc_crossing *line, bool seen_coarser) {
  float reach_px = line->reach_px[0] + line->reach_px[1];
  if (seen_coarser)
    line->band =
        line->as_strong <= COARSE_BAND_AS_STRONG && line->kept >= COARSE_BAND_KEPT && reach_px > 0;
  else
    line->band = line->alone && line->as_strong <= BAND_AS_STRONG && line->kept >= BAND_KEPT &&
                 reach_px > 2 * RC_PATCH_RADIUS + 1;
}

void rc_crossing_forget_chance(rc_crossing *line) {
  if (!rc_crossing_is_sure(line)) line->reach_px[0] = line->reach_px[1] = 0;
}

bool rc_crossing_is_lone(const rc_crossing *line) {
  return line->alone && rc_crossing_is_sure(line);
}

bool rc_crossing_is_marking(const rc_crossing *line) {
  return rc_crossing_is_lone(line) && line->strength >= RC_CLEAR_STRENGTH;
}

/* How many times as narrow it is at a as at b. */
static float narrowing(const rc_chart *chart, const rc_crossing *line) {
  if (!line->recedes) return 1;
  return rc_chart_w(chart, line->ax, line->ay) / rc_chart_w(chart, line->bx, line->by);
}

float rc_crossing_part(const rc_chart *chart, const rc_crossing *line, float n) {
  float times = narrowing(chart, line), in_plane = n / (float)line->pieces;
  return in_plane * times / (1 - in_plane * (1 - times));
}

int rc_crossing_piece(const rc_chart *chart, const rc_crossing *line, float part) {
  float times = narrowing(chart, line), inside = fminf(fmaxf(part, 0), .999f);
  int piece = (int)(inside / (times + inside * (1 - times)) * (float)line->pieces);
  return piece < line->pieces ? piece : line->pieces - 1;
}

static bool is_no_faint_one(const rc_crossing *line) { return !line->faint; }

static void keep(bool (*which)(const rc_crossing *), rc_crossing lines[RC_MOST_LINES], int *count) {
  int kept = 0;
  for (int i = 0; i < *count; i++)
    if (which(&lines[i])) lines[kept++] = lines[i];
  *count = kept;
}

void rc_crossings_sort(rc_crossing *lines, int count) {
  for (int i = 1; i < count; i++)
    for (int k = i; k > 0 && lines[k].strength > lines[k - 1].strength; k--) {
      rc_crossing weaker = lines[k - 1];
      lines[k - 1] = lines[k], lines[k] = weaker;
    }
}

/* As the other edge of what is lone may. */
static bool may_go_with_a_lone_one(const rc_crossing *line) {
  return rc_crossing_is_lone(line) || (line->alone && line->strength >= LEAST_LEADING_STRENGTH);
}

bool rc_crossings_have_lone(const rc_crossing *lines, int count) {
  for (int i = 0; i < count; i++)
    if (rc_crossing_is_lone(&lines[i])) return true;
  return false;
}

void rc_crossings_keep_lone(rc_crossing lines[RC_MOST_LINES], int *count) {
  bool any = rc_crossings_have_lone(lines, *count);
  keep(any ? may_go_with_a_lone_one : rc_crossing_is_lone, lines, count);
}

void rc_crossings_keep_sure(rc_crossing lines[RC_MOST_LINES], int *count) {
  keep(rc_crossing_is_sure, lines, count);
  rc_crossings_sort(lines, *count);
}

void rc_crossings_drop_faint(rc_crossing *lines, int *count) {
  keep(is_no_faint_one, lines, count);
}

rc_crossing rc_crossing_coarser(rc_crossing line, int exponent) {
  float unit = rc_exp2((float)exponent), *ends[] = {&line.ax, &line.ay, &line.bx, &line.by};
  for (int k = 0; k < 4; k++) *ends[k] = (*ends[k] + .5f) / unit - .5f;
  for (int k = 0; k < 2; k++) line.reach_px[k] /= unit;
  for (int k = 0; k < line.pieces; k++) {
    line.from_x[k] = (line.from_x[k] + .5f) / unit - .5f;
    line.from_y[k] = (line.from_y[k] + .5f) / unit - .5f;
  }
  return line;
}

rc_copy rc_crossing_direction(const rc_chart *chart, const rc_crossing *c) {
  rc_chart flat = rc_chart_flat(*chart);
  rc_copy d =
      rc_copy_between(&flat, c->ax - flat.x0, c->ay - flat.y0, c->bx - flat.x0, c->by - flat.y0);
  float length = sqrtf(d.a * d.a + d.b * d.b);
  return (rc_copy){d.a / length, d.b / length, 0.f};
}

bool rc_parallel_in_plane(rc_copy p, rc_copy q) { return fabsf(p.a * q.a + p.b * q.b) > PARALLEL; }

/* As rails do across their sleepers. */
static bool stands_out(const rc_crossing *line) {
  return line->alone && line->strength >= RC_CLEAR_STRENGTH;
}

void rc_crossings_keep_parallel(const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                                int *count) {
  rc_copy directions[RC_MOST_LINES];
  float most = 0;
  int leading = -1, kept = 0;
  bool any_stands_out = false;
  for (int i = 0; i < *count; i++) directions[i] = rc_crossing_direction(chart, &lines[i]);
  for (int i = 0; i < *count && lines[i].strength >= LEAST_LEADING_STRENGTH; i++) {
    bool one_stands_out = false;
    float sum = 0;
    for (int k = 0; k < *count; k++) {
      if (!rc_parallel_in_plane(directions[i], directions[k])) continue;
      sum += rc_crossing_length(&lines[k]) * sqrtf(fminf(lines[k].strength, RC_CLEAR_STRENGTH));
      one_stands_out = one_stands_out || stands_out(&lines[k]);
    }
    if (one_stands_out == any_stands_out ? sum <= most : any_stands_out) continue;
    most = sum, leading = i, any_stands_out = one_stands_out;
  }
  for (int i = 0; i < *count && leading >= 0; i++)
    if (rc_parallel_in_plane(directions[i], directions[leading])) lines[kept++] = lines[i];
  *count = kept;
}

void rc_crossings_keep_corners(const rc_mask *flags, rc_crossing lines[RC_MOST_LINES], int *count) {
  rc_box box = rc_box_of(flags, RC_TARGET);
  int kept = 0;
  for (int i = 0; i < *count; i++) {
    const rc_crossing *c = &lines[i];
    int pixels = 0, left = 0;
    for (int y = box.y0; y < box.y1; y++)
      for (int x = box.x0; x < box.x1; x++) {
        if (!(*rc_flag(flags, x, y) & RC_TARGET)) continue;
        pixels++;
        left += side(c, (float)x, (float)y) > 0;
      }
    int lesser = left < pixels - left ? left : pixels - left;
    if ((float)lesser < MOST_OF_CORNER * (float)pixels) lines[kept++] = *c;
  }
  *count = kept;
}
