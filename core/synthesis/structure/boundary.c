#include "synthesis/structure/boundary.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/structure/follow.h"
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
#define POWER_STEPS 30

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

/* Beside the run that leaves (x, y) along u; side -1 or 1 of u. */
static strip look(const coarsest *c, float x, float y, float ux, float uy, float side) {
  const rc_image *image = c->image;
  strip s = {{0, 0, 0}, 0};
  for (int along = 1; along <= STRIP_LENGTH_PX; along++)
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

/* The product of both ends' steps; 0: too little is known there. */
static float step_across(const coarsest *in, const rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy), sum = 0;
  float ux = dx / length, uy = dy / length;
  strip a = look(in, c->ax, c->ay, -ux, -uy, -1);
  strip b = look(in, c->ax, c->ay, -ux, -uy, 1);
  strip p = look(in, c->bx, c->by, ux, uy, 1);
  strip q = look(in, c->bx, c->by, ux, uy, -1);
  if (a.seen < LEAST_SEEN || b.seen < LEAST_SEEN || p.seen < LEAST_SEEN || q.seen < LEAST_SEEN)
    return 0;
  for (int k = 0; k < in->image->channels; k++)
    sum += (a.mean[k] - b.mean[k]) * (p.mean[k] - q.mean[k]);
  return sum;
}

/* The sources' covariance of colours; grey has one. */
static void covariance_of(const rc_image *image, const rc_mask *flags, double covariance[3][3]) {
  double mean[3] = {0, 0, 0}, count = 0;
  memset(covariance, 0, 9 * sizeof(double));
  for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++) {
    const float *v = image->data + i * (size_t)image->channels;
    if (!(flags->data[i] & RC_SOURCE)) continue;
    for (int k = 0; k < image->channels; k++) {
      mean[k] += v[k];
      for (int j = 0; j < image->channels; j++) covariance[k][j] += (double)v[k] * v[j];
    }
    count++;
  }
  for (int k = 0; k < 3 && count > 0; k++)
    for (int j = 0; j < 3; j++)
      covariance[k][j] = (covariance[k][j] - mean[k] * mean[j] / count) / count;
}

/* What colours differ by most, by the power method: grass and brick may be equally bright. */
static void principal_axis(double covariance[3][3], float axis[3]) {
  double v[3] = {.3, .59, .11};
  for (int step = 0; step < POWER_STEPS; step++) {
    double next[3] = {0, 0, 0}, square = 0;
    for (int k = 0; k < 3; k++) {
      for (int j = 0; j < 3; j++) next[k] += covariance[k][j] * v[j];
      square += next[k] * next[k];
    }
    for (int k = 0; k < 3 && square > 0; k++) v[k] = next[k] / sqrt(square);
  }
  for (int k = 0; k < 3; k++) axis[k] = (float)v[k];
}

/* The line with the greatest step among those that go on by themselves; false: there is none. */
static bool choose(const coarsest *in, int coarser, const rc_seen *seen, const rc_chart *chart,
                   float least, const rc_crossing *lines, int count, rc_crossing *best) {
  bool found = false;
  for (int i = 0; i < count; i++) {
    rc_crossing c = lines[i], there = rc_crossing_coarser(c, coarser);
    float step = step_across(in, &there);
    if (step < least || !rc_follow(seen, chart, true, &c)) continue;
    *best = c, least = step, found = true;
  }
  return found;
}

static rc_boundary boundary_of(const rc_chart *chart, const rc_crossing *c) {
  float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy);
  float nx = -dy / length, ny = dx / length;
  return (rc_boundary){nx, ny, nx * (chart->x0 - c->ax) + ny * (chart->y0 - c->ay)};
}

/* before: lines that were found. Searches the levels for the line between two textures, px of the
 * finest level; *apart_px: no other is nearer. False: there is none. */
static recede_status search(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, int from, const rc_chart *chart, const rc_crossing *before,
                            int before_count, rc_crossing *line, float *apart_px, bool *found) {
  int last = levels - 1, count;
  coarsest in = {&images[last], &masks[last], rc_chart_coarser(*chart, last), .marking_count = 0};
  double covariance[3][3];
  rc_crossing lines[RC_MOST_LINES], best;
  *found = false;
  for (int i = 0; i < before_count; i++)
    if (rc_crossing_is_sure(&before[i]))
      in.markings[in.marking_count++] = rc_crossing_coarser(before[i], last);
  covariance_of(&images[last], &masks[last], covariance);
  float least = LEAST_STEP * (float)(covariance[0][0] + covariance[1][1] + covariance[2][2]);
  for (int exponent = from + LEAST_COARSER;
       exponent <= from + MOST_COARSER && exponent < levels && !*found; exponent++) {
    rc_seen seen;
    rc_chart here = rc_chart_coarser(*chart, exponent);
    if (rc_border_length(&masks[exponent]) < LEAST_BORDER) return RECEDE_OK;
    rc_block *mark = rc_mark(context);
    covariance_of(&images[exponent], &masks[exponent], covariance);
    principal_axis(covariance, line->axis);
    RC_TRY(rc_see(context, &images[exponent], &masks[exponent], line->axis, &seen));
    RC_TRY(rc_lines_at(context, &seen, lines, &count));
    *found = choose(&in, last - exponent, &seen, &here, least, lines, count, &best);
    rc_release(context, mark);
    if (!*found) continue;
    memcpy(best.axis, line->axis, sizeof best.axis);
    *line = rc_crossing_coarser(best, -exponent);
    *apart_px = (float)(RC_PROFILE << exponent);
  }
  return RECEDE_OK;
}

recede_status rc_boundary_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                               int levels, int from, const rc_chart *chart,
                               rc_crossing lines[RC_MOST_LINES], int *count, rc_rails *rails,
                               rc_boundary *boundary) {
  rc_crossing line, kept[RC_MOST_LINES];
  float apart_px;
  bool found, again = false, boards;
  int kept_count = 0;
  *boundary = (rc_boundary){0, 0, 0};
  RC_TRY(
      search(context, images, masks, levels, from, chart, lines, *count, &line, &apart_px, &found));
  rc_copy direction = found ? rc_crossing_direction(chart, &line) : (rc_copy){0, 0, 0};
  if (!found || rc_parallel_in_plane(direction, (rc_copy){rails->a, rails->b, 0})) return RECEDE_OK;
  rc_boundary between = boundary_of(chart, &line);
  RC_TRY(rc_runs_on_both_sides(context, images, masks, levels, chart, rails, &between, &boards));
  if (boards) return RECEDE_OK; /* light and dark boards' ends in a row */
  *rails = (rc_rails){0};
  *boundary = between;
  for (int i = 0; i < *count; i++) {
    bool repeats = false;
    if (!rc_parallel_in_plane(direction, rc_crossing_direction(chart, &lines[i]))) continue;
    bool same = rc_crossing_distance(&line, lines[i].ax, lines[i].ay) < apart_px &&
                rc_crossing_distance(&line, lines[i].bx, lines[i].by) < apart_px;
    if (!same && !lines[i].alone)
      RC_TRY(rc_repeats_beside(context, images, masks, levels, chart, &lines[i], boundary,
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
