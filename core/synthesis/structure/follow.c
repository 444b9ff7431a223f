#include "synthesis/structure/follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/real.h"
#include "kernels/kernels.h"
#include "synthesis/structure/reach.h"
#include "synthesis/structure/straighten.h"
#include "synthesis/structure/strays.h"

/* A line's own profile is found within so many px of where a straight fit over a longer run puts
 * it: lines are a little bent, and so are lenses. */
#define FAR_PX 32
#define PINNED_WITHIN_PX 2.f
#define PINNED_STEP_PX .25f
/* And one that no other vouches for must go on: in each of so many windows of so many px, one
 * behind the other, its profile must correlate with its own. Crests and hedges look like lines for
 * one window: .1 to .7 in the third, cracks and boards .84 and more. But kerbs bend, and end: if of
 * the hole's border hardly anything is as strong, it is no crest. Seen coarser windows are longer,
 * and the second may lie where a kerb is too thin to be seen. */
#define GOES_ON_WINDOWS 3
#define GOES_ON_WINDOWS_OF_STRONGEST 2
#define GOES_ON_WINDOWS_SEEN_COARSER 1
#define GOES_ON_WINDOWS_LEAVING 4 /* a dash is shorter */
#define GOES_ON_PX 24
#define LEAST_GOING_ON .75f
/* One that is not sure, and no stronger than others, must do so for half as far as it is to be
 * led, at both ends: edges of stones that are longer than three windows met across a hole, and a
 * bar lay on the beach. Where the ground gets this much narrower it looks another way by itself. */
#define LEAST_GOING_ON_OF_LENGTH .5f
#define LEAST_AS_WIDE_OF_LENGTH .7f
/* Where a sure one is less than half as wide as beside the hole, it need not look the same. */
#define LEAST_AS_WIDE .5f
#define LEAST_OF_CONTRAST .02f /* of its square: less is another thing's slope */
/* From piece to piece it may bend by so much. */
#define MOST_BEND_PX 1.f
/* The part of its contrast that must be left, in the mean over the pieces. Dotted cracks keep .8,
 * what has faded or was followed astray .1 to .4. */
#define LEAST_KEPT .6f
/* Another tone, as in the shadow of a rail, costs this per square of the line's own deviation. */
#define PRICE_OF_TONE .5f
#define LEAST_OF_PIECE -.5f
/* Where a line leaves the hole at a flat angle it has the hole on one side: its sources begin so
 * much farther away, or farther. */
#define FARTHER_PX 10.f
#define FARTHEST_PX 30.f
/* Where pieces bring along what crosses the line, others that keep nearly as much of it, and of
 * which at most half do, and so many fewer where others at the hole's border are as strong, are
 * taken from up to its length farther away. */
#define NEARLY_AS_MUCH .9f
#define FEWER_STRAYS 2
/* Where w at one end is no more than so many times that at the other: else what lies along it gets
 * wider, and the edges of a marking seem to cross each other. */
#define HARDLY_NEARER 1.2f
/* Of a branch that is clear so many times the same piece may be moved in, for what it leaves ends,
 * too; so others come of edges of stones. */
#define MOST_GROUPS 2
/* What is magnified is blurred: of all the ways to take a line that one is best whose sources keep
 * most of its contrast, less so much for each octave that they are magnified by in the mean. */
#define PRICE_OF_MAGNIFICATION .2f
/* Sources may be this much smaller than what they fill, and more of what leaves the picture, for
 * there are no others; how much larger depends on the way. */
#define MOST_MAGNIFIED 1.7f
#define MOST_MAGNIFIED_LEAVING 3.f
/* Each way to follow it. Of a line that leads to the viewer sources are larger and
 * its profile wider, and its pieces short, for far away they are long in the plane. But short ones
 * may wobble, and thin lines far away are as wide as a blur is. */
static const struct way {
  float most_reduced;
  int pieces, splits;
  bool widens;
} ways[] = {{1.7f, 8, 5, false}, {3.f, 24, 9, true}, {6.f, 24, 9, true}};
/* What recedes has one way: near the picture's end a run may be no longer than a fiftieth of what
 * it shows of the plane. */
