/* The cells around the hole mostly lie in the plane that it lies in. They are few, and tell a plane
 * less exactly than the whole picture does; but they tell whether its texture shrinks the way that
 * the picture's plane says. On a wall it shrinks towards another side. */
#include "plane/nearby.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "plane/belief.h"
#include "plane/simplex.h"

/* A cell weighs e^(-d^2 / 2) at a distance of d reaches. The reach is the least, from NEAREST to
 * FARTHEST of the picture's long side, with which the cells tell as much as ENOUGH_CELLS equal
 * ones: with 16 trusted pebbles were contradicted as much as some walls, with 32 a wall at the
 * picture's edge drowned in the floor. */
#define NEAREST .06
#define FARTHEST .2
#define FARTHER 1.1
#define ENOUGH_CELLS 24
#define LEAST_CELLS 12
#define LEAST_WEIGHT .02f
/* The best coarse orientations that are looked at closer. */
#define STARTS 4
#define CLOSER_STEPS 60
#define FIRST_SIZE .06
#define TOLERANCE .002

/* How many times what the plane read nearby costs the picture's plane costs there: from the first
 * on it is doubted, and given up where the other is surer; from the second on it is in any case.
 * Where it is right: at most 1.08 in drawn pictures, 1.15 in photos. Where it was trusted, a
 * floor's, and the hole in a wall: median 2.0, but 1.12 to 1.21 at the very edge of the picture, on
 * a roof among others 1.0 to 1.2. */
#define DOUBTED 1.16
#define GIVEN_UP 1.28
/* Nearer planes are the same, less exactly read: boards alone are up to 18 degrees off. */
#define ANOTHER_PLANE_DEG 25
#define LEAST_COST 1e-3
/* Another reading that costs no more than this tells against both; halves the confidence. */
#define ALMOST 1.06
#define LARGE_AMBIGUITY_DEG 20
/* So few cells are soon explained by some plane. Of another one than the picture's more is asked:
 * that it explains more than the frontal one there unless it hardly leans, and that a steep one is
 * an upright wall or a level floor, as those are that a picture has beside its plane. Of holes in
 * drawn walls and floors right ones that lean by more than 15 degrees cost at most .78, a wall of
 * dots .89, and their normals lie by at most .10 to the side and upwards both; of holes laid by
 * chance in photos (nebulas, palms, yellow paper) wrong ones cost .92 to .97 or lie by .45 to .57
 * both. */
#define HARDLY_LEANS_DEG 15
#define LEANS_DEG 25
#define UPRIGHT_OR_LEVEL .2
#define NEITHER .4
#define RATHER_STEEP_DEG 50
#define STEEP_DEG 60

typedef struct nearby {
  rc_homogeneity h; /* of the cells that weigh something */
  rc_spectra cells;
  float *weight, *scratch; /* one scratch a thread */
  size_t scratch_size;
  rc_point coarse[RC_COARSE_LEANS], closer[STARTS];
} nearby;

typedef struct objective {
  const rc_homogeneity *h;
  float *scratch;
} objective;

static double cost_of(void *user, double across, double along) {
  const objective *o = user;
  return rc_homogeneity_cost(o->h, (rc_lean){across, along}, o->scratch, NULL);
}

static objective objective_of(const nearby *n, int thread) {
  return (objective){&n->h, n->scratch + n->scratch_size * (size_t)thread};
}

static void look(void *user, int item, int thread) {
  nearby *n = user;
  rc_lean lean = rc_coarse_lean(item);
  objective o = objective_of(n, thread);
  n->coarse[item] = (rc_point){lean.across, lean.along, cost_of(&o, lean.across, lean.along)};
}

static void look_closer(void *user, int item, int thread) {
  nearby *n = user;
  const rc_point *from = &n->coarse[item];
  objective o = objective_of(n, thread);
  rc_point *to = &n->closer[item];
  *to = rc_simplex(cost_of, &o, from->x, from->y, FIRST_SIZE, TOLERANCE, CLOSER_STEPS);
  to->cost *= rc_cost_of_ceiling((rc_lean){to->x, to->y});
}

