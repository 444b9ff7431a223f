#include "synthesis/structure/rails.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/real.h"
#include "synthesis/structure/profile.h"

/* A texture runs if, moved along its lines by so many px of the coarsest level, it changes by less
 * than this part of what it does moved across: boards .05 to .16, bricks and tiles .5 to 1. */
#define RUN_PX 2.f
#define MOST_ALONG .3
/* A texture repeats if, moved along by so many px of the coarsest level, it changes by less than
 * this part of what it does moved half as far and, if that is seen, half as far again: bricks,
 * tiles and steps .27 to .60, roofs .74 to .91, cracks .72 to 1, boards .9 and more. So it must be
 * also where no point counts more than most differ by: what stands out, as a dash on a road,
 * differs by more than all the rest together. And half as far it must change by this part of what
 * it does moved a little across, .57 and more, or there is nothing that could repeat: bands that
 * converge .01. */
#define LEAST_BETWEEN .1
#define LEAST_PERIOD_PX 6
#define MOST_PERIOD_PX 64
#define MOST_REPEATED .69
#define STANDS_OUT .1 /* the brightest and the darkest of all points */
/* The lines' own direction is good to .5 degrees; over a hole's length that is a joint's width. So
 * so many directions to each side are tried, in tangents, first at the coarsest level and then so
 * many levels finer. */
#define TURNS 8
#define COARSE_TURN .008f
#define FINE_TURN .002f
#define FINER_BY 2
/* Where none of the two strongest lines lies along the rails, but for so many px of the coarsest
 * level from end to end, it would break in the hole: boards have 0 to .2, the wheel tracks beside a
 * bent crack 1. Of the clear lines none may break by more: boards have .7 and less, the edges of a
 * crash barrier and of the ground behind it, which converge, 1.4. */
#define MOST_STEP_PX .4f
#define MOST_STEP_OF_CLEAR_PX 1.f
/* Points that are looked at, of scales near the hole's, and how many of them must be seen. */
#define POINTS 2000
#define TRIES (8 * POINTS)
#define LEAST_SEEN 50
#define WIDEST_RATIO 2.f
/* Whether lines repeat is asked so near to the hole, in its longer sides: from one rail of a pier
 * to the other its texture seems to. What points are compared with may lie anywhere. */
#define NEAR_HOLE .5f
/* Lines leave the picture where they meet its end at 27 degrees or more. */
#define LEAST_LEAVING .5f
/* Where no line crosses the hole all directions are tried, 4 degrees apart. A texture runs along
 * the best if, moved by so many px of the coarsest level near the hole, it changes by less than
 * these parts of what it does moved across by up to twice as far: boards .03 to .14 and .06 to .35,
 * waves .13 and .47 and more, tiles .28 and .19. */
#define SCANNED 45
#define SCAN_TURN .069926812f
#define FAR_RUN_PX 6.f
#define MOST_ALONG_NEAR .18
#define MOST_ALONG_FAR .41

typedef struct view {
  const rc_image *image;
  const rc_mask *flags;
  rc_chart chart;
  double most_change; /* squared: of any point no more counts */
  int count;
  int32_t points[POINTS];
} view;

static bool source_at(const void *user, int x, int y, float *value) {
  const view *v = user;
  if (!rc_inside(v->flags->width, v->flags->height, x, y)) return false;
  *value = rc_brightness_at(v->image, x, y);
  return (*rc_flag(v->flags, x, y) & RC_SOURCE) != 0;
}

static rc_box all_of(const rc_mask *flags) { return (rc_box){0, 0, flags->width, flags->height}; }

static rc_box near_hole(const rc_mask *flags) {
  rc_box hole = rc_box_of(flags, RC_TARGET);
  int margin = (int)(NEAR_HOLE * (float)rc_longer_side(hole));
  return rc_box_grown(hole, margin, flags->width, flags->height);
}

