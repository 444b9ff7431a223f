#include "synthesis/search/coarsest.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/pyramid.h"
#include "synthesis/search/boards.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/lattice_find.h"
#include "synthesis/search/lock.h"
#include "synthesis/search/regular.h"
#include "synthesis/search/starts.h"
#include "synthesis/search/whole.h"

/* Starts that continue lines may fit worse, for finer levels break what the coarsest still has, and
 * thin lines are faint there: a crack across a road without dashes to copy 1.4 to 1.7 times as
 * badly. */
#define FAVOUR_OF_RAILS 1.3
#define FAVOUR_OF_LINES 1.8
#define FAVOUR_OF_CLEAR_LINES 2.
/* The plainer what a sure line crosses, the more it costs: a marking on asphalt 2 to 2.7 times as
 * much. */
#define FAVOUR_OF_SURE_LINES 4.
/* A lattice costs tiles and old roofs .7 to 1.1 of what any copies do, stones that only lie in rows
 * .6 to 1.4, roof tiles that are all alike 1.6 and more: they keep in order by themselves. */
#define FAVOUR_OF_LATTICE 1.3
/* What is regular costs .56 to 1.17 of what others do that go on with the wrong square or window;
 * roof tiles whose other starts are good as they are 1.26 and more. Stripes 1 to 1.2, where the
 * others end them early. */
#define FAVOUR_OF_PERIODS 1.22
/* And what is so by its joints alone .68 to 1.15, pavers whose other starts are good 1.17. */
#define FAVOUR_OF_JOINTS 1.16
/* A grid that is beyond doubt .82 to 1.6, where the others leave a bar out. */
#define FAVOUR_OF_CLEAR_PERIODS 1.7
/* What comes from another board is not what this one shows again and again beside the hole. */
#define FAVOUR_OF_BOARDS 1.25
/* Moves along the rails are of so many px and more, nearest first, as many as whole.c looks at,
 * each also across by up to so many rows; and so many target pixels more than by other moves may
 * find nothing along them: they go on from what lies beside them. Of a pier as wide as its source
 * mask that is .02, at its far end. */
#define LEAST_MOVE_PX 6
#define WHOLE_ROWS 6
#define MOST_WITHOUT_COPY .06
/* Where an earlier fill kept to the rails, the rest is tried again later. */
#define MOST_WITHOUT_KEPT .5

/* The part of the targets that has no copy. */
static double without_copy(const rc_level *level) {
  int targets = 0, without = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      targets++;
      without += isnan(level->field[rc_level_at(level, x, y)].a);
    }
  return targets ? (double)without / targets : 0;
}

static recede_status moves_along(rc_context *context, const rc_descent *e, const rc_level *level,
                                 const rc_copy **moves, int *count) {
  rc_copy *made;
  rc_rails rails = rc_rails_coarser(e->rails, e->level_count - 1);
  int rows = rails.rows < WHOLE_ROWS ? rails.rows : WHOLE_ROWS;
  int each = 2 * (2 * rows + 1), most = level->width + level->height - LEAST_MOVE_PX;
  if (most > RC_WHOLE_CANDIDATES / each) most = RC_WHOLE_CANDIDATES / each;
  *count = 0;
  RC_TRY(RC_NEW(context, each * most, &made));
  for (int px = LEAST_MOVE_PX; px < LEAST_MOVE_PX + most; px++)
    for (int sign = -1; sign <= 1; sign += 2)
      for (int row = -rows; row <= rows; row++) {
        float along = (float)(sign * px), across = (float)row * rails.gauge;
        made[(*count)++] =
            rc_copy_of_move(&level->chart, 0.f, 0.f, along * rails.a - across * rails.b,
                            along * rails.b + across * rails.a);
      }
  *moves = made;
  return RECEDE_OK;
}

/* Starts that keep to the rails, from the trial first on. without: of targets, by other starts;
 * *own: what the best of them, which the level then holds, costs. */