/* Returns how many equal cells would tell as much. */
static double weigh(const rc_homogeneity *all, double reach, float *weight) {
  double sum = 0, square = 1e-9;
  for (int i = 0; i < all->spectra->count; i++) {
    double x = (all->spectra->x[i] - all->ref_x) / reach;
    double y = (all->spectra->y[i] - all->ref_y) / reach;
    weight[i] = (float)exp(-.5 * (x * x + y * y));
    if (weight[i] < LEAST_WEIGHT) weight[i] = 0;
    sum += weight[i];
    square += (double)weight[i] * (double)weight[i];
  }
  return sum * sum / square;
}

static double weigh_nearest(const rc_homogeneity *all, float *weight) {
  double longest = all->width > all->height ? all->width : all->height, cells = 0;
  for (double reach = NEAREST; reach < FARTHEST && cells < ENOUGH_CELLS; reach *= FARTHER)
    cells = weigh(all, reach * longest, weight);
  return cells;
}

/* Leaves the cells without weight behind. */
static recede_status keep_cells(rc_context *context, nearby *n, const rc_homogeneity *all) {
  const rc_spectra *from = all->spectra;
  rc_spectra *to = &n->cells;
  size_t kept = 0;
  for (int i = 0; i < from->count; i++) kept += n->weight[i] > 0 ? 1 : 0;
  RC_TRY(RC_NEW(context, kept, &to->x));
  RC_TRY(RC_NEW(context, kept, &to->y));
  RC_TRY(RC_NEW(context, kept, &to->power));
  for (int i = 0; i < from->count; i++) {
    if (n->weight[i] == 0) continue;
    to->x[to->count] = from->x[i], to->y[to->count] = from->y[i];
    memcpy(&to->power[to->count], &from->power[i], sizeof to->power[0]);
    n->weight[to->count++] = n->weight[i];
  }
  n->h = *all;
  n->h.spectra = to, n->h.weight = n->weight;
  n->scratch_size = (rc_homogeneity_scratch(&n->h) / sizeof(float) + 15) / 16 * 16;
  return RC_NEW(context, n->scratch_size * (size_t)context->threads, &n->scratch);
}

/* NULL: they are too few. */
static recede_status gather(rc_context *context, const rc_homogeneity *all, nearby **to) {
  nearby *n;
  *to = NULL;
  RC_TRY(RC_NEW_ZERO(context, 1, &n));
  RC_TRY(RC_NEW(context, all->spectra->count, &n->weight));
  if (weigh_nearest(all, n->weight) < LEAST_CELLS) return RECEDE_OK;
  RC_TRY(keep_cells(context, n, all));
  *to = n;
  return RECEDE_OK;
}

/* The farthest other reading that explains the cells almost as well. */
static double ambiguity_deg(const nearby *n) {
  double farthest = 0;
  const rc_point *best = &n->closer[0];
  for (int i = 1; i < STARTS; i++)
    if (n->closer[i].cost < ALMOST * best->cost)
      farthest = fmax(farthest, rc_lean_degrees((rc_lean){best->x, best->y},
                                                (rc_lean){n->closer[i].x, n->closer[i].y}));
  return farthest;
}

/* Whether the plane read nearby is one that chance reads there: 0..1. */
static double by_chance(const nearby *n, rc_lean lean) {
  objective o = objective_of(n, 0);
  double normal[3], frontal = fmax(cost_of(&o, 0, 0), LEAST_COST);
  rc_lean_normal(lean, normal);
  double slant_deg = acos(fmin(1, fmax(-1, normal[2]))) * (180 / M_PI);
  double little = rc_explains_little(n->closer[0].cost, frontal);
  double neither = rc_rising(fmin(fabs(normal[0]), fabs(normal[1])), UPRIGHT_OR_LEVEL, NEITHER);
  return fmax(little * rc_rising(slant_deg, HARDLY_LEANS_DEG, LEANS_DEG),
              neither * rc_rising(slant_deg, RATHER_STEEP_DEG, STEEP_DEG));
}