/* Points of the sources within the box. beside: only where its distance is positive; NULL: all. */
static void set_view(const rc_image *image, const rc_mask *flags, rc_chart chart, rc_box box,
                     const rc_boundary *beside, view *v) {
  box = rc_box_common(box, rc_box_of(flags, RC_SOURCE)); /* they may be few, of a large picture */
  *v = (view){image, flags, rc_chart_flat(chart), INFINITY, 0, {0}};
  if (box.x1 <= box.x0 || box.y1 <= box.y0) return;
  for (uint32_t n = 0; n < TRIES && v->count < POINTS; n++) {
    uint64_t bits = rc_random(rc_key(0, 97, 0), n, 0, 0);
    int x = box.x0 + (int)rc_below((uint32_t)bits, (uint32_t)(box.x1 - box.x0));
    int y = box.y0 + (int)rc_below((uint32_t)(bits >> 32), (uint32_t)(box.y1 - box.y0));
    float px = (float)x - chart.x0, py = (float)y - chart.y0,
          w = 1.f + chart.lx * px + chart.ly * py;
    if (beside && !(beside->nx * px + beside->ny * py + beside->at > 0)) continue;
    if (*rc_flag(flags, x, y) & RC_SOURCE && w > 1 / WIDEST_RATIO && w < WIDEST_RATIO)
      v->points[v->count++] = y * image->width + x;
  }
}

typedef struct change {
  double squares, seen;
} change;

/* Adds what moving the plane by (a, b) changes. */
static void look(const view *v, float a, float b, change *c) {
  rc_ruler ruler = {source_at, v, 0, 0};
  for (int i = 0; i < v->count; i++) {
    int x = v->points[i] % v->image->width, y = v->points[i] / v->image->width;
    float there, here = rc_brightness_at(v->image, x, y);
    rc_place place = rc_copy_place(&v->chart, (rc_copy){a, b, 0}, (float)x - v->chart.x0,
                                   (float)y - v->chart.y0);
    if (place.beyond || !(place.ratio < WIDEST_RATIO && place.ratio > 1 / WIDEST_RATIO) ||
        !rc_ruler_sample(&ruler, place.x + v->chart.x0, place.y + v->chart.y0, &there))
      continue;
    c->squares += fmin((there - here) * (there - here), v->most_change);
    c->seen++;
  }
}

/* Its mean; INFINITY: too little was seen. */
static double mean_of(const change *c) {
  return c->seen < LEAST_SEEN ? INFINITY : c->squares / c->seen;
}

static rc_rails turned(rc_rails rails, float tangent) {
  float a = rails.a - tangent * rails.b, b = rails.b + tangent * rails.a;
  float length = sqrtf(a * a + b * b);
  return (rc_rails){.a = a / length, .b = b / length};
}

/* Turned to where moves along change least: by so much or, where that leads out of what is known,
 * half as far and so on. */
static rc_rails sharpened(const view *v, rc_rails rails, float reach_px, float turn) {
  static const float parts[] = {1, -1, .5f, -.5f};
  rc_rails best = rails;
  double least = INFINITY;
  for (; least == INFINITY && reach_px >= FAR_RUN_PX; reach_px /= 2)
    for (int n = -TURNS; n <= TURNS; n++) {
      rc_rails r = turned(rails, turn * (float)n);
      change c = {0, 0};
      for (int k = 0; k < 4; k++) look(v, parts[k] * reach_px * r.a, parts[k] * reach_px * r.b, &c);
      if (mean_of(&c) < least) least = mean_of(&c), best = r;
    }
  return best;
}

