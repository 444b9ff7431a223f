/* The search for the plane: a coarse look at all orientations, a closer one at the best, for
 * textures that lie flat and for those that stand up from the plane; then how far the answer can be
 * trusted. */
#include "plane/estimate.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "plane/belief.h"
#include "plane/homogeneity.h"
#include "plane/nearby.h"
#include "plane/simplex.h"
#include "plane/vanishing.h"

/* The best coarse orientations that are looked at closer, for each of the two models. */
#define STARTS 4
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
#define AGREED_DEG 10
#define MOST_OF_AGREED 1.05
/* Long straight lines lie flat. */
#define RAISED_LINES_COST .1
/* Weight of a cell by its distance from the point that is meant: 1 / (1 + (d / reach)^2), never
 * less than a tenth: what is far still tells where other planes do not begin. */
#define REACH .15
#define FAR_WEIGHT .1
/* Sources that are less than this part of all that is known were chosen. */
#define MOST_CHOSEN .7

/* Each of these two halves the confidence, as a large misfit does unless lines tell the plane;
 * measured on drawn cases, where errors above 8 degrees began at a disagreement of 3, and on photos
 * of several planes (7 and more, a quarter of the cells on the plane). */
#define LARGE_DISAGREEMENT_DEG 7
#define LARGE_AMBIGUITY_DEG 40
#define ALMOST 1.03
#define NO_PLANE_SHARE .2
#define PLANE_SHARE .5
/* Two vanishing points tell a plane whatever lies around it. One, in front, tells this much: roads
 * have but one. Of two that are both farther than about 75 degrees from the view axis one is often
 * not the plane's: boards run across, and posts stand on them. */
#define TOLD_BY_ONE_POINT .6
/* A reading that misses one of two points, and the best holds both, is no other reading. */
#define TOLD_SO_MUCH_BETTER .5
#define FAR_POINT .25

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
#define POINT_REACH .06
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

enum { FLAT, RAISED, MODELS };

/* Parts of the picture that are asked again on their own: four halves and two chequers. */
#define PARTS 6

typedef struct search {
  bool placed; /* a point is meant, and what lies beside it is asked, too */
  rc_homogeneity model[MODELS];
  rc_vanishing points[RC_VANISHING_POINTS]; /* support: 0..1, how far it counts */
  float *weight;
  float *scratch; /* one a thread */
  size_t scratch_size;
  rc_point coarse[MODELS][COARSE], closer[MODELS][STARTS], part[PARTS];
  int best_model;
  rc_point best;
} search;

typedef struct objective {
  const search *s;
  const rc_homogeneity *h;
  float *scratch;
} objective;

static float *scratch_of(const search *s, int thread) {
  return s->scratch + s->scratch_size * (size_t)thread;
}

static rc_lean lean_of(const rc_point *p) { return (rc_lean){p->x, p->y}; }

/* 0: the plane holds the point; 1: it is far from that. */
static double missed(const rc_vanishing *point, const double normal[3]) {
  const double *v = point->direction;
  double miss = (normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2]) / POINT_REACH;
  return miss * miss / (1 + miss * miss);
}

static double cost_of_missing_points(const search *s, rc_lean lean) {
  double n[3], cost = 1;
  rc_lean_normal(lean, n);
  for (int i = 0; i < RC_VANISHING_POINTS; i++)
    cost += MISSING_POINT_COST * s->points[i].support * missed(&s->points[i], n);
  return cost;
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
                     : rc_lean_holding(s->points[fan / FAN].direction, fan % FAN * (M_PI / FAN));
  return (rc_point){lean.across, lean.along, 0};
}

static void look(void *user, int item, int thread) {
  search *s = user;
  int i = item % COARSE;
  rc_point *p = &s->coarse[item / COARSE][i];
  objective o = {s, &s->model[item / COARSE], scratch_of(s, thread)};
  *p = coarse_point(s, i);
  bool skipped = i >= GRID && s->points[(i - GRID) / FAN].support == 0;
  p->cost = skipped ? INFINITY : cost_of(&o, p->x, p->y);
}

