/* Method plane: the only file that knows the order of the stages.
 * sources near -> tone -> pyramid -> what is regular -> sources that look alike -> lines, rails,
 * boundary, gauge, regions -> sources without spots and strangers -> tracks -> conditions, layers
 * -> traits -> start -> (search <-> vote) per level, coarse to fine -> composition -> detail. */
#include "synthesis/fill_plane.h"

#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "image/distance.h"
#include "image/pyramid.h"
#include "image/tone.h"
#include "synthesis/composition/compose.h"
#include "synthesis/composition/detail.h"
#include "synthesis/kinds.h"
#include "synthesis/search/descent.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/gain.h"
#include "synthesis/search/lock.h"
#include "synthesis/search/regular.h"
#include "synthesis/search/rest.h"
#include "synthesis/search/traits.h"
#include "synthesis/sources/alike.h"
#include "synthesis/sources/layers.h"
#include "synthesis/sources/near.h"
#include "synthesis/sources/places.h"
#include "synthesis/sources/spots.h"
#include "synthesis/sources/strangers.h"
#include "synthesis/structure/boundary.h"
#include "synthesis/structure/branches.h"
#include "synthesis/structure/dash_rows.h"
#include "synthesis/structure/gauge.h"
#include "synthesis/structure/regions.h"
#include "synthesis/structure/tracks.h"

/* The coarsest hole is at least this far across: one level too many breaks regular patterns. */
#define COARSEST_HOLE_PX 18
/* A coarser level, or one with less source across, has too few places for a patch that lies wholly
 * in source. */
#define LEAST_LEVEL_PX 48
#define COARSEST_SOURCE_PX 24
/* The light's drift is that between sources of the hole's own scales and a little more. With the
 * sky in it a road gets blue. */
#define SCALES_BESIDE 1.3
/* The drift is measured again where such a part of the sources was something else. */
#define MUCH_TAKEN .05

static rc_chart chart_of(const rc_problem *problem, bool raised) {
  const rc_line *line = &problem->line;
  double x0 = (problem->target.x0 + problem->target.x1 - 1) / 2.;
  double y0 = (problem->target.y0 + problem->target.y1 - 1) / 2.;
  double square = line->a * line->a + line->b * line->b, excess = rc_w(line, x0, y0) - 1;
  if (square > 1e-16) x0 -= excess * line->a / square, y0 -= excess * line->b / square;
  return (rc_chart){(float)line->a, (float)line->b, (float)x0, (float)y0, raised, 0.f};
}

static rc_band own_scales(const rc_problem *problem) {
  const rc_line *line = &problem->line;
  rc_band band = {*line, INFINITY, 0};
  for (int y = problem->target.y0; y < problem->target.y1; y++)
    for (int x = problem->target.x0; x < problem->target.x1; x++) {
      if (!(*rc_flag(&problem->flags, x, y) & RC_TARGET)) continue;
      double w = rc_w(line, x, y);
      band.least = fmin(band.least, w), band.most = fmax(band.most, w);
    }
  band.least /= SCALES_BESIDE, band.most *= SCALES_BESIDE;
  return band;
}

static recede_status build_pyramid(rc_context *context, const rc_problem *problem,
                                   rc_image *residual, rc_descent *e) {
  bool deep;
  e->images[0] = *residual;
  e->flags[0] = problem->flags;
  e->level_count = 1;
  for (;;) {
    int last = e->level_count - 1;
    const rc_mask *flags = &e->flags[last];
    if (rc_halved(e->shorter_px, last) / 2 < LEAST_LEVEL_PX) return RECEDE_OK;
    RC_TRY(rc_is_deep(context, flags, RC_TARGET, COARSEST_HOLE_PX, &deep));
    if (!deep || e->level_count == RC_MAX_LEVELS) return RECEDE_OK;
    RC_TRY(rc_is_deep(context, flags, RC_SOURCE, COARSEST_SOURCE_PX, &deep));
    if (!deep) return RECEDE_OK;
    RC_TRY(rc_half(context, &e->images[last], &e->flags[last], &e->images[last + 1],
                   &e->flags[last + 1]));
    e->level_count++;
  }
}

