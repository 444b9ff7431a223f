#include "synthesis/search/starts.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/kept.h"
#include "synthesis/search/search.h"
#include "synthesis/search/start.h"
#include "synthesis/search/whole.h"

/* Broken lines are seen first: they cost on top of a start's misfit. */
#define PRICE_OF_BROKEN_LINES .3
/* Boards have so many times the copies, for each has its own. */
#define EACH_BOARD 3

static recede_status start_once(rc_context *context, const rc_descent *e, const rc_starts *s,
                                int trial, rc_level *level) {
  static const int copies[] = {16, 8, 4};
  rc_search search = {.kernels = e->kernels,
                      .key = rc_key((uint64_t)e->params->seed, 99, (uint32_t)trial),
                      .periods = e->periods.copies,
                      .period_count = e->periods.count,
                      .anywhere = rc_effort_of(e->params)->start_tries};
  if (trial < s->first_whole) return rc_start(context, level, &search);
  return rc_start_whole(context, level, search.key, s->moves, s->move_count,
                        (level->board ? EACH_BOARD : 1) * copies[(trial - s->first_whole) % 3]);
}

static int first_part(int iterations) { return (iterations + 2) / 3; }
static int better_half(int trials) { return trials <= 2 ? trials : (trials + 1) / 2; }

int rc_work_of_starts(int trials, int iterations) {
  int part = first_part(iterations);
  return trials * part + better_half(trials) * (iterations - part);
}

static recede_status add_price_of_broken_lines(rc_context *context, const rc_descent *e,
                                               const rc_level *level, double *price) {
  double kept;
  RC_TRY(rc_lines_kept(context, level, e->lines, e->line_count, e->level_count - 1, &kept));
  *price += PRICE_OF_BROKEN_LINES * (1 - kept);
  return RECEDE_OK;
}

/* Trials beside each other: each is done in some lane, and kept. */
typedef struct race {
  const rc_descent *e;
  const rc_starts *s;
  rc_pace *pace;
  rc_lane *lanes;
  rc_trial before; /* what each begins with, where its start has no copy */
  int begun;       /* so many have by themselves */
  rc_trial *trials;
  double *misfits;
  int *better; /* those that get the rest of their iterations */
} race;

static recede_status begin_trial(rc_context *own, void *user, int item, int at) {
  race *r = user;
  rc_lane *lane = &r->lanes[at];
  int n = r->begun + item, exponent = r->e->level_count - 1, trial = r->s->first + n;
  rc_trial_restore(&lane->level, &r->before);
  RC_TRY(start_once(own, r->e, r->s, trial, &lane->level));
  RC_TRY(rc_iterate(own, r->e, exponent, trial, 0, first_part(rc_iterations_at(r->e, exponent)),
                    r->pace, &lane->level, &lane->scratch));
  r->misfits[n] = rc_misfit(&lane->level);
  rc_trial_save(&lane->level, &r->trials[n]);
  return RECEDE_OK;
}

static recede_status end_trial(rc_context *own, void *user, int k, int at) {
  race *r = user;
  rc_lane *lane = &r->lanes[at];
  int n = r->better[k], exponent = r->e->level_count - 1;
  int iterations = rc_iterations_at(r->e, exponent);
  rc_trial_restore(&lane->level, &r->trials[n]);
  RC_TRY(rc_iterate(own, r->e, exponent, r->s->first + n, first_part(iterations), iterations,
                    r->pace, &lane->level, &lane->scratch));
  r->misfits[n] = rc_misfit(&lane->level);
  rc_trial_save(&lane->level, &r->trials[n]);
  return RECEDE_OK;
}

/* Those that fit best so far, best first. */
static void take_better(race *r, int count) {
  for (int k = 0; k < better_half(count); k++) {
    int n = 0;
    for (int i = 1; i < count; i++)
      if (r->misfits[i] < r->misfits[n]) n = i;
    r->misfits[n] = INFINITY;
    r->better[k] = n;
  }
}

recede_status rc_try_starts(rc_context *context, const rc_descent *e, const rc_starts *s,
                            rc_pace *p, rc_level *level, rc_workspace *scratch, rc_trial *best,
                            double *least) {
  int exponent = e->level_count - 1, count = s->end - s->first, lanes;
  race r = {.e = e, .s = s, .pace = p};
  if (count == 1) { /* of large levels: no room for more */
    RC_TRY(start_once(context, e, s, s->first, level));
    RC_TRY(rc_iterate(context, e, exponent, s->first, 0, rc_iterations_at(e, exponent), p, level,
                      scratch));
    rc_trial_save(level, best);
    *least = rc_misfit(level);
    return add_price_of_broken_lines(context, e, level, least);
  }
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &r.trials));
  RC_TRY(RC_NEW(context, count, &r.misfits));
  RC_TRY(RC_NEW(context, count, &r.better));
  RC_TRY(rc_trial_new(context, level, &r.before));
  for (int n = 0; n < count; n++) RC_TRY(rc_trial_new(context, level, &r.trials[n]));
  RC_TRY(rc_lanes_new(context, level, scratch, count, &r.lanes, &lanes));
  rc_trial_save(level, &r.before);
  if (s->first_whole < s->end) { /* leave much without a copy: there they begin as the first ends */
    RC_TRY(begin_trial(context, &r, 0, 0));
    rc_trial_save(&r.lanes[0].level, &r.before);
    r.begun = 1;
  }
  RC_TRY(rc_parallel_tasks(context, count - r.begun, lanes, begin_trial, &r));
  take_better(&r, count);
  RC_TRY(rc_parallel_tasks(context, better_half(count), lanes, end_trial, &r));
  int kept = r.better[0];
  for (int k = 1; k < better_half(count); k++)
    if (r.misfits[r.better[k]] < r.misfits[kept]) kept = r.better[k];
  *least = r.misfits[kept];
  rc_trial_restore(level, &r.trials[kept]);
  rc_trial_save(level, best);
  RC_TRY(add_price_of_broken_lines(context, e, level, least));
  rc_release(context, mark);
  return RECEDE_OK;
}