static void look_closer(void *user, int item, int thread) {
  search *s = user;
  objective o = {s, &s->model[item / STARTS], scratch_of(s, thread)};
  const rc_point *from = &s->coarse[item / STARTS][item % STARTS];
  s->closer[item / STARTS][item % STARTS] =
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
  rc_homogeneity part = s->model[s->best_model];
  float *weight = scratch_of(s, thread) + rc_homogeneity_scratch(&part) / sizeof(float);
  objective o = {s, &part, scratch_of(s, thread)};
  for (int i = 0; i < part.spectra->count; i++) {
    bool in = in_part(item, part.spectra->x[i] / (float)part.width,
                      part.spectra->y[i] / (float)part.height);
    weight[i] = s->weight[i] * (in ? 1 : item < 4 ? .3f : 0);
  }
  part.weight = weight;
  s->part[item] =
      rc_simplex(cost_of, &o, s->best.x, s->best.y, FIRST_SIZE, TOLERANCE, CLOSER_STEPS);
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
  rc_homogeneity *h = &s->model[FLAT];
  size_t count = (size_t)spectra->count;
  s->placed = on && !chosen;
  h->spectra = spectra;
  h->chosen = chosen;
  h->width = frontal->width, h->height = frontal->height;
  h->focal_px = frontal->focal_px;
  RC_TRY(RC_NEW(context, count, &s->weight));
  weigh_cells(h, on, s->weight);
  s->scratch_size = (rc_homogeneity_scratch(h) / sizeof(float) + count + 15) / 16 * 16;
  RC_TRY(RC_NEW(context, s->scratch_size * (size_t)context->threads, &s->scratch));
  RC_TRY(rc_homogeneity_saturate(context, h, s->scratch));
  s->model[RAISED] = *h;
  s->model[RAISED].raised = true;
  return RECEDE_OK;
}

/* The less, the likelier such a plane is in a picture, whatever this one shows. */
static double times_unlikely(const rc_point *p) {
  return rc_cost_of_ceiling(lean_of(p)) - LEVEL_FAVOUR * rc_lean_level(lean_of(p));
}

static double cost_among_readings(const rc_point *p) { return p->cost * times_unlikely(p); }

/* Those to look at closer; the last is the likeliest of the others, which may be a level floor. */
static void take_starts(rc_point coarse[COARSE]) {
  int likely = STARTS - 1;
  rc_points_to_front(coarse, COARSE, STARTS - 1);
  for (int i = STARTS; i < COARSE; i++)
    if (cost_among_readings(&coarse[i]) < cost_among_readings(&coarse[likely])) likely = i;
  rc_point last = coarse[STARTS - 1];
  coarse[STARTS - 1] = coarse[likely];
  coarse[likely] = last;
}

/* The least cost of a model all whose starts lead to one plane; of a ceiling more. */
static double cost_agreed_on(const search *s, int model) {
  const rc_point *p = s->closer[model];
  int best = 0;
  for (int i = 1; i < STARTS; i++)
    if (p[i].cost < p[best].cost) best = i;
  for (int i = 0; i < STARTS; i++)
    if (rc_lean_degrees(lean_of(&p[best]), lean_of(&p[i])) > AGREED_DEG) return INFINITY;
  return p[best].cost * fmax(1, times_unlikely(&p[best]));
}

/* The reading of least cost of those that explain more than the frontal plane does, with a little
 * favour for raised textures and more against raised textures of straight lines. */
static void choose(search *s, double frontal) {
  double least = INFINITY, lines = fmax(s->points[0].support, s->points[1].support);
  s->best = (rc_point){0, 0, frontal};
  for (int m = 0; m < MODELS; m++) {
    double agreed = cost_agreed_on(s, MODELS - 1 - m);
    for (int i = 0; i < STARTS; i++) {
      const rc_point *p = &s->closer[m][i];
      if (p->cost > MOST_OF_AGREED * agreed) continue;
      double cost = cost_among_readings(p);
      if (m == RAISED) cost *= lines > 0 ? 1 + RAISED_LINES_COST * lines : 1 / RAISED_FAVOUR;
      if (cost >= least || p->cost > (1 - LEAST_GAIN) * frontal) continue;
      least = cost;
      s->best_model = m;
      s->best = *p;
    }
  }
}

/* Looks for lines; a point's support becomes how far it counts. */
static recede_status find_points(rc_context *context, search *s, const rc_image *image,
                                 const rc_mask *flags, const double on[2]) {
  int count;
  RC_TRY(rc_vanishing_find(context, image, flags, s->model[FLAT].focal_px, on, s->points, &count));
  for (int i = 0; i < RC_VANISHING_POINTS; i++) {
    double counts = (s->points[i].support - LEAST_SUPPORT) / (FULL_SUPPORT - LEAST_SUPPORT);
    s->points[i].support = i < count ? fmin(1, fmax(0, counts)) : 0;
  }
  if (fabs(s->points[0].direction[2]) < FAR_POINT && fabs(s->points[1].direction[2]) < FAR_POINT)
    s->points[1].support = 0;
  return RECEDE_OK;
}