static recede_status start_on_rails(rc_context *context, const rc_descent *e, int first, int count,
                                    double without, rc_pace *p, rc_level *level,
                                    rc_workspace *scratch, rc_trial *best, double *own) {
  rc_starts s = {first, first, first + count, NULL, 0};
  RC_TRY(moves_along(context, e, level, &s.moves, &s.move_count));
  RC_TRY(rc_reach_moves(context, level, s.moves, s.move_count));
  RC_TRY(rc_try_starts(context, e, &s, p, level, scratch, best, own));
  /* Where few had a copy before half of these must have: an empty start fits well. */
  double most = fmin(without + MOST_WITHOUT_COPY, .5 * (1 + without));
  if (without_copy(level) > most) *own = INFINITY;
  return RECEDE_OK;
}

/* As start_on_rails, without anything to compare with. False: for too many targets there is nothing
 * on them. */
static recede_status keep_to_rails(rc_context *context, rc_descent *e, int count, rc_level *level,
                                   rc_workspace *scratch, bool *kept) {
  rc_pace p = {0, rc_work_of_starts(count, rc_iterations_at(e, e->level_count - 1))};
  rc_starts s = {0, 0, count, NULL, 0};
  rc_trial best;
  rc_ranges ranges = level->ranges;
  double own;
  RC_TRY(rc_boards_mark(context, &e->rails, e->level_count - 1, level));
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_trial_new(context, level, &best));
  RC_TRY(moves_along(context, e, level, &s.moves, &s.move_count));
  RC_TRY(rc_reach_moves(context, level, s.moves, s.move_count));
  e->on_rails = true;
  RC_TRY(rc_try_starts(context, e, &s, &p, level, scratch, &best, &own));
  rc_release(context, mark);
  *kept = e->on_rails = without_copy(level) <= MOST_WITHOUT_KEPT;
  if (!*kept) level->ranges = ranges;
  if (!*kept && level->board) RC_FREE(context, &level->board);
  return RECEDE_OK;
}

/* Along the rails alone and, where boards have one width, board by board. misfit: of the best start
 * so far, which the level holds. */
static recede_status try_rails(rc_context *context, rc_descent *e, int first, int count, rc_pace *p,
                               rc_level *level, rc_workspace *scratch, double misfit) {
  rc_trial along, across;
  double own, own_across = INFINITY, without = without_copy(level);
  const rc_ranges ranges = level->ranges;
  int rows = e->rails.rows;
  RC_TRY(rc_trial_new(context, level, &along));
  RC_TRY(rc_trial_new(context, level, &across));
  RC_TRY(rc_boards_mark(context, &e->rails, e->level_count - 1, level));
  uint8_t *board = level->board;
  e->on_rails = true;
  if (rows)
    RC_TRY(
        start_on_rails(context, e, first, count, without, p, level, scratch, &across, &own_across));
  const rc_ranges of_across = level->ranges;
  e->rails.rows = 0, level->board = NULL, level->ranges = ranges;
  RC_TRY(start_on_rails(context, e, first, count, without, p, level, scratch, &along, &own));
  if (rows && own_across < FAVOUR_OF_BOARDS * own) {
    own = own_across;
    e->rails.rows = rows, level->board = board, level->ranges = of_across;
    rc_trial_restore(level, &across);
  }
  e->on_rails = own < FAVOUR_OF_RAILS * misfit;
  if (!e->on_rails) level->board = NULL, level->ranges = ranges;
  return RECEDE_OK;
}

static double favour_of(const rc_crossing *line) {
  if (rc_crossing_is_sure(line)) return FAVOUR_OF_SURE_LINES;
  return line->strength >= RC_CLEAR_STRENGTH ? FAVOUR_OF_CLEAR_LINES : FAVOUR_OF_LINES;
}