static const struct way receding = {10.f, RC_MOST_PIECES, 9, true};
#define MOST_NARROWED 10.f
/* It does where w at one end is so many times that at the other; what lies at the horizon itself,
 * where it is less than that (the hole has about 1), does not. */
#define LEAST_NEARER 1.5f
#define LEAST_W .1f

/* Where the line is parted: what lies before comes from beyond a, the rest from beyond b. */
enum { FROM_A, FROM_B };
static const float splits[] = {[FROM_A] = 1, [FROM_B] = 0, .5f,   .25f, .75f,
                               .125f,        .375f,        .625f, .875f};

/* Profiles are read across the line's direction from a to b, in the same sense on both sides. */
typedef struct frame {
  rc_ruler ruler;
  const rc_chart *chart;
  rc_crossing *line;
  float length;
  float most_reduced, most_magnified;
  float farther_px; /* than from right beside the hole its sources lie */
  int windows;      /* in which it must go on */
} frame;

static void set_frame(frame *f) {
  float dx = f->line->bx - f->line->ax, dy = f->line->by - f->line->ay;
  f->length = sqrtf(dx * dx + dy * dy);
  f->ruler.ux = dx / f->length, f->ruler.uy = dy / f->length;
}

static frame frame_of(const rc_seen *picture, const rc_chart *chart, int windows,
                      const struct way *way, rc_crossing *line) {
  frame f = {.ruler = {.picture = picture},
             .chart = chart,
             .line = line,
             .most_reduced = way->most_reduced,
             .most_magnified = line->leaves ? MOST_MAGNIFIED_LEAVING : MOST_MAGNIFIED,
             .windows = windows};
  if (way->widens) f.ruler.chart = chart;
  line->pieces = way->pieces;
  set_frame(&f);
  return f;
}

/* Moves an end across the line until its nearest px look like its run does in the mean; outwards is
 * -1 at a and 1 at b. own: the profile there. */
static bool pin(const frame *f, float outwards, float *x, float *y, rc_profile *own) {
  rc_profile far, near;
  float most = -1e30f, moved = 0;
  float from = outwards * RC_PROFILE_FROM_PX;
  if (!rc_profile_mean(&f->ruler, *x, *y, from, outwards, FAR_PX, &far)) return false;
  for (float across = -PINNED_WITHIN_PX; across <= PINNED_WITHIN_PX; across += PINNED_STEP_PX) {
    if (!rc_profile_mean(&f->ruler, *x - f->ruler.uy * across, *y + f->ruler.ux * across, from,
                         outwards, RC_PROFILE_NEAR_PX, &near))
      continue;
    float likeness = 2 * rc_profile_dot(&near, &far) - rc_profile_dot(&near, &near);
    if (likeness > most) most = likeness, moved = across;
  }
  *x -= f->ruler.uy * moved, *y += f->ruler.ux * moved;
  return rc_profile_mean(&f->ruler, *x, *y, from, outwards, RC_PROFILE_NEAR_PX, own);
}

/* How many times as wide the ground is so far out as at an end. */
static float as_wide(const frame *f, float x, float y, float outwards) {
  return rc_chart_w(f->chart, x + outwards * f->ruler.ux, y + outwards * f->ruler.uy) /
         rc_chart_w(f->chart, x, y);
}

/* Where the picture or the source ends, so may the line. */
static bool goes_on(const frame *f, float outwards, float x, float y, const rc_profile *own) {
  float square = rc_profile_dot(own, own);
  bool leaves = f->line->leaves, sure = f->line->strength >= RC_SURE_STRENGTH && !leaves;
  for (int k = 0; k < f->windows; k++) {
    float most = -1, from = RC_PROFILE_FROM_PX + GOES_ON_PX * (float)k;
    bool known = false;
    float wide = as_wide(f, x, y, outwards * (from + GOES_ON_PX / 2.f));
    if ((sure && wide < LEAST_AS_WIDE) ||
        (k >= GOES_ON_WINDOWS && !leaves && wide < LEAST_AS_WIDE_OF_LENGTH))
      break;
    for (float across = -PINNED_WITHIN_PX; across <= PINNED_WITHIN_PX; across += .5f) {
      rc_profile here;
      if (!rc_profile_mean(&f->ruler, x - f->ruler.uy * across, y + f->ruler.ux * across,
                           outwards * from, outwards, GOES_ON_PX, &here))
        continue;
      float contrast = rc_profile_dot(&here, &here);
      known = true;
      if (contrast > LEAST_OF_CONTRAST * square)
        most = fmaxf(most, rc_profile_dot(&here, own) / sqrtf(square * contrast));
    }
    if (known && most < LEAST_GOING_ON) return false;
  }
  return true;
}