/* Between the planes, whichever side is seen. */
static double apart_deg(rc_lean a, rc_lean b) {
  double degrees = rc_lean_degrees(a, b);
  return fmin(degrees, 180 - degrees);
}

static void correct(const nearby *n, bool picture_raised, rc_lean *lean, double *confidence) {
  const rc_point *best = &n->closer[0];
  rc_lean found = {best->x, best->y};
  rc_homogeneity own = n->h;
  own.raised = picture_raised;
  objective o = {&own, n->scratch};
  /* Else nothing is known of the cells nearby: trusted walls stay below it, and lanes of a
   * motorway, of which no plane makes one texture, begin at 1.8. */
  if (best->cost > RC_LARGE_MISFIT || apart_deg(*lean, found) < ANOTHER_PLANE_DEG) return;
  double times = cost_of(&o, lean->across, lean->along) / fmax(best->cost, LEAST_COST);
  if (times < DOUBTED) return;
  double surely = rc_falling(best->cost * best->cost, RC_LARGE_MISFIT * RC_LARGE_MISFIT) *
                  rc_falling(ambiguity_deg(n), LARGE_AMBIGUITY_DEG) *
                  (1 - RC_DOUBT * by_chance(n, found));
  *confidence *= fmax(0, (GIVEN_UP - times) / (GIVEN_UP - DOUBTED));
  if (surely <= *confidence) return;
  *confidence = surely;
  *lean = found;
}

/* The standard deviation of the plane's scale among the cells that it is compared in. */
static double octaves_of(const rc_homogeneity *h, rc_lean lean) {
  recede_plane plane = {.width = h->width, .height = h->height, .focal_px = h->focal_px};
  rc_lean_normal(lean, plane.normal);
  double at_reference = recede_plane_w(&plane, h->ref_x, h->ref_y);
  double all = 1e-9, sum = 0, square = 0;
  for (int i = 0; i < h->spectra->count; i++) {
    double w = recede_plane_w(&plane, h->spectra->x[i], h->spectra->y[i]) / at_reference;
    if (w < RC_RESOLVED_W) continue;
    double weight = h->weight[i], octave = log2(w);
    all += weight, sum += weight * octave, square += weight * octave * octave;
  }
  return sqrt(fmax(0, square / all - sum / all * (sum / all)));
}

recede_status rc_nearby_ask(rc_context *context, const rc_homogeneity *picture, rc_lean lean,
                            rc_beside *beside) {
  rc_block *mark = rc_mark(context);
  nearby *n;
  *beside = (rc_beside){1, 0};
  RC_TRY(gather(context, picture, &n));
  if (n) {
    objective o = objective_of(n, 0);
    double cost = cost_of(&o, lean.across, lean.along), frontal = cost_of(&o, 0, 0);
    if (cost < RC_IMPOSSIBLE && frontal < RC_IMPOSSIBLE)
      *beside = (rc_beside){cost / fmax(frontal, LEAST_COST), octaves_of(&n->h, lean)};
  }
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_nearby_correct(rc_context *context, const rc_homogeneity *flat, bool raised,
                                rc_lean *lean, double *confidence) {
  rc_block *mark = rc_mark(context);
  nearby *n;
  RC_TRY(gather(context, flat, &n));
  if (n) {
    RC_TRY(rc_parallel(context, RC_COARSE_LEANS, look, n));
    rc_points_to_front(n->coarse, RC_COARSE_LEANS, STARTS);
    RC_TRY(rc_parallel(context, STARTS, look_closer, n));
    rc_points_to_front(n->closer, STARTS, STARTS);
    correct(n, raised, lean, confidence);
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