static recede_status find_best(rc_context *context, search *s) {
  RC_TRY(rc_parallel(context, MODELS * COARSE, look, s));
  double frontal = s->coarse[FLAT][0].cost;
  for (int m = 0; m < MODELS; m++) take_starts(s->coarse[m]);
  RC_TRY(rc_parallel(context, MODELS * STARTS, look_closer, s));
  choose(s, frontal);
  return RECEDE_OK;
}

/* How far apart the parts of the picture, asked alone, read the plane. */
static double disagreement_deg(const search *s) {
  double square = 0;
  for (int i = 0; i < PARTS; i++) {
    double apart = rc_lean_degrees(lean_of(&s->best), lean_of(&s->part[i]));
    square += apart * apart / PARTS;
  }
  return sqrt(square);
}

static double told_by_two_points(const search *s, const rc_point *reading) {
  double n[3], told = 1;
  rc_lean_normal(lean_of(reading), n);
  for (int i = 0; i < RC_VANISHING_POINTS; i++)
    told = fmin(told, s->points[i].support * (1 - missed(&s->points[i], n)));
  return told;
}

/* The farthest other reading that explains the picture almost as well, and lines no worse. Where
 * what lies beside the hole is asked, what is less likely than the best must explain more. */
static double ambiguity_deg(const search *s) {
  double farthest = 0, told = told_by_two_points(s, &s->best);
  for (int m = 0; m < MODELS; m++)
    for (int i = 0; i < STARTS; i++) {
      const rc_point *other = &s->closer[m][i];
      double more = times_unlikely(other) / times_unlikely(&s->best);
      if ((s->placed ? fmax(1, more) : 1) * other->cost >= ALMOST * s->best.cost ||
          told - told_by_two_points(s, other) > TOLD_SO_MUCH_BETTER)
        continue;
      farthest = fmax(farthest, rc_lean_degrees(lean_of(&s->best), lean_of(other)));
    }
  return farthest;
}

/* The share of cells, by weight, that lie on the plane. */
static double share_on_plane(const search *s) {
  const rc_homogeneity *h = &s->model[s->best_model];
  float *misfit = s->scratch + rc_homogeneity_scratch(h) / sizeof(float);
  double on = 0, all = 0;
  rc_homogeneity_cost(h, lean_of(&s->best), s->scratch, misfit);
  for (int i = 0; i < h->spectra->count; i++) {
    double ratio = 2 * misfit[i] / h->saturation;
    all += s->weight[i];
    if (isfinite(misfit[i])) on += s->weight[i] / (1 + ratio * ratio);
  }
  return on / all;
}

/* How far lines alone tell the plane. */
static double told_by_lines(const search *s) {
  const rc_vanishing *first = &s->points[0];
  double n[3];
  rc_lean_normal(lean_of(&s->best), n);
  double first_told = first->support * (1 - missed(first, n));
  return fmax(told_by_two_points(s, &s->best),
              TOLD_BY_ONE_POINT * first_told * fabs(first->direction[2]));
}

/* What is left unexplained must be small (a log2 power of 1 is a factor of two) and most cells must
 * lie on the plane, or lines must tell it; parts of the picture must say the same, and nothing else
 * may explain it as well. A level floor needs less of all that. */
static double judge(const search *s) {
  double lines = told_by_lines(s), left = s->best.cost * s->best.cost;
  double on_plane = share_on_plane(s) - NO_PLANE_SHARE;
  double share = fmin(1, fmax(0, on_plane / (PLANE_SHARE - NO_PLANE_SHARE)));
  double level_share = fmin(1, fmax(lines, on_plane / (LEVEL_SHARE - NO_PLANE_SHARE)));
  double doubt = CEILING_DOUBT * rc_lean_ceiling(lean_of(&s->best));
  double texture = share * rc_falling(left, RC_LARGE_MISFIT * RC_LARGE_MISFIT) * (1 - doubt);
  double told = (1 - (1 - texture) * (1 - lines)) *
                rc_falling(disagreement_deg(s), LARGE_DISAGREEMENT_DEG) *
                rc_falling(ambiguity_deg(s), LARGE_AMBIGUITY_DEG);
  double trust =
      LEVEL_TRUST * rc_lean_level(lean_of(&s->best)) * level_share * fmin(1, told / LEAST_TOLD);
  return 1 - (1 - told) * (1 - trust);
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
  RC_TRY(rc_parallel(context, PARTS, ask_part, s));
  rc_lean lean = lean_of(&s->best);
  *confidence = judge(s);
  if (on && !s->model[FLAT].chosen) /* else all of it is said to lie on the plane */
    RC_TRY(rc_nearby_correct(context, &s->model[FLAT], s->best_model == RAISED, &lean, confidence));
  rc_lean_normal(lean, plane->normal);
  rc_release(context, mark);
  return RECEDE_OK;
}