/* Starts with the lines locked. */
static recede_status try_lines(rc_context *context, rc_descent *e, const rc_starts *s, rc_pace *p,
                               rc_level *level, rc_workspace *scratch, double misfit) {
  rc_trial best;
  double own, favour = 0;
  RC_TRY(rc_trial_new(context, level, &best));
  RC_TRY(rc_lines_lock(context, e->lines, e->line_count, e->level_count - 1, level));
  RC_TRY(rc_try_starts(context, e, s, p, level, scratch, &best, &own));
  for (int i = 0; i < e->line_count; i++) favour = fmax(favour, favour_of(&e->lines[i]));
  e->continue_lines = e->lines_taken || own < favour * misfit;
  if (!e->continue_lines) RC_FREE(context, &level->locked);
  return RECEDE_OK;
}

static double favour_of_periods(const rc_periods *periods) {
  if (periods->clear) return FAVOUR_OF_CLEAR_PERIODS;
  return periods->by_joints ? FAVOUR_OF_JOINTS : FAVOUR_OF_PERIODS;
}

/* Which kinds of copies there are. */
static void take_kinds(rc_descent *e, const rc_chart *from) {
  e->chart.raised = from->raised, e->chart.standing_w = from->standing_w;
}

/* Starts of whole copies by the periods of what is regular, or a row, which lies flat. The level
 * then holds the best of these and those before, *best. */
static recede_status try_periods(rc_context *context, rc_descent *e, int first, int count,
                                 rc_pace *p, rc_level *level, rc_workspace *scratch, rc_trial *best,
                                 double *misfit) {
  rc_starts s = {first, first, first + count, NULL, 0};
  rc_trial by_periods;
  double own;
  rc_chart chart = level->chart;
  rc_ranges ranges = level->ranges;
  RC_TRY(rc_trial_new(context, level, &by_periods));
  RC_TRY(rc_moves_by_periods(context, &e->periods, &s.moves, &s.move_count));
  level->chart = rc_chart_flat(chart);
  RC_TRY(rc_reach_moves(context, level, s.moves, s.move_count));
  RC_TRY(rc_try_starts(context, e, &s, p, level, scratch, &by_periods, &own));
  e->by_periods = own < favour_of_periods(&e->periods) * *misfit;
  if (e->by_periods)
    *misfit = own, *best = by_periods;
  else
    level->chart = chart, level->ranges = ranges;
  take_kinds(e, &level->chart);
  rc_trial_restore(level, best);
  return RECEDE_OK;
}

/* Starts that keep to the lattice, which lies flat. */
static recede_status try_lattice(rc_context *context, rc_descent *e, int first, int count,
                                 rc_pace *p, rc_level *level, rc_workspace *scratch,
                                 double misfit) {
  rc_starts s = {first, first + count, first + count, NULL, 0};
  rc_trial best;
  double own;
  rc_chart chart = level->chart;
  RC_TRY(rc_trial_new(context, level, &best));
  level->lattice = e->lattice;
  if (e->params->surface != RECEDE_SURFACE_RAISED) level->chart = rc_chart_flat(chart);
  RC_TRY(rc_try_starts(context, e, &s, p, level, scratch, &best, &own));
  e->on_lattice = own < FAVOUR_OF_LATTICE * misfit;
  if (!e->on_lattice) level->chart = chart, level->lattice = (rc_lattice){.spacing = 1};
  take_kinds(e, &level->chart);
  return RECEDE_OK;
}

/* What all sources told: those near the hole, fewer, may not. */
static void take_due(rc_descent *e) {
  const rc_periods *all = &e->of_all;
  for (int k = 0; k < 2; k++) e->periods.base[k] = all->base[k];
  e->periods.regular = all->regular, e->periods.clear = all->clear, e->periods.row = all->row;
  e->periods.repeats = e->periods.repeats || all->repeats, e->periods.due = true;
}