/* The lines' median, long and clear ones counting more: grain leans where it likes. */
static rc_rails median_of(const rc_chart *chart, const rc_crossing *lines, int count) {
  float tangent[RC_MOST_LINES], weight[RC_MOST_LINES], all = 0, so_far = 0, median = 0;
  rc_copy first = rc_crossing_direction(chart, &lines[0]);
  for (int i = 0; i < count; i++) {
    rc_copy d = rc_crossing_direction(chart, &lines[i]);
    float length = rc_crossing_length(&lines[i]);
    tangent[i] = (first.a * d.b - first.b * d.a) / (first.a * d.a + first.b * d.b);
    all += weight[i] = sqrtf(lines[i].strength) * length * length;
  }
  for (int n = 0; n < count && so_far <= .5f * all; n++) {
    int least = 0;
    for (int i = 1; i < count; i++)
      if (tangent[i] < tangent[least]) least = i;
    median = tangent[least], tangent[least] = INFINITY, so_far += weight[least];
  }
  return turned((rc_rails){.a = first.a, .b = first.b}, median);
}

/* With q = X / w in one chart and q' in the other, u the old w of the new origin, which is D away,
 *   q' = u (q + D (l . q)) - u D,   q = (q' - D (l . q') / u + D) / u */
rc_rails rc_rails_in_chart(const rc_known_rails *known, const rc_chart *chart) {
  const rc_chart *from = &known->chart;
  rc_rails rails = known->rails;
  float dx = chart->x0 - from->x0, dy = chart->y0 - from->y0;
  float unit = 1.f + from->lx * dx + from->ly * dy;
  float drift = from->lx * rails.a + from->ly * rails.b;
  rc_rails r = rails;
  r.a += dx * drift, r.b += dy * drift;
  float length = sqrtf(r.a * r.a + r.b * r.b);
  r.a /= length, r.b /= length;
  /* Of a joint n . q = j: (n - (n . D) l / u) . q' / u = j - n . D / u. */
  float nd = rails.a * dy - rails.b * dx;
  float na = (-rails.b - nd * from->lx / unit) / unit, nb = (rails.a - nd * from->ly / unit) / unit;
  float across = sqrtf(na * na + nb * nb);
  r.gauge /= across;
  r.joint = (r.joint - nd / unit) / across;
  return r;
}

rc_copy rc_copy_of_move(const rc_chart *chart, float x, float y, float a, float b) {
  rc_copy move = {a, b, 0.f};
  rc_chart flat = rc_chart_flat(*chart);
  if (!chart->raised) return move;
  rc_place place = rc_copy_place(&flat, move, x, y);
  if (place.beyond) return (rc_copy){NAN, NAN, NAN};
  return rc_copy_exact(chart, x, y, place.x, place.y);
}

rc_copy rc_copy_on_rails(const rc_rails *rails, const rc_chart *chart, float tolerance, float x,
                         float y, float to_x, float to_y) {
  rc_chart flat = rc_chart_flat(*chart);
  rc_copy move = rc_copy_between(&flat, x, y, to_x, to_y);
  float off = move.b * rails->a - move.a * rails->b;
  if (rails->rows) {
    float rows = rc_round(off / rails->gauge), most = (float)rails->rows;
    off -= fminf(fmaxf(rows, -most), most) * rails->gauge;
  }
  float too_far = off > tolerance ? off - tolerance : off < -tolerance ? off + tolerance : 0.f;
  return rc_copy_of_move(chart, x, y, move.a + too_far * rails->b, move.b - too_far * rails->a);
}

/* What moving the plane by so much changes. */
static double change_along(const view *v, rc_rails r, float px) {
  change c = {0, 0};
  look(v, px * r.a, px * r.b, &c);
  return mean_of(&c);
}

static double change_across(const view *v, rc_rails r, float px) {
  return change_along(v, (rc_rails){.a = -r.b, .b = r.a}, px);
}

static bool runs(const view *v, rc_rails r) {
  return change_along(v, r, RUN_PX) < MOST_ALONG * change_across(v, r, RUN_PX);
}