/* Where the straight line's point t (0 = a, 1 = b) comes from when the line is moved along itself
 * until its point split lies just outside the hole, beyond a for what lies before it. */
static bool straight_source(const frame *f, float split, float t, float *x, float *y) {
  const rc_crossing *c = f->line;
  rc_chart flat = rc_chart_flat(*f->chart);
  float margin = (RC_PROFILE_FROM_PX + RC_PATCH_RADIUS + f->farther_px) / f->length;
  float to = t < split ? -margin : 1 + margin, dx = c->bx - c->ax, dy = c->by - c->ay;
  float ax = c->ax - flat.x0, ay = c->ay - flat.y0;
  rc_copy copy =
      rc_copy_between(&flat, ax + split * dx, ay + split * dy, ax + to * dx, ay + to * dy);
  rc_place place = rc_copy_place(&flat, copy, ax + t * dx, ay + t * dy);
  *x = place.x + flat.x0, *y = place.y + flat.y0;
  return !place.beyond && place.ratio < f->most_reduced && place.ratio > 1 / f->most_magnified;
}

/* Half a piece's length in the picture, px. */
static float half_of(const frame *f, int piece) {
  if (!f->line->recedes) return f->length / (float)(2 * f->line->pieces);
  float from = rc_crossing_part(f->chart, f->line, (float)piece);
  return f->length / 2 * (rc_crossing_part(f->chart, f->line, (float)piece + 1) - from);
}

/* Finds one piece's source near the straight one, the bend of the piece before taken over. kept:
 * the part of own's contrast that it has, less what its tone is off. False: there is none. */
static bool follow_piece(const frame *f, float split, int piece, const rc_profile *own, float *bend,
                         float *kept) {
  rc_profile here;
  float x, y, square = fmaxf(rc_profile_dot(own, own), 1e-12f), before = *bend,
              half = half_of(f, piece);
  int count = half < 2 ? 4 : (int)(2 * half);
  if (!straight_source(f, split, rc_crossing_part(f->chart, f->line, (float)piece + .5f), &x, &y))
    return false;
  *kept = LEAST_OF_PIECE;
  for (float step = -MOST_BEND_PX; step <= MOST_BEND_PX; step += PINNED_STEP_PX) {
    float across = before + step, px = x - f->ruler.uy * across, py = y + f->ruler.ux * across;
    if (!rc_profile_mean(&f->ruler, px, py, .5f - half, 1, count, &here)) continue;
    float off = here.tone - own->tone;
    float part =
        rc_profile_dot(&here, own) / square - PRICE_OF_TONE * RC_PROFILE * off * off / square;
    if (part <= *kept) continue;
    *kept = part, *bend = across;
    f->line->from_x[piece] = px, f->line->from_y[piece] = py;
  }
  return *kept > LEAST_OF_PIECE;
}

/* The pieces from first on, away from the split, each from where a move of the whole group puts it,
 * followed from the hole outwards. Where the picture ends the next piece begins a group of its own,
 * beside the hole again. Adds what is kept to sum. */
static bool follow_side(const frame *f, int first, int end, int step, const rc_profile *own,
                        float *sum) {
  float bend = 0, kept;
  for (int piece = first, group = first; piece != end; piece += step) {
    float split = rc_crossing_part(f->chart, f->line, (float)(step < 0 ? group + 1 : group));
    if (!follow_piece(f, split, piece, own, &bend, &kept)) {
      group = piece, bend = 0;
      split = rc_crossing_part(f->chart, f->line, (float)(step < 0 ? group + 1 : group));
      if (!follow_piece(f, split, piece, own, &bend, &kept)) return false;
    }
    *sum += fmaxf(fminf(kept, 1), 0);
  }
  return true;
}

/* Pieces before split come from beyond a, the others from beyond b. The part of the contrast that
 * is kept. */
