#include "synthesis/search/descent.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/search/beside.h"
#include "synthesis/search/boards.h"
#include "synthesis/search/coarsest.h"
#include "synthesis/search/cuts.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/lock.h"
#include "synthesis/search/rest.h"
#include "synthesis/search/vote.h"

/* Each px deeper in the hole counts 1.3 times less; 1.15 is too trusting. */
#define CONFIDENCE_FALLOFF 1.3f

/* The finest level refines the first cut. */
#define LEAST_CUT_LEVEL 1

/* The finest level that is searched: what it settles on is composed. */
static int last_searched(const rc_descent *e) { return rc_iterations_at(e, 0) ? 0 : 1; }

static bool can_be_cut(const rc_mask *flags, int most_px) {
  rc_box box = rc_box_of(flags, RC_TARGET);
  int64_t targets = 0;
  for (size_t i = 0; i < (size_t)flags->width * (size_t)flags->height; i++)
    targets += (flags->data[i] & RC_TARGET) != 0;
  return targets <= most_px &&
         (uint64_t)(box.x1 - box.x0) * (uint64_t)(box.y1 - box.y0) <= rc_most_cut_box(most_px);
}

/* The finest that can be; finer ones refine what lies beside the seams. */
static int find_cut_level(const rc_descent *e) {
  int exponent = LEAST_CUT_LEVEL, most_px = rc_effort_of(e->params)->cut_px;
  while (exponent < e->level_count && !can_be_cut(&e->flags[exponent], most_px)) exponent++;
  return exponent;
}

static bool is_cut(const rc_descent *e, int exponent) {
  const rc_effort *by = rc_effort_of(e->params);
  /* Boards are filled one by one; and a seam across a lane costs little, but cuts it off. */
  if (!e->params->engine_cuts || !by->cut_px || e->on_rails || e->line_count) return false;
  if (e->cut_level == e->level_count) return false;
  return exponent == e->cut_level ||
         (exponent < e->cut_level && can_be_cut(&e->flags[exponent], by->cut_again_px));
}

static recede_status search_level(rc_context *context, rc_descent *e, int exponent,
                                  rc_level *level) {
  rc_workspace scratch;
  RC_TRY(rc_workspace_new(context, e, exponent, level, &scratch));
  if (exponent == e->level_count - 1) {
    RC_TRY(rc_run_coarsest(context, e, level, &scratch));
  } else {
    rc_pace p = {0, rc_iterations_at(e, exponent)};
    if (e->on_rails) RC_TRY(rc_boards_mark(context, &e->rails, exponent, level));
    if (e->take_beside && !e->on_rails && !e->on_lattice && !e->by_periods)
      RC_TRY(rc_take_beside(context, level,
                            rc_key((uint64_t)e->params->seed, 97, (uint32_t)exponent), true));
    RC_TRY(rc_iterate(context, e, exponent, 0, 0, p.total, &p, level, &scratch));
  }
  if (is_cut(e, exponent))
    RC_TRY(
        rc_cut_copies(context, e->kernels, e->params->engine_usage && !e->periods.repeats, level));
  return exponent == last_searched(e) ? rc_settle(context, e, level, &scratch) : RECEDE_OK;
}

static recede_status run_level(rc_context *context, rc_descent *e, int exponent, rc_level *level) {
  bool coarsest = exponent == e->level_count - 1;
  rc_block *mark = rc_mark(context);
  if (e->continue_lines && !coarsest)
    RC_TRY(rc_lines_lock(context, e->lines, e->line_count, exponent, level));
  if (exponent >= last_searched(e)) RC_TRY(search_level(context, e, exponent, level));
  if (!exponent && e->take_beside && !e->on_rails && !e->on_lattice && !e->by_periods)
    RC_TRY(rc_take_beside(context, level, rc_key((uint64_t)e->params->seed, 96, 0), false));
  level->locked = NULL, level->board = NULL;
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_descend(rc_context *context, rc_descent *e, rc_level *finest) {
  rc_level coarser = {0}, level = {0};
  float gamma = e->params->engine_confidence ? CONFIDENCE_FALLOFF : 1.f;
  e->cut_level = find_cut_level(e);
  for (int exponent = e->level_count - 1; exponent >= 0; exponent--) {
    bool coarsest = exponent == e->level_count - 1;
    rc_chart chart = rc_chart_coarser(e->chart, exponent);
    double from = .1 + .6 * pow(.25, exponent), to = .1 + .6 * pow(.25, exponent - 1);
    RC_TRY(
        rc_stage(context, coarsest ? "start" : "search", coarsest ? .1 : from, exponent ? to : .8));
    RC_TRY(rc_level_new(context, &e->flags[exponent], &chart, &level));
    level.sides = rc_sides_coarser(e->sides, exponent);
    level.conditions = rc_conditions_coarser(e->conditions, exponent);
    level.layers = e->layers;
    level.cut_x = e->cut_x >> exponent, level.cut_y = e->cut_y >> exponent;
    if (!coarsest) level.ranges = coarser.ranges;
    if (e->on_lattice) level.lattice = rc_lattice_finer(coarser.lattice, 2.f);
    if (exponent >= last_searched(e))
      RC_TRY(rc_level_see(context, &e->images[exponent], &e->traits[exponent], gamma, e->gain,
                          coarsest, &level));
    if (!coarsest) {
      rc_field_from_coarser(&level, &coarser);
      rc_level_free_pixels(context, &coarser);
    }
    RC_TRY(run_level(context, e, exponent, &level));
    if (coarsest && !e->continue_lines && e->sides.one_ground) /* what it is not, is a band */
      e->sides.one_ground = false, e->sides.boundary_count = 0;
    coarser = level;
  }
  *finest = level;
  return rc_continue_rest(context, finest, rc_key((uint64_t)e->params->seed, 98, 0), e->rest,
                          &e->rest_count);
}
