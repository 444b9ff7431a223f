#include "plane/readings.h"

#include <math.h>

#include "plane/belief.h"

/* Each of these two halves the confidence, as a large misfit does unless lines tell the plane;
 * measured on drawn cases, where errors above 8 degrees began at a disagreement of 3, and on photos
 * of several planes (7 and more, a quarter of the cells on the plane). */
#define LARGE_DISAGREEMENT_DEG 7
#define LARGE_AMBIGUITY_DEG 40
#define ALMOST 1.03
#define NO_PLANE_SHARE .2
#define PLANE_SHARE .5
/* Two vanishing points tell a plane whatever lies around it. One, in front, tells this much: roads
 * have but one. */
#define TOLD_BY_ONE_POINT .6
/* A reading that misses one of two points, and the best holds both, is no other reading. */
#define TOLD_SO_MUCH_BETTER .5
/* Floors in pictures mostly lie level: between readings a level one must explain so much less. From
 * .15 to .25 nearly the same floors of photos are read, fewer at .1, and 150 drawn planes of all
 * tilts as without; at .2 one of dots is not. */
#define LEVEL_FAVOUR .15
/* Without lines level ceilings are so much less believed: right above the view's height never. At
 * .4 a meadow that is blurred behind a penguin is one. */
#define CEILING_DOUBT .5
/* What by chance is read wrongly is seldom level: so much of the doubt goes, if anything at all
 * tells the plane, and in full where this share of the cells lies on it, or lines tell it. Of
 * photos held upright; of those upside down half are then trusted floors. */
#define LEVEL_TRUST .53
#define LEAST_TOLD .05
#define LEVEL_SHARE .27
/* From where to where it counts how little a plane explains. Of drawn planes right ones of more
 * than 60 degrees cost at most .89 of the frontal one (pebbles in photos, too), wrong ones .88 to
 * .97, read as 75 and more. */
#define RATHER_STEEP_DEG 60
#define STEEP_DEG 75
/* Where a point is meant: from the first of these parts of the frontal plane's cost beside it on
 * what lies there speaks against the best plane more and more, from the second on in full. */
#define EXPLAINED .88
#define HARDLY_EXPLAINED .92
/* And from where to where a steep one is doubted, for it explains nothing there. */
#define NOT_BETTER .97
#define WORSE 1.01
/* That tells where the plane's scale differs by so much beside the point, or where it costs even
 * more: among pebbles in the foreground by .27 to .56, and it costs .93 to 1.01 of the frontal one.
 */
#define ALIKE_OCTAVES .35
#define UNLIKE_OCTAVES .6
#define COSTS_MORE 1.03
#define COSTS_MUCH_MORE 1.08

double rc_times_unlikely(const rc_point *p) {
  return rc_cost_of_ceiling(rc_lean_of(p)) - LEVEL_FAVOUR * rc_lean_level(rc_lean_of(p));
}

/* How far apart the parts of the picture, asked alone, read the plane. */
static double disagreement_deg(const rc_readings *s) {
  double square = 0;
  for (int i = 0; i < RC_PARTS; i++) {
    double apart = rc_lean_degrees(rc_lean_of(&s->best), rc_lean_of(&s->part[i]));
    square += apart * apart / RC_PARTS;
  }
  return sqrt(square);
}

static bool has_third(const rc_readings *s) { return s->points[2].support > 0; }

double rc_points_missed(const rc_readings *s, const double normal[3]) {
  double miss[RC_VANISHING_POINTS];
  for (int i = 0; i < RC_VANISHING_POINTS; i++)
    miss[i] = s->points[i].support * rc_missed(&s->points[i], normal);
  return has_third(s) ? miss[2] + fmin(miss[0], miss[1]) : miss[0] + miss[1];
}

static double told_by_two_points(const rc_readings *s, const rc_point *reading) {
  double n[3], told[RC_VANISHING_POINTS];
  rc_lean_normal(rc_lean_of(reading), n);
  for (int i = 0; i < RC_VANISHING_POINTS; i++)
    told[i] = s->points[i].support * (1 - rc_missed(&s->points[i], n));
  return has_third(s) ? fmin(told[2], fmax(told[0], told[1])) : fmin(told[0], told[1]);
}

/* How far what lies beside the point speaks against the best plane: not where lines tell it, as one
 * point in front does. */