static bool comes_again(const view *v, rc_rails r) {
  enum { FARTHEST = MOST_PERIOD_PX + MOST_PERIOD_PX / 2 };
  double changes[FARTHEST + 1], least = LEAST_BETWEEN * change_across(v, r, RUN_PX);
  for (int px = LEAST_PERIOD_PX / 2; px <= FARTHEST; px++) {
    float by = (float)px;
    change c = {0, 0};
    look(v, by * r.a, by * r.b, &c);
    look(v, -by * r.a, -by * r.b, &c);
    changes[px] = mean_of(&c);
  }
  for (int px = LEAST_PERIOD_PX; px <= MOST_PERIOD_PX; px++) {
    int before = px / 2, after = px + px / 2, odd = px % 2;
    double half_way = fmin(changes[before], changes[before + odd]);
    double beyond = fmin(changes[after], changes[after + odd]);
    if (half_way < INFINITY && half_way >= least &&
        changes[px] < MOST_REPEATED * fmin(half_way, beyond))
      return true;
  }
  return false;
}

/* What most points differ by, squared. */
static double usual_change(const view *v) {
  float values[POINTS] = {0};
  for (int i = 0; i < v->count; i++)
    values[i] =
        rc_brightness_at(v->image, v->points[i] % v->image->width, v->points[i] / v->image->width);
  qsort(values, (size_t)v->count, sizeof *values, rc_by_value);
  int end = (int)(STANDS_OUT * v->count);
  double all = v->count ? values[v->count - 1 - end] - values[end] : 0;
  return all > 0 ? all * all : INFINITY;
}

static bool repeats(view *v, rc_rails r) {
  v->most_change = INFINITY;
  if (!comes_again(v, r)) return false;
  v->most_change = usual_change(v);
  return comes_again(v, r);
}

/* The direction that the texture changes least along. False: it does not run. */
static bool scan(const view *v, rc_rails *best) {
  rc_rails r = {.a = 1, .b = 0};
  double least = INFINITY, most_across = 0;
  for (int n = 0; n < SCANNED; n++, r = turned(r, SCAN_TURN)) {
    double across = change_across(v, r, FAR_RUN_PX);
    double ratio = isfinite(across) ? change_along(v, r, FAR_RUN_PX) / across : INFINITY;
    if (ratio < least) least = ratio, *best = r;
  }
  if (least == INFINITY) return false;
  for (float px = RUN_PX; px <= 2 * FAR_RUN_PX; px += RUN_PX) {
    double across = change_across(v, *best, px);
    if (isfinite(across)) most_across = fmax(most_across, across);
  }
  return change_along(v, *best, RUN_PX) < MOST_ALONG_NEAR * most_across &&
         change_along(v, *best, FAR_RUN_PX) < MOST_ALONG_FAR * most_across;
}

/* Whether what runs along the rails leads out of the picture where the hole does: no line crosses a
 * hole there. */
static bool leaves_the_picture(const rc_chart *chart, const rc_mask *flags, rc_rails r) {
  rc_chart flat = rc_chart_flat(*chart);
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      bool at_side = x == 0 || x == flags->width - 1, at_top = y == 0 || y == flags->height - 1;
      if (!(at_side || at_top) || !(*rc_flag(flags, x, y) & RC_TARGET)) continue;
      float px = (float)x - chart->x0, py = (float)y - chart->y0;
      rc_place next = rc_copy_place(&flat, (rc_copy){r.a, r.b, 0}, px, py);
      float dx = fabsf(next.x - px), dy = fabsf(next.y - py);
      if (next.beyond) continue;
      if ((at_side && dx > LEAST_LEAVING * dy) || (at_top && dy > LEAST_LEAVING * dx)) return true;
    }
  return false;
}

/* So far joints must stay where they are: the longest line, or the hole. */
static float how_far(const rc_crossing *lines, int count, const rc_mask *flags) {
  float most = 0;
  if (!count) return (float)rc_longer_side(rc_box_of(flags, RC_TARGET));
  for (int i = 0; i < count; i++) most = fmaxf(most, rc_crossing_length(&lines[i]));
  return most;
}

/* Whether one of the two strongest lines, if there are any, lies along the rails, and no clear one
 * lies far off. */
