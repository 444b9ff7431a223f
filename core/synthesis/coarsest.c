#include "synthesis/coarsest.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/kept.h"
#include "synthesis/lock.h"
#include "synthesis/search.h"
#include "synthesis/start.h"
#include "synthesis/trial.h"
#include "synthesis/whole.h"

/* Broken lines are seen first: they cost on top of a start's misfit. Starts that continue them may
 * fit worse, for finer levels break what the coarsest still has, and thin lines are faint there. A
 * lattice carries lines of its own anyway: starts that continue them get one try there, and with
 * more favour they break bricks. */
#define PRICE_OF_BROKEN_LINES .3
#define FAVOUR_OF_LINES 1.3
#define FAVOUR_IN_LATTICE 1.2

/* Some of all trials: starts by patches first, then those of few whole copies. */
typedef struct starts {
  int first, first_whole, end;
  bool lattice;
} starts;

static recede_status start_once(rc_context *context, const rc_descent *e, const starts *s,
                                int trial, rc_level *level) {
  static const int copies[] = {16, 8, 4};
  rc_search search = {.kernels = e->kernels,
                      .key = rc_key((uint64_t)e->params->seed, 99, (uint32_t)trial),
                      .periods = e->periods,
                      .period_count = e->period_count,
                      .anywhere = rc_effort_of(e)->start_tries};
  if (trial < s->first_whole) return rc_start(context, level, &search);
  return rc_start_whole(context, level, &search, s->lattice, copies[(trial - s->first_whole) % 3]);
}

/* All trials get a third of their iterations, the better half of them the rest. Of two both get
 * all: a third of a draft's few says too little. */
static int first_part(int iterations) { return (iterations + 2) / 3; }
static int better_half(int trials) { return trials <= 2 ? trials : (trials + 1) / 2; }
static int work_of(int trials, int iterations) {
  int part = first_part(iterations);
  return trials * part + better_half(trials) * (iterations - part);
}

/* Keeps the start that fits best, and its misfit. */
static recede_status try_starts(rc_context *context, const rc_descent *e, const starts *s,
                                rc_pace *p, rc_level *level, rc_workspace *scratch, rc_trial *best,
                                double *least) {
  int exponent = e->level_count - 1, count = s->end - s->first;
  int iterations = rc_iterations_at(e, exponent), part = first_part(iterations);
  rc_trial *trials;
  double *misfits;
  RC_TRY(RC_NEW(context, count, &trials));
  RC_TRY(RC_NEW(context, count, &misfits));
  for (int n = 0; n < count; n++) {
    RC_TRY(rc_trial_new(context, level, &trials[n]));
    RC_TRY(start_once(context, e, s, s->first + n, level));
    RC_TRY(rc_iterate(context, e, exponent, s->first + n, 0, part, p, level, scratch));
    misfits[n] = rc_misfit(level);
    rc_trial_save(level, &trials[n]);
  }
  *least = INFINITY;
  for (int k = 0; k < better_half(count); k++) {
    int n = 0;
    for (int i = 1; i < count; i++)
      if (misfits[i] < misfits[n]) n = i;
    misfits[n] = INFINITY;
    rc_trial_restore(level, &trials[n]);
    RC_TRY(rc_iterate(context, e, exponent, s->first + n, part, iterations, p, level, scratch));
    double misfit = rc_misfit(level);
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
recede_status rc_run_coarsest(rc_context *context, rc_descent *e, rc_level *level,
                              rc_workspace *scratch) {
  int exponent = e->level_count - 1, wanted = e->params->engine_starts;
  int plain = rc_trials_worth(level, wanted ? wanted : rc_effort_of(e)->starts);
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
  /* Where lines cross the hole there are things that go on as a whole: boards, courses of tiles.
   * But whole copies that break lines fit well, and must not win over those that continue them; a
   * lattice's periods break none. */
  bool whole = e->params->engine_whole && e->line_count > 0;
  starts by_chance = {0, whole && lattice ? plain - plain / 2 : plain, plain, lattice};
  starts along_lines = {plain, whole ? trials - (trials - plain) / 2 : trials, trials, lattice};
  int iterations = rc_iterations_at(e, exponent);
  if (trials == 1) {
    rc_pace p = {0, iterations};
    RC_TRY(start_once(context, e, &by_chance, 0, level));
    return rc_iterate(context, e, exponent, 0, 0, iterations, &p, level, scratch);
  }
  rc_pace p = {0, work_of(plain, iterations) + work_of(trials - plain, iterations)};
  RC_TRY(rc_trial_new(context, level, &best));
  RC_TRY(try_starts(context, e, &by_chance, &p, level, scratch, &best, &misfit));
  if (e->line_count) {
    misfit += price_of_broken_lines(e, level, &best);
    RC_TRY(rc_trial_new(context, level, &with_lines));
    RC_TRY(rc_lines_lock(context, e->lines, e->line_count, exponent, level));
    RC_TRY(
        try_starts(context, e, &along_lines, &p, level, scratch, &with_lines, &misfit_with_lines));
    misfit_with_lines += price_of_broken_lines(e, level, &with_lines);
    double favour = lattice ? FAVOUR_IN_LATTICE : FAVOUR_OF_LINES;
    e->continue_lines = misfit_with_lines < favour * misfit;
    if (e->continue_lines) return RECEDE_OK;
    RC_FREE(context, &level->locked);
  }
  rc_trial_restore(level, &best);
  return RECEDE_OK;
}