static void drop_new_dashes(const rc_dash_rows *dashes, int before, rc_descent *e) {
  int added = e->line_count - before;
  rc_dash_rows_drop_lines(dashes, e->lines + before, &added);
  e->line_count = before + added;
}

static recede_status add_branches(rc_context *context, const rc_dash_rows *dashes, int from,
                                  rc_descent *e) {
  int before = e->line_count;
  RC_TRY(rc_branches_add(context, &e->images[from], &e->flags[from], from, &e->chart, e->lines,
                         &e->line_count));
  drop_new_dashes(dashes, before, e);
  return RECEDE_OK;
}

/* Lines that cross the hole, and whether the texture runs along them. */
static recede_status find_lines(rc_context *context, const rc_dash_rows *dashes, rc_descent *e) {
  int from = e->params->engine_lines ? rc_lines_level(e->flags, e->level_count) : -1;
  if (from < 0) return RECEDE_OK;
  float px = (float)(1 << (e->level_count - 1));
  rc_copy by[2];
  for (int k = 0; k < 2; k++)
    by[k] = (rc_copy){px * e->of_all.base[k].a, px * e->of_all.base[k].b, 0};
  /* A row tells nothing of what runs along it. */
  for (int n = from; n < e->level_count && n <= from + 1 && !e->line_count; n++)
    RC_TRY(rc_lines_find(context, &e->images[n], &e->flags[n], n, n > from, &e->chart,
                         e->due && !e->of_all.row ? by : NULL, e->lines, &e->line_count));
  rc_dash_rows_drop_lines(dashes, e->lines, &e->line_count);
  int before = e->line_count;
  RC_TRY(rc_leaving_add(context, &e->images[from], &e->flags[from], from, &e->chart, e->lines,
                        &e->line_count));
  drop_new_dashes(dashes, before, e);
  if (e->line_count > before) rc_crossings_keep_sure(e->lines, &e->line_count); /* chance is weak */
  /* A rail does not come again where its sleepers do. */
  e->due = e->due && !rc_crossings_have_lone(e->lines, e->line_count);
  /* Where there are dashes it is they that repeat, not what the lines lie on. */
  RC_TRY(rc_rails_find(context, e->images, e->flags, e->level_count, from, &e->chart, !dashes->told,
                       e->lines, &e->line_count, &e->rails));
  if (e->params->engine_boundary && !e->due)
    RC_TRY(rc_boundary_find(context, e->images, e->flags, e->level_count, from, &e->chart, e->lines,
                            &e->line_count, &e->rails, &e->sides));
  if (!rc_runs(&e->rails) && !e->due && e->params->engine_branches)
    RC_TRY(add_branches(context, dashes, from, e));
  if (!e->sides.boundary_count) rc_dash_rows_drop_lines(dashes, e->lines, &e->line_count);
  if (!e->params->engine_rails) e->rails = (rc_rails){0};
  if (rc_runs(&e->rails) && e->params->surface != RECEDE_SURFACE_RAISED && e->params->engine_gauge)
    RC_TRY(rc_gauge_find(context, e->images, e->flags, e->level_count, &e->chart, &e->rails));
  if (e->rails.rows) e->chart.raised = false; /* boards of one width lie */
  return RECEDE_OK;
}

/* Rows of dashes: those of all sources, however unlike what lies beside the hole. */
static recede_status find_dashes(rc_context *context, const rc_problem *problem,
                                 const rc_descent *e, rc_dash_rows *rows) {
  int from = e->params->engine_dashes && !problem->synthesis
                 ? rc_lines_level(e->flags, e->level_count)
                 : -1;
  const recede_plane *plane = &problem->plane;
  rc_chart chart = chart_of(problem, false);
  if (from < 0) return RECEDE_OK;
  rc_ground ground = rc_ground_of(
      &chart, (double)chart.x0 + problem->origin_x - (plane->width - 1) / 2.,
      (double)chart.y0 + problem->origin_y - (plane->height - 1) / 2., plane->focal_px);
  RC_TRY(rc_dash_rows_find(context, &e->images[from], &e->flags[from], &ground, from, rows));
  return rc_poll(context);
}

