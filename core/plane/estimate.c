/* The search for the plane: a coarse look at all orientations, a closer one at the best, for
 * textures that lie flat and for those that stand up from the plane. */
#include "plane/estimate.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "plane/belief.h"
#include "plane/beyond.h"
#include "plane/nearby.h"
#include "plane/readings.h"

#define CLOSER_STEPS 60
#define FIRST_SIZE .06
#define TOLERANCE .002
/* Fewer cells tell no plane. */
#define LEAST_CELLS 12
/* A slant must explain this share of the frontal plane's misfit, else it is noise. */
#define LEAST_GAIN .03
/* Near-ties: on flat textures of slant >= 12 the flat model was always ahead by 3.5 % or more, on a
 * pebble beach the raised one by about nothing, and right. */
#define RAISED_FAVOUR 1.02
/* Where all starts of one model lead to one plane, what the other reads must not explain less by so
 * much, however likely: drawn lawns and rocks 1.07 to 1.17, read as chance floors; pebble beaches,
 * which are raised floors, at most 1.03. */
#define AGREED_DEG 15
#define MOST_OF_AGREED 1.05
/* Long straight lines lie flat. */
#define RAISED_LINES_COST .1
/* Weight of a cell by its distance from the point that is meant: 1 / (1 + (d / reach)^2), never
 * less than a tenth: what is far still tells where other planes do not begin. */
#define REACH .15
#define FAR_WEIGHT .1
/* Sources that are less than this part of all that is known were chosen. */
#define MOST_CHOSEN .7

/* Of two points that are both farther than about 75 degrees from the view axis one is often not the
 * plane's: boards run across, and posts stand on them. A third, in front, tells it with either. */
#define FAR_POINT .25

/* Where what lies around a hole beyond the horizon is like what lies before it: from the first of
 * these parts on the horizon is doubted, from the second on nothing is believed. Of roads, piers,
 * dunes and meadows 0 to .43, a wall above a road .5; where sand or a table went on behind a wrong
 * one .98 and more. */
#define SOME_ALIKE .8
#define ALL_ALIKE .95
#define DOUBT_OF_ALIKE .6

#define GRID RC_COARSE_LEANS
/* Planes whose horizons pass through a vanishing point. */
#define FAN 24
#define COARSE (GRID + RC_VANISHING_POINTS * FAN)

/* Support from which on a vanishing point counts, and counts fully. Stones and grass reach .14, .27
 * where a few segments beside the hole weigh most, tea bushes .3 to .46; tiles, planks and lanes
 * .42 to .94. */
#define LEAST_SUPPORT .3
#define FULL_SUPPORT .6
/* What missing one costs at the most, as a share of the misfit, half of it at 3.5 degrees. A whole
 * share did no better where lines are right, and let false points win over good spectra. */
#define MISSING_POINT_COST .3

typedef struct search {
  rc_readings r;
  size_t scratch_size;
  rc_point coarse[RC_MODELS][COARSE];
} search;

typedef struct objective {
  const search *s;
  const rc_homogeneity *h;
  float *scratch;
} objective;

static float *scratch_of(const search *s, int thread) {
  return s->r.scratch + s->scratch_size * (size_t)thread;
}

static double cost_of_missing_points(const search *s, rc_lean lean) {
  double n[3];
  rc_lean_normal(lean, n);
  return 1 + MISSING_POINT_COST * rc_points_missed(&s->r, n);
}

static double cost_of(void *user, double across, double along) {
  const objective *o = user;
  rc_lean lean = {across, along};
  return rc_homogeneity_cost(o->h, lean, o->scratch, NULL) * cost_of_missing_points(o->s, lean);
}

static rc_point coarse_point(const search *s, int i) {
  int fan = i - GRID;
  rc_lean lean = fan < 0
                     ? rc_coarse_lean(i)
                     : rc_lean_holding(s->r.points[fan / FAN].direction, fan % FAN * (M_PI / FAN));
  return (rc_point){lean.across, lean.along, 0};
}

static void look(void *user, int item, int thread) {
  search *s = user;
  int i = item % COARSE;
  rc_point *p = &s->coarse[item / COARSE][i];
  objective o = {s, &s->r.model[item / COARSE], scratch_of(s, thread)};
  *p = coarse_point(s, i);
  bool skipped = i >= GRID && s->r.points[(i - GRID) / FAN].support == 0;
  p->cost = skipped ? INFINITY : cost_of(&o, p->x, p->y);
}

static void look_closer(void *user, int item, int thread) {
  search *s = user;
  objective o = {s, &s->r.model[item / RC_STARTS], scratch_of(s, thread)};
  const rc_point *from = &s->coarse[item / RC_STARTS][item % RC_STARTS];
  s->r.closer[item / RC_STARTS][item % RC_STARTS] =
      rc_simplex(cost_of, &o, from->x, from->y, FIRST_SIZE, TOLERANCE, CLOSER_STEPS);
}

