#include "synthesis/paper/loop.h"

#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/pyramid.h"
#include "synthesis/paper/search.h"
#include "synthesis/paper/update.h"

/* A tree of fewer neighbourhoods knows nothing of the texture: such a level or width is skipped. */
#define LEAST_WINDOWS 32

typedef struct run {
  rc_context *context;
  const rc_paper_settings *settings;
  uint64_t seed;
  bool same; /* exemplar and output are one picture */
  int level_count;
  rc_paper_level levels[RC_PAPER_MAX_LEVELS]; /* [0] the finest */
  rc_matches matches;                         /* of the last sweep */
  int matches_level;                          /* -1: none yet */
  double done, work; /* of the whole run, in sweeps over finest-level pixels */
} run;

static recede_status halve(run *r, const rc_side *fine, rc_side *coarse) {
  coarse->scale = rc_line_halved(&fine->scale);
  return rc_half(r->context, &fine->image, &fine->flags, &coarse->image, &coarse->flags);
}

static bool enough(const rc_side *exemplar, const rc_side *output) {
  int small_x =
      exemplar->image.width < output->image.width ? exemplar->image.width : output->image.width;
  int small_y =
      exemplar->image.height < output->image.height ? exemplar->image.height : output->image.height;
  return small_x > 2 && small_y > 2;
}

static recede_status build_levels(run *r, const rc_side *exemplar, const rc_side *output) {
  r->levels[0] = (rc_paper_level){*exemplar, *output, exemplar->image.channels};
  r->level_count = 1;
  while (r->level_count < r->settings->levels) {
    const rc_paper_level *fine = &r->levels[r->level_count - 1];
    rc_paper_level *coarse = &r->levels[r->level_count];
    if (!enough(&fine->exemplar, &fine->output)) break;
    coarse->colours = fine->colours;
    RC_TRY(halve(r, &fine->exemplar, &coarse->exemplar));
    coarse->output = coarse->exemplar;
    if (!r->same) RC_TRY(halve(r, &fine->output, &coarse->output));
    r->level_count++;
  }
  return RECEDE_OK;
}

/* RGBS: pictures of every level get the scale map as one more channel. */
static recede_status add_scale_channel(run *r) {
  for (int l = 0; l < r->level_count && r->settings->scale_channel; l++) {
    rc_paper_level *level = &r->levels[l];
    rc_side exemplar = level->exemplar, output = level->output;
    RC_TRY(rc_side_with_scale(r->context, &exemplar, &level->exemplar));
    level->output = level->exemplar;
    if (!r->same) RC_TRY(rc_side_with_scale(r->context, &output, &level->output));
  }
  return RECEDE_OK;
}

/* ------------------------------------------------------------------------------------ sweeps -- */

static double pixels_of(const rc_paper_level *level) {
  return (double)level->output.image.width * level->output.image.height;
}

/* Opens a stage over the i-th of n parts of the sweep that is running. */
static recede_status stage(const run *r, const char *name, double part, double end,
                           double sweep_work) {
  double from = (r->done + part * sweep_work) / r->work,
         to = (r->done + end * sweep_work) / r->work;
  return rc_stage(r->context, name, .06 + .9 * from, .06 + .9 * to);
}

static recede_status iterate(run *r, rc_paper_level *level, rc_paper_search *search,
                             rc_matches *matches, double sweep_work) {
  int count = r->settings->iterations, changed = 1;
  rc_histogram_weight histogram;
  recede_report *report = &r->context->report;
  for (int i = 0; i < count && changed; i++) {
    double from = .2 + .8 * i / count, middle = from + .6 / count, end = from + .8 / count;
    RC_TRY(stage(r, "search", from, middle, sweep_work));
    RC_TRY(rc_paper_search_run(r->context, search, matches, &changed));
    RC_TRY(stage(r, "update", middle, end, sweep_work));
    report->energy = rc_energy_weights(r->settings, search->least_distance, matches);
    report->iterations++;
    rc_histogram_compare(level, r->settings->histogram_gain, &histogram);
    RC_TRY(rc_paper_update(r->context, r->settings, matches, &histogram, level));
  }
  return RECEDE_OK;
}

/* The matches of the sweep before become this one's, and vote before anything is searched: their
 * pixels are the exemplar's own at this level, sharper than any interpolation. */
static recede_status vote_first(run *r, rc_paper_level *level, int index, rc_paper_search *search,
                                rc_matches *matches) {
  rc_histogram_weight histogram;
  if (r->matches_level < 0) return RECEDE_OK;
  if (r->matches_level - index > 1) return RECEDE_OK; /* a level between was skipped */
  bool coarser = r->matches_level > index;
  rc_matches_take(&r->matches, coarser ? 2 : 1, &search->windows, matches);
  if (!r->settings->vote_first) return RECEDE_OK;
  RC_TRY(rc_paper_search_measure(r->context, search, matches));
  rc_energy_weights(r->settings, search->least_distance, matches);
  rc_histogram_compare(level, r->settings->histogram_gain, &histogram);
  return rc_paper_update(r->context, r->settings, matches, &histogram, level);
}

