#include "synthesis/descent.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/kept.h"
#include "synthesis/lock.h"
#include "synthesis/rest.h"
#include "synthesis/search.h"
#include "synthesis/start.h"
#include "synthesis/trial.h"
#include "synthesis/usage.h"
#include "synthesis/vote.h"
#include "synthesis/whole.h"

/* Each px deeper in the hole counts 1.3 times less; 1.15 is too trusting. */
#define CONFIDENCE_FALLOFF 1.3f
#define COHERENCE .03f
#define COHERENCE_OF_COMPOSITION .06f
#define PERIOD_TRIES 3
#define PASSES 2
/* Broken lines are seen first: they cost on top of a start's misfit. Starts that continue clear
 * ones may fit worse, for finer levels break what the coarsest still has; boards measure 40 and
 * more. Others must fit better: crests of waves, 13 to 20, look like lines by chance, and bricks
 * and tiles carry their own. A lattice's lines get one try. */
#define PRICE_OF_BROKEN_LINES .3
#define CLEAR_LINE 30.f
#define FAVOUR_OF_CLEAR_LINES 1.3

/* What the quality levels change. */
typedef struct effort {
  int starts;            /* of the coarsest level; the best is kept */
  int start_tries;       /* random candidates per pixel of the start */
  int coarse_iterations; /* at the coarsest level; half as many with each finer one */
  int fine_iterations;   /* but at least these */
  int finest_iterations; /* and these at the finest; 0: only takes the coarser copies over */
  int anywhere;          /* random candidates per pixel from all sources, coarsest level */
  int local_radius;      /* largest radius of the random candidates nearby, px */
} effort;

static const effort efforts[] = {
    [RECEDE_QUALITY_DRAFT] = {2, 30, 6, 2, 0, 2, 8},
    [RECEDE_QUALITY_NORMAL] = {6, 60, 12, 2, 2, 4, 16},
    [RECEDE_QUALITY_BEST] = {12, 100, 24, 4, 4, 6, 16},
};

static const effort *effort_of(const rc_descent *e) { return &efforts[e->params->quality]; }

/* The coarse levels decide and cost next to nothing. */
static int iterations_at(const rc_descent *e, int exponent) {
  const effort *by = effort_of(e);
  int most = e->params->engine_iterations ? e->params->engine_iterations : by->coarse_iterations;
  int here = most >> (e->level_count - 1 - exponent);
  int least = exponent || e->level_count == 1 ? by->fine_iterations : by->finest_iterations;
  if (!exponent && e->level_count > 1) return least < most ? least : most;
  least = least < most ? least : most;
  return here > least ? here : least;
}

/* The finest level that is searched: what it settles on is composed. */
static int last_searched(const rc_descent *e) { return iterations_at(e, 0) ? 0 : 1; }

static rc_search search_of(const rc_descent *e, int exponent, int trial, int iteration, int pass) {
  bool coarsest = exponent == e->level_count - 1;
  return (rc_search){.kernels = e->kernels,
                     .key = rc_key((uint64_t)e->params->seed, (uint32_t)exponent,
                                   (uint32_t)(trial * 1024 + iteration * PASSES + pass)),
                     .pass = pass,
                     .recost = pass == 0,
                     .coherence = e->params->engine_coherence ? COHERENCE : 0.f,
                     .local_radius = effort_of(e)->local_radius,
                     .anywhere = coarsest ? effort_of(e)->anywhere : 0,
                     .periods = e->periods,
                     .period_count = coarsest ? e->period_count : 0,
                     .period_tries = PERIOD_TRIES};
}

/* Propagation alone, with a higher price on incoherence: whole copies for the composition. */
static recede_status settle(rc_context *context, const rc_descent *e, rc_level *level,
                            rc_copy *old) {
  for (int pass = 0; pass < PASSES; pass++) {
    rc_search search = {.kernels = e->kernels,
                        .pass = pass,
                        .coherence = e->params->engine_coherence ? COHERENCE_OF_COMPOSITION : 0.f};
    RC_TRY(rc_search_pass(context, level, &search, old));
  }
  return RECEDE_OK;
}