static bool in_part(int part, float x, float y) {
  switch (part) {
    case 0: return x < .5f;
    case 1: return x >= .5f;
    case 2: return y < .5f;
    case 3: return y >= .5f;
    default: return ((int)(4 * x) + (int)(4 * y)) % 2 == part - 4;
  }
}

/* Asks one part alone; the rest keeps a little weight where a half alone would be too small. */
static void ask_part(void *user, int item, int thread) {
  search *s = user;
  rc_homogeneity part = s->r.model[s->r.best_model];
  float *weight = scratch_of(s, thread) + rc_homogeneity_scratch(&part) / sizeof(float);
  objective o = {s, &part, scratch_of(s, thread)};
  for (int i = 0; i < part.spectra->count; i++) {
    bool in = in_part(item, part.spectra->x[i] / (float)part.width,
                      part.spectra->y[i] / (float)part.height);
    weight[i] = s->r.weight[i] * (in ? 1 : item < 4 ? .3f : 0);
  }
  part.weight = weight;
  s->r.part[item] =
      rc_simplex(cost_of, &o, s->r.best.x, s->r.best.y, FIRST_SIZE, TOLERANCE, CLOSER_STEPS);
}

static void weigh_cells(rc_homogeneity *h, const double on[2], float *weight) {
  const rc_spectra *spectra = h->spectra;
  double reach = REACH * (h->width > h->height ? h->width : h->height);
  for (int i = 0; i < spectra->count; i++) {
    h->ref_x += (double)spectra->x[i] / spectra->count;
    h->ref_y += (double)spectra->y[i] / spectra->count;
    weight[i] = 1;
    if (!on) continue;
    double dx = (spectra->x[i] - on[0]) / reach, dy = (spectra->y[i] - on[1]) / reach;
    weight[i] = (float)(FAR_WEIGHT + (1 - FAR_WEIGHT) / (1 + dx * dx + dy * dy));
  }
  if (on) h->ref_x = on[0], h->ref_y = on[1];
  h->weight = weight;
}

/* A source mask may leave out no more than a dirty corner. */
bool rc_sources_are_chosen(const rc_mask *flags) {
  size_t sources = 0, known = 0;
  for (size_t i = 0; i < (size_t)flags->width * (size_t)flags->height; i++) {
    sources += flags->data[i] & RC_SOURCE ? 1 : 0;
    known += flags->data[i] & RC_KNOWN ? 1 : 0;
  }
  return (double)sources < MOST_CHOSEN * (double)known;
}

static recede_status set_up(rc_context *context, search *s, const rc_spectra *spectra,
                            const recede_plane *frontal, const double on[2], bool chosen) {
  rc_homogeneity *h = &s->r.model[RC_FLAT];
  size_t count = (size_t)spectra->count;
  s->r.placed = on && !chosen;
  h->spectra = spectra;
  h->chosen = chosen;
  h->width = frontal->width, h->height = frontal->height;
  h->focal_px = frontal->focal_px;
  RC_TRY(RC_NEW(context, count, &s->r.weight));
  weigh_cells(h, on, s->r.weight);
  s->scratch_size = (rc_homogeneity_scratch(h) / sizeof(float) + count + 15) / 16 * 16;
  RC_TRY(RC_NEW(context, s->scratch_size * (size_t)context->threads, &s->r.scratch));
  RC_TRY(rc_homogeneity_saturate(context, h, s->r.scratch));
  s->r.model[RC_RAISED] = *h;
  s->r.model[RC_RAISED].raised = true;
  return RECEDE_OK;
}

static double cost_among_readings(const rc_point *p) { return p->cost * rc_times_unlikely(p); }

/* Those to look at closer; the last is the likeliest of the others, which may be a level floor. */
static void take_starts(rc_point coarse[COARSE]) {
  int likely = RC_STARTS - 1;
  rc_points_to_front(coarse, COARSE, RC_STARTS - 1);
  for (int i = RC_STARTS; i < COARSE; i++)
    if (cost_among_readings(&coarse[i]) < cost_among_readings(&coarse[likely])) likely = i;
  rc_point last = coarse[RC_STARTS - 1];
  coarse[RC_STARTS - 1] = coarse[likely];
  coarse[likely] = last;
}

/* What a raised texture costs more where there are straight lines. */
static double times_for_lines(const search *s, int model) {
  double lines = fmax(s->r.points[0].support, s->r.points[1].support);
  return model == RC_RAISED ? 1 + RAISED_LINES_COST * lines : 1;
}

/* The least cost of a model all whose starts lead to one plane; of a ceiling more. */
static double cost_agreed_on(const search *s, int model) {
  const rc_point *p = s->r.closer[model];
  int best = 0;
  for (int i = 1; i < RC_STARTS; i++)
    if (p[i].cost < p[best].cost) best = i;
  for (int i = 0; i < RC_STARTS; i++)
    if (rc_lean_degrees(rc_lean_of(&p[best]), rc_lean_of(&p[i])) > AGREED_DEG) return INFINITY;
  return p[best].cost * times_for_lines(s, model) * fmax(1, rc_times_unlikely(&p[best]));
}