static float follow_both(const frame *f, float split, const rc_profile *own_a,
                         const rc_profile *own_b) {
  int middle = (int)(split * (float)f->line->pieces);
  float sum = 0;
  if (!follow_side(f, middle - 1, -1, -1, own_a, &sum) ||
      !follow_side(f, middle, f->line->pieces, 1, own_b, &sum))
    return 0;
  return sum / (float)f->line->pieces;
}

static int count_strays(const frame *f, const rc_clean *clean) {
  int count = 0, length = (int)(f->length / (float)f->line->pieces) + 2;
  for (int k = 0; k < f->line->pieces; k++)
    count += rc_strays_at(&f->ruler, clean, f->line->from_x[k], f->line->from_y[k], length);
  return count;
}

/* As the line is at its cleaner end. */
static bool measure_clean(const frame *f, rc_clean *clean) {
  rc_clean b;
  bool at_a = rc_clean_measure(&f->ruler, f->line->ax, f->line->ay, -1, clean);
  bool at_b = rc_clean_measure(&f->ruler, f->line->bx, f->line->by, 1, &b);
  if (at_b && (!at_a || b.usual < clean->usual)) *clean = b;
  return at_a || at_b;
}

/* How many times w at one end that at the other is; INFINITY at the horizon. */
static float nearer(const rc_chart *chart, const rc_crossing *line) {
  float a = rc_chart_w(chart, line->ax, line->ay), b = rc_chart_w(chart, line->bx, line->by);
  float least_w = line->recedes ? 0 : LEAST_W;
  return fminf(a, b) > least_w ? fmaxf(a, b) / fminf(a, b) : INFINITY;
}

/* Where something crosses the line beside the hole, sources farther along it. */
static void prefer_clean(frame *f, const struct way *way, const rc_profile *own_a,
                         const rc_profile *own_b, rc_crossing *best) {
  rc_clean clean;
  float enough = fmaxf(LEAST_KEPT, NEARLY_AS_MUCH * best->kept);
  bool sure = rc_crossing_is_sure(best);
  *f->line = *best;
  if (nearer(f->chart, best) > HARDLY_NEARER || !measure_clean(f, &clean)) return;
  int strays = count_strays(f, &clean);
  int fewer = f->line->as_strong > RC_HARDLY_AS_STRONG ? FEWER_STRAYS : 1;
  int most = strays / 2 < strays - fewer ? strays / 2 : strays - fewer;
  for (f->farther_px = 0; most >= 0 && f->farther_px <= f->length; f->farther_px += FARTHER_PX)
    for (int i = 0; i < way->splits && most >= 0; i++) {
      rc_crossing c = *best;
      c.kept = follow_both(f, splits[i], own_a, own_b);
      int left =
          c.kept < enough || rc_crossing_is_sure(&c) < sure ? strays : count_strays(f, &clean);
      if (left > most) continue;
      most = left - 1;
      *best = *f->line, best->kept = c.kept;
    }
}

/* By how many octaves its pieces' sources are magnified, in the mean. */
static float octaves_magnified(const frame *f) {
  const rc_crossing *c = f->line;
  float sum = 0;
  for (int k = 0; k < c->pieces; k++) {
    float t = rc_crossing_part(f->chart, c, (float)k + .5f);
    float own = rc_chart_w(f->chart, c->ax + t * (c->bx - c->ax), c->ay + t * (c->by - c->ay));
    sum += fmaxf(rc_log2(own / rc_chart_w(f->chart, c->from_x[k], c->from_y[k])), 0);
  }
  return sum / (float)c->pieces;
}