/* Before anything is called foreign: the sources that would be taken tell it, too. */
static recede_status find_due(rc_context *context, const rc_problem *problem, rc_descent *e) {
  rc_chart flat = chart_of(problem, false);
  const recede_params *params = e->params;
  float gain;
  /* Moves by periods lie flat. */
  if (!params->engine_regular || !params->engine_periods ||
      params->surface == RECEDE_SURFACE_RAISED)
    return RECEDE_OK;
  RC_TRY(rc_find_gain(context, &e->images[0], &problem->flags, &gain));
  RC_TRY(rc_periods_of_all(context, e->images, e->flags, e->level_count, e->shorter_px, &flat, gain,
                           rc_key((uint64_t)e->params->seed, 95, 0), &e->of_all));
  e->due = e->of_all.due;
  return RECEDE_OK;
}

/* Two textures in the hole that no line tells apart, or of which one has two edges. Those that run
 * by their lines are boards; by what lies beside the hole alone a deck runs beside water, too. */
static recede_status find_regions(rc_context *context, rc_descent *e) {
  int last = e->level_count - 1, chords;
  rc_regions regions;
  bool two;
  e->sides.px = 1;
  bool boards = rc_runs(&e->rails) && e->line_count;
  if (!e->params->engine_regions || e->due || boards) return RECEDE_OK;
  rc_chart chart = rc_chart_coarser(e->chart, last);
  RC_TRY(
      rc_regions_find(context, &e->images[last], &e->flags[last], &chart, &regions, &two, &chords));
  e->sides.apart = two && (chords || rc_has_sides(&e->sides));
  if (!chords || (rc_has_sides(&e->sides) && chords == 1)) return RECEDE_OK;
  regions.px = (float)(1 << last);
  e->sides.boundary_count = 0;
  /* A faint edge of a path of bricks, moved in by itself, would break their courses. */
  rc_crossings_drop_faint(e->lines, &e->line_count);
  e->sides.regions = regions;
  return RECEDE_OK;
}

static void count_shortfall(rc_context *context, const rc_descent *e, const rc_level *level,
                            rc_shortfall *shortfall) {
  recede_report *report = &context->report;
  uint64_t missing = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      rc_copy copy = level->field[rc_level_at(level, x, y)];
      if (isnan(copy.a)) {
        missing++;
        if (e->rest) e->rest[(size_t)y * (size_t)level->width + (size_t)x] = 2;
        continue;
      }
      rc_place place =
          rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
      if (e->rest && e->rest[(size_t)y * (size_t)level->width + (size_t)x]) continue;
      if (place.ratio < .8f) report->magnified_pixels++;
      if (1 / place.ratio > report->largest_magnification)
        report->largest_magnification = 1 / place.ratio;
    }
  shortfall->continued = e->rest_count - missing;
  shortfall->missing = missing;
}

/* The guide itself, for the ablation: what the averaging of votes alone would give. A level that
 * was not searched has none. */
static void take_guide(const rc_descent *e, const rc_level *level, rc_image *residual) {
  if (!level->pixels) return;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      uint32_t pixel = level->pixels[(size_t)y * (size_t)level->width + (size_t)x];
      for (int k = 0; k < residual->channels; k++)
        rc_pixel(residual, x, y)[k] = ((float)(pixel >> 8 * k & 255) - 128.f) / e->gain;
    }
}

/* Whatever is not asked for any more is given back: at 12 MP what the search compares is 40 MB, the
 * pyramid as much. */
static recede_status compose(rc_context *context, rc_descent *e, rc_level *finest,
                             rc_image *residual) {
  rc_sampler *sampler;
  if (!e->params->engine_composition) take_guide(e, finest, residual);
  RC_FREE(context, &finest->pixels);
  RC_FREE(context, &finest->weight);
  if (e->params->engine_composition) {
    RC_TRY(RC_NEW(context, 1, &sampler));
    rc_sampler_init(sampler, !e->params->engine_spline);
    RC_TRY(rc_compose(context, finest, sampler, e->images, e->level_count,
                      e->params->engine_join ? &rc_effort_of(e->params)->join : NULL, residual));
  }
  for (int n = 1; n < e->level_count; n++) RC_FREE(context, &e->images[n].data);
  return RECEDE_OK;
}