/* Scratch of a level. */
typedef struct workspace {
  rc_copy *old;
  float *usage; /* NULL: sources cost nothing here */
} workspace;

static recede_status workspace_new(rc_context *context, const rc_descent *e, int exponent,
                                   const rc_level *level, workspace *scratch) {
  *scratch = (workspace){NULL, NULL};
  RC_TRY(RC_NEW(context, (size_t)level->box_w * (size_t)level->box_h, &scratch->old));
  /* The finest level refines what the coarser ones have decided. */
  if (!e->params->engine_usage || !exponent) return RECEDE_OK;
  return RC_NEW(context, (size_t)level->width * (size_t)level->height, &scratch->usage);
}

/* Search and vote in turn. This is trial of trials, the stage's progress is theirs together. */
static recede_status iterate(rc_context *context, const rc_descent *e, int exponent, int trial,
                             int trials, rc_level *level, workspace *scratch) {
  int iterations = iterations_at(e, exponent);
  bool coarsest = exponent == e->level_count - 1;
  for (int i = 0; i < iterations; i++) {
    if (i || !coarsest) RC_TRY(rc_vote(context, level));
    for (int pass = 0; pass < PASSES; pass++) {
      rc_search search = search_of(e, exponent, trial, i, pass);
      search.usage = scratch->usage;
      if (scratch->usage) RC_TRY(rc_usage_prices(context, level, scratch->usage));
      RC_TRY(rc_search_pass(context, level, &search, scratch->old));
    }
    RC_TRY(rc_progress(context, (trial + (double)(i + 1) / iterations) / trials));
  }
  return RECEDE_OK;
}

/* Some of all trials: starts by patches first, then those of few whole copies. */
typedef struct starts {
  int first, first_whole, end, trials;
  bool lattice;
} starts;

static recede_status start_once(rc_context *context, const rc_descent *e, const starts *s,
                                int trial, rc_level *level) {
  static const int copies[] = {16, 8, 4};
  rc_search search = {.kernels = e->kernels,
                      .key = rc_key((uint64_t)e->params->seed, 99, (uint32_t)trial),
                      .periods = e->periods,
                      .period_count = e->period_count,
                      .anywhere = effort_of(e)->start_tries};
  if (trial < s->first_whole) return rc_start(context, level, &search);
  return rc_start_whole(context, level, &search, s->lattice, copies[(trial - s->first_whole) % 3]);
}

/* Keeps the start that fits best, and its misfit. */
static recede_status try_starts(rc_context *context, const rc_descent *e, const starts *s,
                                rc_level *level, workspace *scratch, rc_trial *best,
                                double *least) {
  *least = INFINITY;
  for (int trial = s->first; trial < s->end; trial++) {
    RC_TRY(start_once(context, e, s, trial, level));
    RC_TRY(iterate(context, e, e->level_count - 1, trial, s->trials, level, scratch));
    if (scratch->usage) RC_TRY(rc_usage_prices(context, level, scratch->usage));
    double misfit = rc_misfit(level, scratch->usage);
    if (misfit >= *least) continue;
    *least = misfit;
    rc_trial_save(level, best);
  }
  return RECEDE_OK;
}

static double price_of_broken_lines(const rc_descent *e, rc_level *level, const rc_trial *trial) {
  rc_trial_restore(level, trial);
  return PRICE_OF_BROKEN_LINES *
         (1 - rc_lines_kept(level, e->lines, e->line_count, e->level_count - 1));
}

/* The coarsest level: starts it several times and keeps the best, then up to half as often again
 * with the lines continued. */