/* One neighbourhood width at one level. The matches outlive the sweep, all else does not: they are
 * taken before the mark, and their grid is small. */
static recede_status sweep(run *r, int index, int width, double sweep_work) {
  rc_paper_level *level = &r->levels[index];
  rc_matches matches;
  rc_paper_search search;
  RC_TRY(stage(r, "tree", 0, .2, sweep_work));
  RC_TRY(rc_matches_new(r->context, &level->output.flags, width, &matches));
  rc_block *mark = rc_mark(r->context);
  uint64_t key = rc_key(r->seed, (uint32_t)(2 + index), (uint32_t)width);
  RC_TRY(rc_paper_search_prepare(r->context, r->settings, level, width, key, &search));
  RC_TRY(vote_first(r, level, index, &search, &matches));
  RC_TRY(iterate(r, level, &search, &matches, sweep_work));
  rc_release(r->context, mark);
  r->matches = matches;
  r->matches_level = index;
  return RECEDE_OK;
}

static recede_status fits(run *r, int index, int width, bool *yes) {
  const rc_paper_level *level = &r->levels[index];
  rc_windows windows;
  *yes = false;
  if (level->output.image.width < width || level->output.image.height < width) return RECEDE_OK;
  rc_block *mark = rc_mark(r->context);
  RC_TRY(
      rc_windows_find(r->context, &level->exemplar.image, &level->exemplar.flags, width, &windows));
  *yes = windows.count >= LEAST_WINDOWS;
  rc_release(r->context, mark);
  return RECEDE_OK;
}

/* The finest level must be swept whatever the size: its last width is halved until it fits, and
 * even a single source pixel fits at last. */
static recede_status sweep_smallest(run *r, int width) {
  const rc_paper_level *level = &r->levels[0];
  rc_windows windows = {0};
  for (;; width /= 2) {
    rc_block *mark = rc_mark(r->context);
    if (width <= level->output.image.width && width <= level->output.image.height)
      RC_TRY(rc_windows_find(r->context, &level->exemplar.image, &level->exemplar.flags, width,
                             &windows));
    rc_release(r->context, mark);
    if (windows.count || width <= 1) break;
  }
  return sweep(r, 0, width, pixels_of(level));
}

typedef struct plan {
  bool use[RC_PAPER_MAX_LEVELS][3];
} plan;

static recede_status make_plan(run *r, plan *p) {
  memset(p, 0, sizeof *p);
  for (int l = 0; l < r->level_count; l++)
    for (int i = 0; i < r->settings->width_count; i++) {
      RC_TRY(fits(r, l, r->settings->widths[i], &p->use[l][i]));
      if (p->use[l][i]) r->work += pixels_of(&r->levels[l]);
    }
  if (!(r->work > 0)) r->work = pixels_of(&r->levels[0]);
  return RECEDE_OK;
}

static bool any(const run *r, const plan *p, int level) {
  bool found = false;
  for (int i = 0; i < r->settings->width_count; i++) found |= p->use[level][i];
  return found;
}

recede_status rc_paper_run(rc_context *context, const rc_paper_settings *settings, uint64_t seed,
                           const rc_side *exemplar, bool same, rc_side *output) {
  run r = {
      .context = context, .settings = settings, .seed = seed, .same = same, .matches_level = -1};
  plan p;
  RC_TRY(rc_stage(context, "scale map", .05, .055));
  RC_TRY(build_levels(&r, exemplar, output));
  RC_TRY(add_scale_channel(&r));
  RC_TRY(make_plan(&r, &p));
  int coarsest = r.level_count - 1;
  while (coarsest > 0 && !any(&r, &p, coarsest)) coarsest--;
  RC_TRY(rc_stage(context, "start", .055, .06));
  RC_TRY(rc_paper_start(context, &r.levels[coarsest], seed));
  for (int l = coarsest; l >= 0; l--) {
    if (l < coarsest)
      rc_side_upsample(&r.levels[l + 1].output, r.levels[l].colours, &r.levels[l].output);
    for (int i = 0; i < settings->width_count; i++) {
      if (!p.use[l][i]) continue;
      RC_TRY(sweep(&r, l, settings->widths[i], pixels_of(&r.levels[l])));
      r.done += pixels_of(&r.levels[l]);
    }
  }
  if (!any(&r, &p, 0)) RC_TRY(sweep_smallest(&r, settings->widths[settings->width_count - 1]));
  output->image = r.levels[0].output.image;
  return RECEDE_OK;
}