/* Takes away what looks unlike all that is beside the hole. A drift was measured on that, too: with
 * a sky in it sand gets grey. So it is measured once more. None is now that was not before: of dark
 * boards alone, light ones taken away, the light seems to drift. */
static recede_status keep_alike(rc_context *context, const rc_problem *problem, const rc_band *band,
                                rc_tone *tone, rc_image *filled, rc_block *pyramid, rc_descent *e) {
  double taken;
  RC_TRY(rc_keep_alike(context, band, e->images, e->flags, e->level_count, &taken));
  if (taken < MUCH_TAKEN || !rc_tone_drifts(tone)) return RECEDE_OK;
  RC_TRY(rc_tone_apply(context, tone, &problem->flags, RC_KNOWN, 1, filled));
  RC_TRY(rc_tone_fit(context, filled, &problem->flags, band, e->params->engine_tone, tone));
  RC_TRY(rc_tone_apply(context, tone, &problem->flags, RC_KNOWN, -1, filled));
  rc_release(context, pyramid);
  return build_pyramid(context, problem, filled, e);
}

/* Takes faint bands away from all levels. Boards and two textures have edges of their own. */
static recede_status take_tracks(rc_context *context, const rc_descent *e, const rc_tone *tone,
                                 rc_tracks *tracks) {
  double brightness = 0; /* that of the tone in the picture's middle */
  if (rc_runs(&e->rails) || rc_has_sides(&e->sides)) return RECEDE_OK;
  for (int k = 0; k < tone->channels; k++) brightness += fabs(tone->terms[k][0]) / tone->channels;
  RC_TRY(
      rc_tracks_find(context, e->images, e->flags, e->level_count, &e->chart, brightness, tracks));
  for (int n = 0; n < e->level_count; n++) {
    rc_chart chart = rc_chart_coarser(e->chart, n);
    rc_image image = e->images[n];
    RC_TRY(rc_tracks_apply(context, tracks, &chart, n, &e->flags[n], RC_KNOWN, -1, &image));
  }
  return RECEDE_OK;
}

