/* Method plane: the only file that knows the order of the stages.
 * tone -> pyramid -> start -> (search <-> vote) per level, coarse to fine -> composition -> detail.
 */
#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/distance.h"
#include "image/pyramid.h"
#include "image/tone.h"
#include "synthesis/compose.h"
#include "synthesis/detail.h"
#include "synthesis/periods.h"
#include "synthesis/problem.h"
#include "synthesis/start.h"
#include "synthesis/surface.h"
#include "synthesis/vote.h"

#define MAX_LEVELS 10
/* The coarsest hole is at least this far across: one level too many breaks regular patterns. */
#define COARSEST_HOLE_PX 18
/* A coarser level has too few places for a patch that lies wholly in source. */
#define LEAST_LEVEL_PX 48
/* Each px deeper in the hole counts 1.3 times less; 1.15 is too trusting. */
#define CONFIDENCE_FALLOFF 1.3f
#define COHERENCE .03f
#define COHERENCE_OF_COMPOSITION .06f
#define PERIOD_TRIES 3
/* The surface is judged on a picture of about this width. */
#define SURFACE_LONGEST_PX 800
/* Raised only when it is certain: flat textures measure .3 .. 1.2 (their contrast within a texel
 * leans less than they do), stones and bushes 0 .. .2. With nothing to lean both maps are the same,
 * and the raised one keeps to whole pixels. */
#define LEAN_OF_RAISED .25
/* Bytes span this many standard deviations to each side. */
#define DEVIATIONS 4.f

/* What the quality levels change. */
typedef struct effort {
  int start_tries;       /* random candidates per pixel of the start */
  int coarse_iterations; /* at the coarsest level; half as many with each finer one */
  int fine_iterations;   /* but at least these */
  int finest_iterations; /* and these at the finest; 0: only takes the coarser copies over */
  int anywhere;          /* random candidates per pixel from all sources, coarsest level */
  int local_radius;      /* largest radius of the random candidates nearby, px */
} effort;

static const effort efforts[] = {
    [RECEDE_QUALITY_DRAFT] = {30, 6, 2, 0, 2, 8},
    [RECEDE_QUALITY_NORMAL] = {60, 12, 2, 2, 4, 16},
    [RECEDE_QUALITY_BEST] = {100, 24, 4, 4, 6, 16},
};
#define PASSES 2

typedef struct engine {
  const recede_params *params;
  const rc_kernels *kernels;
  effort effort;
  rc_chart chart; /* of the finest level */
  float gain;     /* of the bytes */
  int level_count;
  rc_image images[MAX_LEVELS];
  rc_mask flags[MAX_LEVELS];
  rc_copy periods[RC_MOST_PERIODS]; /* px of the coarsest level */
  int period_count;
} engine;

static rc_chart chart_of(const rc_problem *problem, bool raised) {
  const rc_line *line = &problem->line;
  double x0 = (problem->target.x0 + problem->target.x1 - 1) / 2.;
  double y0 = (problem->target.y0 + problem->target.y1 - 1) / 2.;
  double square = line->a * line->a + line->b * line->b, excess = rc_w(line, x0, y0) - 1;
  if (square > 1e-16) x0 -= excess * line->a / square, y0 -= excess * line->b / square;
  return (rc_chart){(float)line->a, (float)line->b, (float)x0, (float)y0, raised};
}

/* Twice the largest distance of a target pixel from its border. */
static recede_status hole_width(rc_context *context, const rc_mask *flags, int *width) {
  uint8_t *depth;
  int most = 0;
  size_t count = (size_t)flags->width * (size_t)flags->height;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &depth));
  rc_distance_inside(flags->data, RC_TARGET, flags->width, flags->height, false, depth);
  for (size_t i = 0; i < count; i++) most = depth[i] > most ? depth[i] : most;
  *width = 2 * most;
  rc_release(context, mark);
  return RECEDE_OK;
}

static recede_status build_pyramid(rc_context *context, const rc_problem *problem,
                                   rc_image *residual, engine *e) {
  int width;
  e->images[0] = *residual;
  e->flags[0] = problem->flags;
  e->level_count = 1;
  for (;;) {
    int last = e->level_count - 1;
    const rc_mask *flags = &e->flags[last];
    int shorter = flags->width < flags->height ? flags->width : flags->height;
    if (shorter / 2 < LEAST_LEVEL_PX) return RECEDE_OK;
    RC_TRY(hole_width(context, &e->flags[last], &width));
    if (width / 2 < COARSEST_HOLE_PX || e->level_count == MAX_LEVELS) return RECEDE_OK;
    RC_TRY(rc_half(context, &e->images[last], &e->flags[last], &e->images[last + 1],
                   &e->flags[last + 1]));
    e->level_count++;
  }
}