static double against_beside(const rc_readings *s, double lines, double from, double to) {
  return rc_rising(s->beside.of_frontal, from, to) *
         fmax(rc_rising(s->beside.octaves, ALIKE_OCTAVES, UNLIKE_OCTAVES),
              rc_rising(s->beside.of_frontal, COSTS_MORE, COSTS_MUCH_MORE)) *
         (1 - fmin(1, lines / TOLD_BY_ONE_POINT));
}

/* The farthest other reading that explains the picture almost as well, and lines no worse. Where
 * what lies beside the hole is asked, and does not speak against the best, what is less likely must
 * explain more. */
static double ambiguity_deg(const rc_readings *s, double lines) {
  double farthest = 0, told = told_by_two_points(s, &s->best);
  double asked = s->placed ? 1 - against_beside(s, lines, EXPLAINED, HARDLY_EXPLAINED) : 0;
  for (int m = 0; m < RC_MODELS; m++)
    for (int i = 0; i < RC_STARTS; i++) {
      const rc_point *other = &s->closer[m][i];
      double more = rc_times_unlikely(other) / rc_times_unlikely(&s->best);
      if ((1 + asked * fmax(0, more - 1)) * other->cost >= ALMOST * s->best.cost ||
          told - told_by_two_points(s, other) > TOLD_SO_MUCH_BETTER)
        continue;
      farthest = fmax(farthest, rc_lean_degrees(rc_lean_of(&s->best), rc_lean_of(other)));
    }
  return farthest;
}

/* The share of cells, by weight, that lie on the plane. */
static double share_on_plane(const rc_readings *s) {
  const rc_homogeneity *h = &s->model[s->best_model];
  float *misfit = s->scratch + rc_homogeneity_scratch(h) / sizeof(float);
  double on = 0, all = 0;
  rc_homogeneity_cost(h, rc_lean_of(&s->best), s->scratch, misfit);
  for (int i = 0; i < h->spectra->count; i++) {
    double ratio = 2 * misfit[i] / h->saturation;
    all += s->weight[i];
    if (isfinite(misfit[i])) on += s->weight[i] / (1 + ratio * ratio);
  }
  return on / all;
}

/* How far lines alone tell the plane. */
static double told_by_lines(const rc_readings *s) {
  const rc_vanishing *one = &s->points[has_third(s) ? 2 : 0];
  double n[3];
  rc_lean_normal(rc_lean_of(&s->best), n);
  double told = one->support * (1 - rc_missed(one, n)) * fabs(one->direction[2]);
  return fmax(told_by_two_points(s, &s->best), TOLD_BY_ONE_POINT * told);
}

/* Whether the plane recedes far, and that explains hardly anything: 0..1. */
static double steep_for_little(const rc_readings *s, double lines) {
  double slant_deg = sqrt(s->best.x * s->best.x + s->best.y * s->best.y) * 180 / M_PI;
  return rc_rising(slant_deg, RATHER_STEEP_DEG, STEEP_DEG) *
         fmax(rc_explains_little(s->best.cost, s->frontal),
              against_beside(s, lines, NOT_BETTER, WORSE));
}

/* What is left unexplained must be small (a log2 power of 1 is a factor of two) and most cells must
 * lie on the plane, or lines must tell it; parts of the picture must say the same, and nothing else
 * may explain it as well. A level floor needs less of all that. A steep plane must explain much. */
double rc_trust(const rc_readings *s) {
  double lines = told_by_lines(s), left = s->best.cost * s->best.cost;
  double on_plane = share_on_plane(s) - NO_PLANE_SHARE;
  double share = fmin(1, fmax(0, on_plane / (PLANE_SHARE - NO_PLANE_SHARE)));
  double level_share = fmin(1, fmax(lines, on_plane / (LEVEL_SHARE - NO_PLANE_SHARE)));
  double doubt = CEILING_DOUBT * rc_lean_ceiling(rc_lean_of(&s->best));
  double texture = share * rc_falling(left, RC_LARGE_MISFIT * RC_LARGE_MISFIT) * (1 - doubt);
  double told = (1 - (1 - texture) * (1 - lines)) *
                rc_falling(disagreement_deg(s), LARGE_DISAGREEMENT_DEG) *
                rc_falling(ambiguity_deg(s, lines), LARGE_AMBIGUITY_DEG);
  double trust =
      LEVEL_TRUST * rc_lean_level(rc_lean_of(&s->best)) * level_share * fmin(1, told / LEAST_TOLD);
  return (1 - (1 - told) * (1 - trust)) * (1 - RC_DOUBT * steep_for_little(s, lines));
}