recede_status rc_run_coarsest(rc_context *context, rc_descent *e, rc_level *level,
                              rc_workspace *scratch) {
  int exponent = e->level_count - 1, wanted = e->params->engine_starts;
  int plain = rc_trials_worth(level, wanted ? wanted : rc_effort_of(e->params)->starts);
  int half = (plain + 1) / 2, iterations = rc_iterations_at(e, exponent);
  uint64_t key = rc_key((uint64_t)e->params->seed, 99, 0);
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  double misfit;
  rc_trial best;
  /* What stands alone comes again in no lattice. */
  bool lone = e->lines_taken || rc_crossings_have_lone(e->lines, e->line_count);
  bool regular = e->params->engine_regular && e->params->surface != RECEDE_SURFACE_RAISED && !lone;
  bool told = e->due && e->of_all.regular; /* by more than joints */
  bool joints = e->params->engine_joints && !told && !rc_runs(&e->rails);
  for (size_t i = 0; i < box; i++)
    level->field[i] = (rc_copy){NAN, NAN, NAN}, level->cost[i] = RC_NO_COST;
  if (e->params->engine_periods)
    RC_TRY(rc_find_periods(context, level, rc_halved(e->shorter_px, exponent), key,
                           RC_PERIOD_POINTS, regular, joints, &e->periods));
  if (e->params->engine_lattice && !lone)
    RC_TRY(rc_lattice_find(context, level, e->periods.copies, e->periods.count, &e->bends,
                           &e->lattice));
  if (regular && e->due && !e->periods.regular && !(e->periods.row && e->of_all.row)) take_due(e);
  /* Also where traits tell what brightness did not: beside a square lies another one. */
  if (e->periods.due) rc_conditions_forget_kin(&e->conditions);
  /* Where lines cross the hole there are things that go on as a whole. But whole copies that break
   * lines fit well, and must not win over those that continue them. */
  int with_lines = e->line_count ? half : 0, on_rails = rc_runs(&e->rails) ? half : 0;
  int rails_tried = e->rails.rows ? 2 : 1;
  int in_lattice = rc_has_lattice(&e->lattice) && !on_rails && plain > 1 ? half : 0;
  int by_periods =
      (e->periods.regular || e->periods.row) && !in_lattice && !on_rails && plain > 1 ? half : 0;
  if (in_lattice) plain = half;
  if (on_rails && e->keep_rails) {
    bool kept;
    RC_TRY(keep_to_rails(context, e, on_rails, level, scratch, &kept));
    if (kept) return RECEDE_OK;
  }
  int trials = plain + with_lines, whole = e->params->engine_whole ? with_lines / 2 : 0;
  rc_starts by_chance = {0, plain, plain, NULL, 0};
  rc_starts along_lines = {plain, trials - whole, trials, NULL, 0};
  RC_TRY(rc_trial_new(context, level, &best));
  if (trials == 1 && !in_lattice && !on_rails) {
    rc_pace p = {0, iterations};
    return rc_try_starts(context, e, &by_chance, &p, level, scratch, &best, &misfit);
  }
  rc_pace p = {0, rc_work_of_starts(plain, iterations) + rc_work_of_starts(with_lines, iterations) +
                      rc_work_of_starts(in_lattice, iterations) +
                      rc_work_of_starts(by_periods, iterations) +
                      rails_tried * rc_work_of_starts(on_rails, iterations)};
  RC_TRY(rc_try_starts(context, e, &by_chance, &p, level, scratch, &best, &misfit));
  if (by_periods)
    RC_TRY(try_periods(context, e, trials, by_periods, &p, level, scratch, &best, &misfit));
  if (on_rails) RC_TRY(try_rails(context, e, trials, on_rails, &p, level, scratch, misfit));
  if (in_lattice) RC_TRY(try_lattice(context, e, trials, in_lattice, &p, level, scratch, misfit));
  if (e->line_count && !e->on_rails && !e->on_lattice && !e->by_periods)
    RC_TRY(try_lines(context, e, &along_lines, &p, level, scratch, misfit));
  if (!e->on_rails && !e->continue_lines && !e->on_lattice) rc_trial_restore(level, &best);
  return RECEDE_OK;
}