static float byte_gain(const rc_image *residual, const rc_mask *flags) {
  double square = 0, count = 0;
  size_t channels = (size_t)residual->channels;
  for (size_t i = 0; i < (size_t)residual->width * (size_t)residual->height; i++) {
    if (!(flags->data[i] & RC_SOURCE)) continue;
    for (size_t k = 0; k < channels; k++) {
      double v = residual->data[i * channels + k];
      square += v * v;
    }
    count += (double)channels;
  }
  double deviation = count > 0 ? sqrt(square / count) : 0;
  return deviation > 1e-9 ? (float)(127 / (DEVIATIONS * deviation)) : 1.f;
}

/* The coarse levels decide and cost next to nothing. */
static int iterations_at(const engine *e, int exponent) {
  const effort *by = &e->effort;
  int most = e->params->engine_iterations ? e->params->engine_iterations : by->coarse_iterations;
  int here = most >> (e->level_count - 1 - exponent);
  int least = exponent || e->level_count == 1 ? by->fine_iterations : by->finest_iterations;
  if (!exponent && e->level_count > 1) return least < most ? least : most;
  least = least < most ? least : most;
  return here > least ? here : least;
}

static rc_search search_of(const engine *e, int exponent, int iteration, int pass) {
  bool coarsest = exponent == e->level_count - 1;
  return (rc_search){.kernels = e->kernels,
                     .key = rc_key((uint64_t)e->params->seed, (uint32_t)exponent,
                                   (uint32_t)(iteration * PASSES + pass)),
                     .pass = pass,
                     .recost = pass == 0,
                     .coherence = e->params->engine_coherence ? COHERENCE : 0.f,
                     .local_radius = e->effort.local_radius,
                     .anywhere = coarsest ? e->effort.anywhere : 0,
                     .periods = e->periods,
                     .period_count = coarsest ? e->period_count : 0,
                     .period_tries = PERIOD_TRIES};
}

/* Propagation alone, with a higher price on incoherence: whole copies for the composition. */
static recede_status settle(rc_context *context, const engine *e, rc_level *level, rc_copy *old,
                            bool recost) {
  for (int pass = 0; pass < PASSES; pass++) {
    rc_search search = {.kernels = e->kernels,
                        .pass = pass,
                        .recost = recost && pass == 0,
                        .coherence = e->params->engine_coherence ? COHERENCE_OF_COMPOSITION : 0.f};
    RC_TRY(rc_search_pass(context, level, &search, old));
  }
  return RECEDE_OK;
}

static recede_status run_level(rc_context *context, const engine *e, int exponent,
                               rc_level *level) {
  int iterations = iterations_at(e, exponent);
  bool coarsest = exponent == e->level_count - 1;
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  rc_copy *old;
  uint32_t *guide;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, box, &old));
  RC_TRY(RC_NEW(context, box, &guide));
  for (int i = 0; i < iterations; i++) {
    if (i || !coarsest) RC_TRY(rc_vote(context, level, guide));
    for (int pass = 0; pass < PASSES; pass++) {
      rc_search search = search_of(e, exponent, i, pass);
      RC_TRY(rc_search_pass(context, level, &search, old));
    }
    RC_TRY(rc_progress(context, (double)(i + 1) / iterations));
  }
  if (!iterations) RC_TRY(rc_vote(context, level, guide));
  if (exponent == 0) RC_TRY(settle(context, e, level, old, !iterations));
  rc_release(context, mark);
  return RECEDE_OK;
}

static recede_status start_coarsest(rc_context *context, engine *e, rc_level *level) {
  uint64_t key = rc_key((uint64_t)e->params->seed, 99, 0);
  if (e->params->engine_periods)
    RC_TRY(rc_find_periods(context, level, key, e->periods, &e->period_count));
  rc_search search = {.kernels = e->kernels,
                      .key = key,
                      .periods = e->periods,
                      .period_count = e->period_count,
                      .anywhere = e->effort.start_tries};
  return rc_start(context, level, &search);
}

static recede_status search_levels(rc_context *context, engine *e, rc_level *finest) {
  rc_level coarser, level;
  float gamma = e->params->engine_confidence ? CONFIDENCE_FALLOFF : 1.f;
  for (int exponent = e->level_count - 1; exponent >= 0; exponent--) {
    bool coarsest = exponent == e->level_count - 1;
    rc_chart chart = rc_chart_coarser(e->chart, exponent);
    double from = .1 + .6 * pow(.25, exponent), to = .1 + .6 * pow(.25, exponent - 1);
    RC_TRY(rc_stage(context, coarsest ? "start" : "search", .1, from));
    RC_TRY(rc_level_new(context, &e->images[exponent], &e->flags[exponent], &chart, gamma, e->gain,
                        coarsest ? NULL : &coarser.ranges, &level));
    if (coarsest)
      RC_TRY(start_coarsest(context, e, &level));
    else
      rc_field_from_coarser(&level, &coarser);
    RC_TRY(rc_stage(context, "search", from, exponent ? to : .8));
    RC_TRY(run_level(context, e, exponent, &level));
    coarser = level;
  }
  *finest = level;
  return RECEDE_OK;
}