/* worth: what is kept, less the price; and more of a sure one than of any that is not. */
static bool follow_one_way(const rc_seen *picture, const rc_chart *chart, int windows,
                           const struct way *way, rc_crossing *line, float *worth) {
  rc_profile own_a, own_b;
  rc_crossing best;
  bool found = false, leaves = line->leaves;
  frame f = frame_of(picture, chart, windows, way, line);
  if ((!leaves && !pin(&f, -1, &line->ax, &line->ay, &own_a)) ||
      !pin(&f, 1, &line->bx, &line->by, &own_b))
    return false;
  set_frame(&f);
  if (leaves) {
    rc_straighten(&f.ruler, &own_b, line);
    set_frame(&f);
  }
  if (line->recedes && nearer(chart, line) > MOST_NARROWED)
    return false; /* turned to the horizon */
  if ((!leaves && !goes_on(&f, -1, line->ax, line->ay, &own_a)) ||
      !goes_on(&f, 1, line->bx, line->by, &own_b))
    return false;
  for (; f.farther_px <= FARTHEST_PX && !found; f.farther_px += FARTHER_PX)
    for (int i = leaves ? FROM_B : 0; i < (leaves ? FROM_B + 1 : way->splits); i++) {
      float kept = follow_both(&f, splits[i], leaves ? &own_b : &own_a, &own_b);
      if (kept <= LEAST_KEPT) continue;
      rc_crossing c = *line;
      c.kept = kept;
      float here = kept - PRICE_OF_MAGNIFICATION * octaves_magnified(&f) + rc_crossing_is_sure(&c);
      if (found && here <= *worth) continue;
      *worth = here, best = c, found = true;
    }
  if (!found) return false;
  if (!leaves) prefer_clean(&f, way, &own_a, &own_b, &best);
  *line = best;
  f.ruler.chart = chart;
  if (!leaves) rc_reach_measure(&f.ruler, -1, line->ax, line->ay, false, line->reach_px);
  rc_reach_measure(&f.ruler, 1, line->bx, line->by, leaves, line->reach_px);
  return true;
}

int rc_windows_of(const rc_crossing *line, bool seen_coarser) {
  if (line->leaves) return GOES_ON_WINDOWS_LEAVING;
  if (line->as_strong <= RC_HARDLY_AS_STRONG)
    return seen_coarser ? GOES_ON_WINDOWS_SEEN_COARSER : GOES_ON_WINDOWS_OF_STRONGEST;
  int of_length = (int)ceilf(LEAST_GOING_ON_OF_LENGTH * rc_crossing_length(line) / GOES_ON_PX);
  bool is_chancy = line->strength < RC_SURE_STRENGTH && !line->ends_inside;
  return is_chancy && of_length > GOES_ON_WINDOWS ? of_length : GOES_ON_WINDOWS;
}

bool rc_follow(const rc_seen *picture, const rc_chart *chart, int windows, rc_crossing *line) {
  float worth;
  if (line->recedes) return follow_one_way(picture, chart, windows, &receding, line, &worth);
  const rc_crossing from = *line;
  float times = nearer(chart, line), most = 0;
  bool found = false;
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
    rc_crossing c = from;
    if (ways[n].widens && !(times > LEAST_NEARER && times < INFINITY)) continue;
    if (!follow_one_way(picture, chart, windows, &ways[n], &c, &worth)) continue;
    if (!found || worth > most) *line = c, most = worth;
    found = true;
  }
  return found;
}

/* Its pieces in groups of so many, each from beside the hole again: a clear joint may be shorter
 * than the way it has to go. */
static bool follow_groups(const frame *f, int size, const rc_profile *own, float *sum) {
  float bend = 0, kept;
  *sum = 0;
  for (int piece = 0; piece < f->line->pieces; piece++) {
    int group = piece - piece % size;
    if (piece == group) bend = 0;
    if (!follow_piece(f, (float)group / (float)f->line->pieces, piece, own, &bend, &kept))
      return false;
    *sum += fmaxf(fminf(kept, 1), 0) / (float)f->line->pieces;
  }
  return true;
}

bool rc_follow_branch(const rc_seen *picture, const rc_chart *chart, int windows,
                      rc_crossing *branch) {
  rc_profile own;
  rc_crossing best = *branch;
  frame f = frame_of(picture, chart, windows, ways, branch);
  float most = LEAST_KEPT, kept;
  bool found = false, is_clear = branch->strength >= RC_CLEAR_STRENGTH;
  if (!pin(&f, 1, &branch->bx, &branch->by, &own)) return false;
  set_frame(&f);
  if (!goes_on(&f, 1, branch->bx, branch->by, &own)) return false;
  for (int groups = 1; groups <= (is_clear ? MOST_GROUPS : 1) && !found; groups *= 2) {
    if (!follow_groups(&f, branch->pieces / groups, &own, &kept) || kept <= most) continue;
    best = *branch, best.kept = kept, found = true;
  }
  *branch = best;
  return found;
}
