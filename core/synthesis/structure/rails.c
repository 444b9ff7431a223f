#include "synthesis/structure/rails.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"
#include "synthesis/structure/moves.h"
#include "synthesis/structure/repeats.h"

/* A texture runs if, moved along its lines by so many px of the coarsest level, it changes by less
 * than this part of what it does moved across: boards .05 to .16, bricks and tiles .5 to 1. So it
 * must be also where no point counts more than most differ by: boards .07 to .26, but a road whose
 * one marking does not change along itself, .15 to .22, has .52 and more. */
#define RUN_PX 2.f
#define MOST_ALONG .3
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

static rc_rails turned(rc_rails rails, float tangent) {
  float a = rails.a - tangent * rails.b, b = rails.b + tangent * rails.a;
  float length = sqrtf(a * a + b * b);
  return (rc_rails){.a = a / length, .b = b / length};
}

/* Turned to where moves along change least: by so much or, where that leads out of what is known,
 * half as far and so on. */
static rc_rails sharpened(const rc_moves *m, rc_rails rails, float reach_px, float turn) {
  static const float parts[] = {1, -1, .5f, -.5f};
  rc_rails best = rails;
  double least = INFINITY;
  for (; least == INFINITY && reach_px >= FAR_RUN_PX; reach_px /= 2)
    for (int n = -TURNS; n <= TURNS; n++) {
      rc_rails r = turned(rails, turn * (float)n);
      rc_change_sum c = {0, 0};
      for (int k = 0; k < 4; k++)
        rc_moves_look(m, parts[k] * reach_px * r.a, parts[k] * reach_px * r.b, &c);
      if (rc_moves_mean(&c) < least) least = rc_moves_mean(&c), best = r;
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

static bool changes_little_along(const rc_moves *m, rc_rails r) {
  return rc_moves_along(m, r.a, r.b, RUN_PX) < MOST_ALONG * rc_moves_across(m, r.a, r.b, RUN_PX);
}

static bool runs(rc_moves *m, rc_rails r) {
  if (!changes_little_along(m, r)) return false;
  m->most_change = rc_moves_usual_change(m);
  bool all_do = changes_little_along(m, r);
  m->most_change = INFINITY;
  return all_do;
}

/* The direction that the texture changes least along. False: it does not run. */
static bool scan(const rc_moves *m, rc_rails *best) {
  rc_rails r = {.a = 1, .b = 0};
  double least = INFINITY, most_across = 0;
  for (int n = 0; n < SCANNED; n++, r = turned(r, SCAN_TURN)) {
    double across = rc_moves_across(m, r.a, r.b, FAR_RUN_PX);
    double ratio = isfinite(across) ? rc_moves_along(m, r.a, r.b, FAR_RUN_PX) / across : INFINITY;
    if (ratio < least) least = ratio, *best = r;
  }
  if (least == INFINITY) return false;
  for (float px = RUN_PX; px <= 2 * FAR_RUN_PX; px += RUN_PX) {
    double across = rc_moves_across(m, best->a, best->b, px);
    if (isfinite(across)) most_across = fmax(most_across, across);
  }
  return rc_moves_along(m, best->a, best->b, RUN_PX) < MOST_ALONG_NEAR * most_across &&
         rc_moves_along(m, best->a, best->b, FAR_RUN_PX) < MOST_ALONG_FAR * most_across;
}

/* Whether what runs along the rails leads out of the picture where the hole does, or no farther
 * than strip px from there: no line is seen to cross a hole there. */
static bool leaves_the_picture(const rc_chart *chart, const rc_mask *flags, int strip, rc_rails r) {
  rc_chart flat = rc_chart_flat(*chart);
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      bool at_side = x <= strip || x + strip >= flags->width - 1;
      bool at_top = y <= strip || y + strip >= flags->height - 1;
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

/* Markings come in by themselves, and what lies beside them may have edges of its own. */
static bool has_marking(const rc_crossing *lines, int count) {
  for (int i = 0; i < count; i++)
    if (rc_crossing_is_marking(&lines[i])) return true;
  return false;
}

recede_status rc_rails_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, int from, const rc_chart *chart, bool may_repeat,
                            rc_crossing *lines, int *count, rc_rails *rails) {
  int coarse = levels - 1, fine = coarse > FINER_BY ? coarse - FINER_BY : 0;
  const rc_mask *flags = &masks[coarse];
  rc_chart here = rc_chart_coarser(*chart, coarse);
  rc_moves *m;
  rc_rails along = {0};
  bool told = *count > 0;
  *rails = (rc_rails){0};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &m));
  if (told) {
    along = median_of(chart, lines, *count);
  } else {
    RC_TRY(rc_moves_set(context, &images[coarse], flags, here, true, NULL, m));
    int strip = (RC_STRIP_PX << from) >> coarse;
    told = scan(m, &along) && leaves_the_picture(&here, flags, strip, along);
  }
  if (told) RC_TRY(rc_moves_set(context, &images[coarse], flags, here, false, NULL, m));
  if (told && runs(m, along)) {
    float reach_px = how_far(lines, *count, &masks[0]);
    rc_rails r = sharpened(m, along, reach_px / (float)(1 << coarse), COARSE_TURN);
    RC_TRY(rc_moves_set(context, &images[fine], &masks[fine], rc_chart_coarser(*chart, fine), false,
                        NULL, m));
    r = sharpened(m, r, reach_px / (float)(1 << fine), FINE_TURN);
    if (!has_marking(lines, *count) && keep_lines_straight(chart, lines, *count, coarse, r))
      *rails = r;
  }
  if (*count && !rc_runs(rails) && may_repeat) {
    bool repeats;
    RC_TRY(rc_repeats_near(context, &images[coarse], flags, &here, along.a, along.b, &repeats));
    if (repeats) rc_crossings_keep_lone(lines, count);
  }
  rc_release(context, mark);
  return rc_poll(context);
}

recede_status rc_runs_on_both_sides(rc_context *context, const rc_image *images,
                                    const rc_mask *masks, int levels, const rc_chart *chart,
                                    const rc_rails *rails, const rc_boundary *boundary,
                                    bool *result) {
  int coarsest = levels - 1;
  rc_chart here = rc_chart_coarser(*chart, coarsest);
  rc_boundary side = rc_boundary_coarser(*boundary, coarsest);
  rc_moves *m;
  *result = rc_runs(rails);
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &m));
  for (int i = 0; i < 2 && *result; i++, side = rc_other_side(side)) {
    RC_TRY(rc_moves_set(context, &images[coarsest], &masks[coarsest], here, false, &side, m));
    *result = runs(m, *rails);
  }
  rc_release(context, mark);
  return rc_poll(context);
}