static recede_status choose_surface(rc_context *context, const rc_problem *problem, const engine *e,
                                    bool *raised) {
  int exponent = 0;
  double lean, error = 0;
  *raised = e->params->surface == RECEDE_SURFACE_RAISED;
  if (e->params->surface != RECEDE_SURFACE_AUTO) return RECEDE_OK;
  while (exponent + 1 < e->level_count && e->images[exponent].width > SURFACE_LONGEST_PX)
    exponent++;
  RC_TRY(rc_measure_lean(context, problem, &e->images[exponent], &e->flags[exponent], exponent,
                         &lean, &error));
  *raised = isnan(lean) || lean + 2 * error < LEAN_OF_RAISED;
  return RECEDE_OK;
}

static void count_magnified(rc_context *context, const rc_level *level) {
  recede_report *report = &context->report;
  double missing = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      rc_copy copy = level->field[rc_level_at(level, x, y)];
      if (isnan(copy.a)) {
        missing++;
        continue;
      }
      rc_place place =
          rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
      if (place.ratio < .8f) report->magnified_pixels++;
      if (1 / place.ratio > report->largest_magnification)
        report->largest_magnification = 1 / place.ratio;
    }
  if (report->magnified_pixels)
    rc_warn(context,
            "%llu px had to be magnified (up to %.1f times): no source of their size exists.",
            (unsigned long long)report->magnified_pixels, report->largest_magnification);
  if (missing > 0)
    rc_warn(context, "%.0f px found no source and got the smooth tone alone.", missing);
}

/* The guide itself, for the ablation: what the averaging of votes alone would give. */
static void take_guide(const engine *e, const rc_level *level, rc_image *residual) {
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      uint32_t pixel = level->pixels[(size_t)y * (size_t)level->width + (size_t)x];
      for (int k = 0; k < residual->channels; k++)
        rc_pixel(residual, x, y)[k] = ((float)(pixel >> 8 * k & 255) - 128.f) / e->gain;
    }
}

static recede_status compose(rc_context *context, const engine *e, const rc_level *finest,
                             rc_image *residual) {
  rc_sampler *sampler;
  if (!e->params->engine_composition) {
    take_guide(e, finest, residual);
    return RECEDE_OK;
  }
  RC_TRY(RC_NEW(context, 1, &sampler));
  rc_sampler_init(sampler, !e->params->engine_spline);
  return rc_compose(context, finest, sampler, e->images, e->level_count, e->params->engine_join,
                    residual);
}

recede_status rc_fill_plane(rc_context *context, const rc_problem *problem,
                            const recede_params *params, rc_image *filled) {
  engine e = {.params = params,
              .kernels = rc_kernels_select(context->host.kernel),
              .effort = efforts[params->quality]};
  bool raised;
  rc_tone tone;
  rc_level finest;
  if (!e.kernels)
    return rc_fail(context, RECEDE_ARGUMENT, "This machine has no kernel %d.",
                   context->host.kernel);
  RC_TRY(rc_stage(context, "tone", .05, .07));
  rc_tone_fit(filled, &problem->flags, params->engine_tone, &tone);
  RC_TRY(rc_tone_apply(context, &tone, &problem->flags, RC_KNOWN, -1, filled));
  RC_TRY(rc_stage(context, "pyramid", .07, .1));
  e.gain = byte_gain(filled, &problem->flags);
  RC_TRY(build_pyramid(context, problem, filled, &e));
  RC_TRY(choose_surface(context, problem, &e, &raised));
  e.chart = chart_of(problem, raised);
  context->report.surface = raised ? RECEDE_SURFACE_RAISED : RECEDE_SURFACE_FLAT;
  RC_TRY(search_levels(context, &e, &finest));
  RC_TRY(rc_stage(context, "composition", .8, .93));
  RC_TRY(compose(context, &e, &finest, filled));
  RC_TRY(rc_stage(context, "detail", .93, .97));
  if (params->engine_detail) RC_TRY(rc_match_detail(context, &finest, filled));
  count_magnified(context, &finest);
  return rc_tone_apply(context, &tone, &problem->flags, RC_TARGET, 1, filled);
}

uint64_t rc_plane_bytes(uint64_t pixels, uint64_t box, int channels, const recede_params *params) {
  uint64_t c = (uint64_t)channels, thirds = 4; /* a pyramid is 4/3 of its finest level */
  uint64_t grown = 4 * box + (256 << 10);      /* the box that detail is measured in */
  uint64_t pyramid = pixels * (4 * c + 1) / 3;
  uint64_t levels = (pixels * (4 + 1 + 1 + 4) + box * (12 + 4 + 1)) * thirds / 3;
  uint64_t search = box * (12 + 4 + 4), composition = box * (12 * c + 1);
  uint64_t detail = (grown < pixels ? grown : pixels) * 16 * c + pixels;
  uint64_t last = search > composition ? search : composition;
  (void)params;
  return pyramid + levels + (last > detail ? last : detail) + ((uint64_t)2 << 20);
}
