#include "synthesis/search/iterate.h"

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/search.h"
#include "synthesis/search/usage.h"
#include "synthesis/search/vote.h"

#define COHERENCE .03f
#define COHERENCE_OF_COMPOSITION .06f
#define PERIOD_TRIES 3
#define PASSES 2
/* Boards are a little bent; but what the coarsest level is off by the finest is many times. */
#define RAIL_TOLERANCE_PX .25f

/* The coarse levels decide and cost next to nothing. */
int rc_iterations_at(const rc_descent *e, int exponent) {
  const rc_effort *by = rc_effort_of(e->params);
  int most = e->params->engine_iterations ? e->params->engine_iterations : by->coarse_iterations;
  int here = most >> (e->level_count - 1 - exponent);
  int least = exponent || e->level_count == 1 ? by->fine_iterations : by->finest_iterations;
  if (!exponent && e->level_count > 1) return least < most ? least : most;
  least = least < most ? least : most;
  return here > least ? here : least;
}

recede_status rc_workspace_new(rc_context *context, const rc_descent *e, int exponent,
                               const rc_level *level, rc_workspace *scratch) {
  *scratch = (rc_workspace){NULL, NULL};
  RC_TRY(RC_NEW(context, (size_t)level->box_w * (size_t)level->box_h, &scratch->old));
  /* The finest level refines what the coarser ones have decided. */
  if (!e->params->engine_usage || !exponent) return RECEDE_OK;
  return RC_NEW(context, (size_t)level->width * (size_t)level->height, &scratch->usage);
}

static rc_search search_of(const rc_descent *e, int exponent, int trial, int iteration, int pass) {
  bool coarsest = exponent == e->level_count - 1;
  return (rc_search){.kernels = e->kernels,
                     .key = rc_key((uint64_t)e->params->seed, (uint32_t)exponent,
                                   (uint32_t)(trial * 1024 + iteration * PASSES + pass)),
                     .pass = pass,
                     .recost = pass == 0,
                     .coherence = e->params->engine_coherence ? COHERENCE : 0.f,
                     .local_radius = rc_effort_of(e->params)->local_radius,
                     .anywhere = coarsest ? rc_effort_of(e->params)->anywhere : 0,
                     .periods = e->periods.copies,
                     .period_count = coarsest && !e->on_rails ? e->periods.count : 0,
                     .period_tries = PERIOD_TRIES,
                     .rails = e->on_rails ? rc_rails_coarser(e->rails, exponent) : (rc_rails){0},
                     .rail_tolerance = coarsest ? 0.f : RAIL_TOLERANCE_PX};
}

recede_status rc_iterate(rc_context *context, const rc_descent *e, int exponent, int trial,
                         int from, int to, rc_pace *p, rc_level *level, rc_workspace *scratch) {
  bool coarsest = exponent == e->level_count - 1;
  for (int i = from; i < to; i++) {
    if (i || !coarsest) RC_TRY(rc_vote(context, level));
    for (int pass = 0; pass < PASSES; pass++) {
      rc_search search = search_of(e, exponent, trial, i, pass);
      search.usage = scratch->usage;
      if (scratch->usage) RC_TRY(rc_usage_prices(context, level, scratch->usage));
      RC_TRY(rc_search_pass(context, level, &search, scratch->old));
    }
    RC_TRY(rc_progress(context, (double)++p->done / p->total));
  }
  return RECEDE_OK;
}

recede_status rc_settle(rc_context *context, const rc_descent *e, rc_level *level,
                        rc_workspace *scratch) {
  for (int pass = 0; pass < PASSES; pass++) {
    rc_search search = {.kernels = e->kernels,
                        .pass = pass,
                        .coherence = e->params->engine_coherence ? COHERENCE_OF_COMPOSITION : 0.f};
    RC_TRY(rc_search_pass(context, level, &search, scratch->old));
  }
  return RECEDE_OK;
}