recede_status rc_fill_plane(rc_context *context, const rc_problem *problem,
                            const recede_params *params, bool restored, rc_image *filled,
                            rc_shortfall *shortfall, rc_known_rails *known) {
  rc_descent e = {.params = params,
                  .cut_x = problem->cut_x,
                  .cut_y = problem->cut_y,
                  .shorter_px = problem->shorter_px,
                  .kernels = rc_kernels_select(context->host.kernel),
                  .take_beside = params->engine_beside && !problem->synthesis,
                  .rest = shortfall->rest};
  bool raised = true;
  rc_tone tone;
  rc_tracks tracks = {.alike = 0};
  rc_dash_rows dashes = {.count = 0};
  rc_level finest;
  if (!e.kernels)
    return rc_fail(context, RECEDE_ARGUMENT, "This machine has no kernel %d.",
                   context->host.kernel);
  RC_TRY(rc_stage(context, "tone", .05, .07));
  rc_mask flags = problem->flags;
  rc_allow_sources(&flags);
  rc_band band = own_scales(problem);
  if (params->engine_near && !problem->synthesis)
    RC_TRY(rc_keep_near(context, &problem->flags, &problem->target, &band));
  RC_TRY(rc_tone_fit(context, filled, &problem->flags, &band, params->engine_tone, &tone));
  RC_TRY(rc_tone_apply(context, &tone, &problem->flags, RC_KNOWN, -1, filled));
  RC_TRY(rc_stage(context, "pyramid", .07, .1));
  rc_block *pyramid = rc_mark(context);
  RC_TRY(build_pyramid(context, problem, filled, &e));
  RC_TRY(find_dashes(context, problem, &e, &dashes));
  RC_TRY(rc_choose_surface(context, problem, e.images, e.flags, e.level_count, params->surface,
                           &raised));
  RC_TRY(find_due(context, problem, &e));
  if (params->engine_alike && !problem->synthesis && !e.due)
    RC_TRY(keep_alike(context, problem, &band, &tone, filled, pyramid, &e));
  RC_TRY(rc_find_gain(context, filled, &problem->flags, &e.gain));
  /* Again, for it is the texture's that counts; what is alike may be too little to tell. */
  RC_TRY(rc_choose_surface(context, problem, e.images, e.flags, e.level_count, params->surface,
                           &raised));
  e.chart = chart_of(problem, raised);
  if (rc_runs(&known->rails)) {
    e.rails = rc_rails_in_chart(known, &e.chart);
    e.keep_rails = known->kept;
  } else {
    RC_TRY(find_lines(context, &dashes, &e));
    RC_TRY(find_regions(context, &e));
  }
  /* After the lines: a road's own dashes tell whether what crosses the hole repeats. */
  if (params->engine_spots && !problem->synthesis && !e.due) {
    RC_TRY(rc_drop_spots(context, &band, e.images, e.flags, e.level_count));
    RC_TRY(rc_drop_strangers(context, &band, e.images, e.flags, e.level_count));
  }
  if (params->engine_tracks && !problem->synthesis)
    RC_TRY(take_tracks(context, &e, &tone, &tracks));
  /* Of a plane that recedes only the hole's own scales are copied, which keeps sky from ground; a
   * price on light would only leave fewer sources. */
  bool frontal = problem->line.a == 0 && problem->line.b == 0;
  RC_TRY(rc_conditions_find(context, e.images, e.flags, e.level_count, &tone,
                            127 / (RC_GAIN_DEVIATIONS * e.gain), params->engine_focus,
                            params->engine_kin && !problem->synthesis && !e.due,
                            params->engine_light && frontal, &e.conditions));
  if (params->engine_layers && frontal && !problem->synthesis && !e.due)
    RC_TRY(rc_layers_find(context, &e.images[e.level_count - 1], &e.flags[e.level_count - 1],
                          e.level_count - 1, &tone, &e.layers));
  if (params->engine_texture)
    RC_TRY(rc_traits_find(context, e.images, e.flags, e.level_count, &e.chart, e.traits));
  /* After all that looks at what may be copied: a dash beside the hole says how much may stand out
   * there. */
  for (int n = 0; n < e.level_count; n++) rc_dash_rows_take(&dashes, n, &e.flags[n]);
  RC_TRY(rc_lines_take(context, e.lines, e.line_count, &e.chart, e.flags, e.level_count,
                       &e.lines_taken));
  /* Where there are two sides no tracks are looked for. */
  if (params->engine_boundary && !e.due && !rc_runs(&e.rails))
    rc_boundary_of_band(&e.chart, e.lines, e.line_count, &e.sides);
  /* What comes again or runs along boards shows itself up to the horizon. */
  if (params->engine_standing && params->surface == RECEDE_SURFACE_AUTO && !e.chart.raised &&
      !problem->synthesis && !e.due && !rc_runs(&e.rails))
    RC_TRY(rc_find_standing(context, problem, e.images, e.flags, e.level_count, &e.chart));
  rc_rails found = e.rails;
  RC_TRY(rc_descend(context, &e, &finest));
  RC_TRY(rc_dash_rows_lay(context, &dashes, &finest));
  if (e.rest) rc_rest_forget_laid(&finest, e.rest, &e.rest_count);
  if (!rc_runs(&known->rails) && !rc_has_sides(&e.sides))
    *known = (rc_known_rails){e.on_rails ? e.rails : found, e.chart, e.on_rails};
  context->report.surface = e.chart.raised ? RECEDE_SURFACE_RAISED : RECEDE_SURFACE_FLAT;
  RC_TRY(rc_stage(context, "composition", .8, .93));
  RC_TRY(compose(context, &e, &finest, filled));
  RC_TRY(rc_stage(context, "detail", .93, .97));
  if (params->engine_detail) RC_TRY(rc_match_detail(context, &finest, filled));
  count_shortfall(context, &e, &finest, shortfall);
  rc_lines_give_back(&problem->flags);
  const uint8_t which = restored ? RC_TARGET | RC_KNOWN : RC_TARGET;
  RC_TRY(rc_tracks_apply(context, &tracks, &e.chart, 0, &problem->flags, which, 1, filled));
  return rc_tone_apply(context, &tone, &problem->flags, which, 1, filled);
}