static recede_status run_coarsest(rc_context *context, rc_descent *e, rc_level *level,
                                  workspace *scratch) {
  int exponent = e->level_count - 1, wanted = e->params->engine_starts;
  int plain = rc_trials_worth(level, wanted ? wanted : effort_of(e)->starts);
  uint64_t key = rc_key((uint64_t)e->params->seed, 99, 0);
  double misfit, misfit_with_lines;
  rc_trial best, with_lines;
  bool lattice = false;
  if (e->params->engine_periods)
    RC_TRY(rc_find_periods(context, level, key, e->periods, &e->period_count, &lattice));
  if (e->params->engine_lines)
    RC_TRY(rc_lines_find(context, e->images, e->flags, e->level_count, &e->chart, e->lines,
                         &e->line_count));
  int trials = plain + (e->line_count == 0 ? 0 : lattice ? 1 : (plain + 1) / 2);
  /* Where lines cross the hole there are things that go on as a whole: boards, courses of tiles. */
  bool whole = e->params->engine_whole && e->line_count > 0;
  starts by_chance = {0, whole ? plain - plain / 2 : plain, plain, trials, lattice};
  starts along_lines = {plain, whole ? plain : trials, trials, trials, lattice};
  if (trials == 1) {
    RC_TRY(start_once(context, e, &by_chance, 0, level));
    return iterate(context, e, exponent, 0, 1, level, scratch);
  }
  RC_TRY(rc_trial_new(context, level, &best));
  RC_TRY(try_starts(context, e, &by_chance, level, scratch, &best, &misfit));
  if (e->line_count) {
    misfit += price_of_broken_lines(e, level, &best);
    RC_TRY(rc_trial_new(context, level, &with_lines));
    RC_TRY(rc_lines_lock(context, e->lines, e->line_count, exponent, level));
    RC_TRY(try_starts(context, e, &along_lines, level, scratch, &with_lines, &misfit_with_lines));
    misfit_with_lines += price_of_broken_lines(e, level, &with_lines);
    bool clear = !lattice && e->lines[0].strength >= CLEAR_LINE;
    double favour = clear ? FAVOUR_OF_CLEAR_LINES : 1;
    e->continue_lines = misfit_with_lines < favour * misfit;
    if (e->continue_lines) return RECEDE_OK;
    RC_FREE(context, &level->locked);
  }
  rc_trial_restore(level, &best);
  return RECEDE_OK;
}

static recede_status run_level(rc_context *context, rc_descent *e, int exponent, rc_level *level) {
  workspace scratch;
  rc_block *mark = rc_mark(context);
  RC_TRY(workspace_new(context, e, exponent, level, &scratch));
  if (exponent == e->level_count - 1) {
    RC_TRY(run_coarsest(context, e, level, &scratch));
  } else {
    if (e->continue_lines) RC_TRY(rc_lines_lock(context, e->lines, e->line_count, exponent, level));
    RC_TRY(iterate(context, e, exponent, 0, 1, level, &scratch));
  }
  if (exponent == last_searched(e)) RC_TRY(settle(context, e, level, scratch.old));
  level->locked = NULL;
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_descend(rc_context *context, rc_descent *e, rc_level *finest) {
  rc_level coarser = {0}, level = {0};
  float gamma = e->params->engine_confidence ? CONFIDENCE_FALLOFF : 1.f;
  for (int exponent = e->level_count - 1; exponent >= 0; exponent--) {
    bool coarsest = exponent == e->level_count - 1;
    rc_chart chart = rc_chart_coarser(e->chart, exponent);
    double from = .1 + .6 * pow(.25, exponent), to = .1 + .6 * pow(.25, exponent - 1);
    RC_TRY(
        rc_stage(context, coarsest ? "start" : "search", coarsest ? .1 : from, exponent ? to : .8));
    RC_TRY(rc_level_new(context, &e->images[exponent], &e->flags[exponent], &chart, gamma, e->gain,
                        coarsest ? NULL : &coarser.ranges, &level));
    if (!coarsest) {
      rc_field_from_coarser(&level, &coarser);
      rc_level_free_pixels(context, &coarser);
    }
    RC_TRY(run_level(context, e, exponent, &level));
    coarser = level;
  }
  *finest = level;
  return rc_continue_rest(context, finest, rc_key((uint64_t)e->params->seed, 98, 0), &e->rest);
}
