/* Pairs of segments, drawn at random, propose where their lines meet; the proposal to which the
 * most length points wins, is refined to the least-squares one of its supporters, and these leave.
 * The next is judged by those that are left: a pier has hundreds of joints and two rails. */
#include "plane/vanishing.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "plane/segments.h"

#define PROPOSALS 1500
/* A segment points to a place when it is off by less than this: sine of 2 degrees. */
#define POINTS_TO .035
#define LEAST_SUPPORTERS 6
/* As many supporters as chance gives less often than in one picture of ten, were directions random:
 * so large a part of them is within 2 degrees of any. */
#define POINTS_BY_CHANCE .022
#define MOST_BY_CHANCE .1
/* With a point's supporters leave those that are off by less than 6 degrees: what is left of one
 * family of lines would make up a second point beside the first. */
#define LEAVES .105
/* Nearness, as for the cells of the spectra (estimate.c). */
#define REACH .15
#define FAR_WEIGHT .1
#define REFINEMENTS 3

typedef struct line {
  double x, y, dx, dy; /* from the centre in focal lengths */
  double normal[3];    /* of the plane through the camera and the line */
  double weight;
} line;

static void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static bool normalise(double v[3]) {
  double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (length < 1e-9) return false;
  for (int i = 0; i < 3; i++) v[i] /= length;
  return true;
}

/* Sine of the angle in the picture between the segment and the direction from its middle to v. */
static double off(const line *l, const double v[3]) {
  double tx = v[0] - v[2] * l->x, ty = v[1] - v[2] * l->y;
  double length = sqrt(tx * tx + ty * ty);
  return length > 1e-9 ? fabs(tx * l->dy - ty * l->dx) / length : 0;
}

static double support_of(const line *lines, int count, const double v[3], int *supporters) {
  double sum = 0;
  *supporters = 0;
  for (int i = 0; i < count; i++) {
    double miss = off(&lines[i], v) / POINTS_TO;
    if (miss >= 1) continue;
    sum += lines[i].weight * (1 - miss * miss);
    ++*supporters;
  }
  return sum;
}

/* The direction most nearly in all supporters' planes: power iterations on trace - matrix. */
static void refine(const line *lines, int count, double v[3]) {
  double m[3][3] = {{0}}, trace = 0;
  for (int i = 0; i < count; i++) {
    double miss = off(&lines[i], v) / POINTS_TO;
    if (miss >= 1) continue;
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        m[a][b] += lines[i].weight * lines[i].normal[a] * lines[i].normal[b];
  }
  for (int a = 0; a < 3; a++) trace += m[a][a];
  for (int step = 0; step < 200; step++) {
    double next[3];
    for (int a = 0; a < 3; a++)
      next[a] = trace * v[a] - m[a][0] * v[0] - m[a][1] * v[1] - m[a][2] * v[2];
    if (!normalise(next)) return;
    for (int a = 0; a < 3; a++) v[a] = next[a];
  }
}

/* At most so many points of so many supporters are expected, one drawn through each pair. */
static double expected_by_chance(int count, int supporters) {
  double expected = .5 * count * (count - 1);
  for (int i = 1; i <= supporters - 2; i++) expected *= POINTS_BY_CHANCE * (count - 1 - i) / i;
  return expected;
}

static bool find_one(const line *lines, int count, uint64_t key, rc_vanishing *best) {
  int supporters;
  best->support = 0;
  for (int n = 0; n < PROPOSALS; n++) {
    uint64_t bits = rc_random(key, (uint32_t)n, 0, 0);
    const line *a = &lines[rc_below((uint32_t)bits, (uint32_t)count)];
    const line *b = &lines[rc_below((uint32_t)(bits >> 32), (uint32_t)count)];
    double v[3];
    if (a == b) continue;
    cross(a->normal, b->normal, v);
    if (!normalise(v)) continue;
    double support = support_of(lines, count, v, &supporters);
    if (support <= best->support) continue;
    best->support = support;
    for (int i = 0; i < 3; i++) best->direction[i] = v[i];
  }
  for (int i = 0; best->support > 0 && i < REFINEMENTS; i++) {
    double v[3] = {best->direction[0], best->direction[1], best->direction[2]};
    refine(lines, count, v);
    double support = support_of(lines, count, v, &supporters);
    if (support <= best->support) break;
    best->support = support;
    for (int k = 0; k < 3; k++) best->direction[k] = v[k];
  }
  support_of(lines, count, best->direction, &supporters);
  return supporters >= LEAST_SUPPORTERS && expected_by_chance(count, supporters) < MOST_BY_CHANCE;
}

/* Returns how many stay. */
static int leave(line *lines, int count, const double v[3]) {
  int stay = 0;
  for (int i = 0; i < count; i++)
    if (off(&lines[i], v) >= LEAVES) lines[stay++] = lines[i];
  return stay;
}

static void make_line(const rc_segment *segment, const rc_image *image, double focal_px,
                      const double on[2], line *l) {
  double cx = .5 * (image->width - 1), cy = .5 * (image->height - 1);
  *l = (line){(segment->x - cx) / focal_px,
              (segment->y - cy) / focal_px,
              segment->dx,
              segment->dy,
              {0},
              segment->length};
  const double middle[3] = {l->x, l->y, 1}, along[3] = {l->dx, l->dy, 0};
  cross(middle, along, l->normal);
  normalise(l->normal);
  if (!on) return;
  double reach = REACH * (image->width > image->height ? image->width : image->height);
  double x = (segment->x - on[0]) / reach, y = (segment->y - on[1]) / reach;
  l->weight *= FAR_WEIGHT + (1 - FAR_WEIGHT) / (1 + x * x + y * y);
}

recede_status rc_vanishing_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                                double focal_px, const double on[2],
                                rc_vanishing points[RC_VANISHING_POINTS], int *count) {
  rc_block *mark = rc_mark(context);
  rc_segment *segments;
  line *lines;
  int left;
  RC_TRY(RC_NEW(context, RC_MOST_SEGMENTS, &segments));
  RC_TRY(RC_NEW(context, RC_MOST_SEGMENTS, &lines));
  RC_TRY(rc_segments_find(context, image, flags, segments, &left));
  for (int i = 0; i < left; i++) make_line(&segments[i], image, focal_px, on, &lines[i]);
  for (*count = 0; *count < RC_VANISHING_POINTS && left >= LEAST_SUPPORTERS; ++*count) {
    rc_vanishing *point = &points[*count];
    double total = 0;
    RC_TRY(rc_poll(context));
    if (!find_one(lines, left, rc_key(0, (uint32_t)*count, 0), point)) break;
    for (int i = 0; i < left; i++) total += lines[i].weight;
    point->support /= total;
    left = leave(lines, left, point->direction);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