static bool keep_lines_straight(const rc_chart *chart, const rc_crossing *lines, int count,
                                int coarse, rc_rails rails) {
  float least = count ? INFINITY : 0, most_of_clear = 0, px = (float)(1 << coarse);
  for (int i = 0; i < count; i++) {
    rc_copy d = rc_crossing_direction(chart, &lines[i]);
    float step = fabsf(d.a * rails.b - d.b * rails.a) * rc_crossing_length(&lines[i]);
    if (i < 2) least = fminf(least, step);
    if (lines[i].strength >= RC_CLEAR_STRENGTH) most_of_clear = fmaxf(most_of_clear, step);
  }
  return least <= MOST_STEP_PX * px && most_of_clear <= MOST_STEP_OF_CLEAR_PX * px;
}

recede_status rc_rails_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, const rc_chart *chart, const rc_crossing *lines, int *count,
                            rc_rails *rails) {
  int coarse = levels - 1, fine = coarse > FINER_BY ? coarse - FINER_BY : 0;
  const rc_mask *flags = &masks[coarse];
  rc_chart here = rc_chart_coarser(*chart, coarse);
  view *v;
  rc_rails along = {0};
  bool told = *count > 0;
  *rails = (rc_rails){0};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &v));
  if (told) {
    along = median_of(chart, lines, *count);
  } else {
    set_view(&images[coarse], flags, here, near_hole(flags), NULL, v);
    told = scan(v, &along) && leaves_the_picture(&here, flags, along);
  }
  if (told) set_view(&images[coarse], flags, here, all_of(flags), NULL, v);
  if (told && runs(v, along)) {
    float reach_px = how_far(lines, *count, &masks[0]);
    rc_rails r = sharpened(v, along, reach_px / (float)(1 << coarse), COARSE_TURN);
    set_view(&images[fine], &masks[fine], rc_chart_coarser(*chart, fine), all_of(&masks[fine]),
             NULL, v);
    r = sharpened(v, r, reach_px / (float)(1 << fine), FINE_TURN);
    if (keep_lines_straight(chart, lines, *count, coarse, r)) *rails = r;
  }
  if (*count && !rc_runs(rails)) {
    set_view(&images[coarse], flags, here, near_hole(flags), NULL, v);
    if (repeats(v, along)) *count = 0;
  }
  rc_release(context, mark);
  return rc_poll(context);
}

static rc_boundary other_side(rc_boundary b) { return (rc_boundary){-b.nx, -b.ny, -b.at}; }

recede_status rc_runs_on_both_sides(rc_context *context, const rc_image *images,
                                    const rc_mask *masks, int levels, const rc_chart *chart,
                                    const rc_rails *rails, const rc_boundary *boundary,
                                    bool *result) {
  int coarsest = levels - 1;
  rc_chart here = rc_chart_coarser(*chart, coarsest);
  rc_boundary side = rc_boundary_coarser(*boundary, coarsest);
  view *v;
  *result = rc_runs(rails);
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &v));
  for (int i = 0; i < 2 && *result; i++, side = other_side(side)) {
    set_view(&images[coarsest], &masks[coarsest], here, all_of(&masks[coarsest]), &side, v);
    *result = runs(v, *rails);
  }
  rc_release(context, mark);
  return rc_poll(context);
}

recede_status rc_repeats_beside(rc_context *context, const rc_image *images, const rc_mask *masks,
                                int levels, const rc_chart *chart, const rc_crossing *line,
                                const rc_boundary *boundary, float x, float y, bool *result) {
  int coarsest = levels - 1;
  rc_boundary b = rc_boundary_coarser(*boundary, coarsest);
  rc_copy d = rc_crossing_direction(chart, line);
  view *v;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &v));
  if (boundary->nx * (x - chart->x0) + boundary->ny * (y - chart->y0) + boundary->at < 0)
    b = other_side(b);
  set_view(&images[coarsest], &masks[coarsest], rc_chart_coarser(*chart, coarsest),
           all_of(&masks[coarsest]), &b, v);
  *result = repeats(v, (rc_rails){.a = d.a, .b = d.b});
  rc_release(context, mark);
  return rc_poll(context);
}