/* The reading of least cost of those that explain more than the frontal plane does, with a little
 * favour for raised textures and more against raised textures of straight lines. */
static void choose(search *s) {
  double least = INFINITY;
  s->r.best = (rc_point){0, 0, s->r.frontal};
  for (int m = 0; m < RC_MODELS; m++) {
    double agreed = cost_agreed_on(s, RC_MODELS - 1 - m), lines = times_for_lines(s, m);
    for (int i = 0; i < RC_STARTS; i++) {
      const rc_point *p = &s->r.closer[m][i];
      double cost = cost_among_readings(p) * lines;
      if (m == RC_RAISED && lines == 1) cost /= RAISED_FAVOUR;
      if (cost >= least || p->cost > (1 - LEAST_GAIN) * s->r.frontal ||
          p->cost * lines > MOST_OF_AGREED * agreed)
        continue;
      least = cost;
      s->r.best_model = m;
      s->r.best = *p;
    }
  }
}

static bool is_far(const rc_vanishing *point) { return fabs(point->direction[2]) < FAR_POINT; }

/* Looks for lines; a point's support becomes how far it counts. */
static recede_status find_points(rc_context *context, search *s, const rc_image *image,
                                 const rc_mask *flags, const double on[2]) {
  int count;
  RC_TRY(rc_vanishing_find(context, image, flags, s->r.model[RC_FLAT].focal_px, on, s->r.points,
                           &count));
  for (int i = 0; i < RC_VANISHING_POINTS; i++) {
    double counts = (s->r.points[i].support - LEAST_SUPPORT) / (FULL_SUPPORT - LEAST_SUPPORT);
    s->r.points[i].support = i < count ? fmin(1, fmax(0, counts)) : 0;
  }
  bool both_far = is_far(&s->r.points[0]) && is_far(&s->r.points[1]);
  if (!both_far || is_far(&s->r.points[2])) s->r.points[2].support = 0;
  if (both_far && s->r.points[2].support == 0) s->r.points[1].support = 0;
  return RECEDE_OK;
}

static recede_status find_best(rc_context *context, search *s) {
  RC_TRY(rc_parallel(context, RC_MODELS * COARSE, look, s));
  s->r.frontal = s->coarse[RC_FLAT][0].cost;
  for (int m = 0; m < RC_MODELS; m++) take_starts(s->coarse[m]);
  RC_TRY(rc_parallel(context, RC_MODELS * RC_STARTS, look_closer, s));
  choose(s);
  return RECEDE_OK;
}

/* Of a hole that the horizon crosses, where sand goes on as sand. */
static recede_status doubt_horizon(rc_context *context, const rc_image *image, const rc_mask *flags,
                                   const recede_plane *plane, double *confidence) {
  double alike;
  RC_TRY(rc_alike_beyond(context, image, flags, plane, &alike));
  double doubt = (alike - SOME_ALIKE) / (ALL_ALIKE - SOME_ALIKE);
  *confidence *= 1 - DOUBT_OF_ALIKE * fmin(1, fmax(0, doubt));
  return RECEDE_OK;
}

recede_status rc_estimate_plane(rc_context *context, const rc_image *image, const rc_mask *flags,
                                double fov_deg, const double on[2], recede_plane *plane,
                                double *confidence) {
  rc_spectra spectra;
  search *s;
  rc_block *mark = rc_mark(context);
  RC_TRY(recede_plane_from_angles(image->width, image->height, 0, 0, fov_deg, plane));
  RC_TRY(rc_spectra_gather(context, image, flags, &spectra));
  if (spectra.count < LEAST_CELLS)
    return rc_fail(context, RECEDE_NO_PLANE,
                   "The picture has too little texture to read the plane's orientation from. Give "
                   "slant and tilt, or a horizon.");
  RC_TRY(RC_NEW_ZERO(context, 1, &s));
  RC_TRY(set_up(context, s, &spectra, plane, on, rc_sources_are_chosen(flags)));
  RC_TRY(find_points(context, s, image, flags, on));
  RC_TRY(find_best(context, s));
  RC_TRY(rc_parallel(context, RC_PARTS, ask_part, s));
  rc_lean lean = rc_lean_of(&s->r.best);
  if (s->r.placed) RC_TRY(rc_nearby_ask(context, &s->r.model[s->r.best_model], lean, &s->r.beside));
  *confidence = rc_trust(&s->r);
  if (s->r.placed) /* else all of it is said to lie on the plane */
    RC_TRY(rc_nearby_correct(context, &s->r.model[RC_FLAT], s->r.best_model == RC_RAISED, &lean,
                             confidence));
  rc_lean_normal(lean, plane->normal);
  if (s->r.placed) RC_TRY(doubt_horizon(context, image, flags, plane, confidence));
  rc_release(context, mark);
  return RECEDE_OK;
}
