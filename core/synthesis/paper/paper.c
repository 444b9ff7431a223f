/* Methods paper and kwatra: from the problem to the paper's exemplar and output, and back. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/paper/loop.h"
#include "synthesis/paper/scale_channel.h"

/* The baseline knows no scale. */
static const rc_line no_scale = {0, 0, 1};

/* The paper's S_max = 1 / cos(slant) has no value from 90 degrees on. */
static recede_status check_slant(rc_context *context, const recede_plane *plane,
                                 const recede_params *params) {
  double slant, tilt, fov;
  recede_plane_angles(plane, &slant, &tilt, &fov);
  if (slant < 90 || params->method == RECEDE_METHOD_KWATRA) return RECEDE_OK;
  return rc_fail(context, RECEDE_ARGUMENT,
                 "Method paper needs a slant below 90 degrees, this plane has %.1f: the horizon "
                 "lies on the near side of the picture's centre. Use method plane.",
                 slant);
}

/* S of a fill. As printed: eq. 3 over the whole picture. Repaired: w, the exact scale across the
 * tilt. Its lines of equal value are the same (both are linear along the tilt), so the start is the
 * same; but what another scale costs is then a true ratio of sizes, whatever the field of view and
 * wherever the horizon lies. Eq. 1's range, 1 / cos to cos, knows neither: near a horizon inside
 * the picture it would call texels alike that differ tenfold. */
static rc_line scale_of_fill(const rc_problem *problem, const recede_params *params) {
  if (params->method == RECEDE_METHOD_KWATRA) return no_scale;
  if (!params->paper_literal) return problem->line;
  rc_line whole = rc_scale_channel(&problem->plane);
  return rc_scale_moved(&whole, problem->origin_x, problem->origin_y);
}

/* Levels of a repaired fill: in the coarsest a 16 x 16 neighbourhood reaches across the hole, so
 * that what is on both sides of it meets there. (Measured: the stones of a 500 px hole are whole
 * with 6 levels, merged with 4; bricks and gravel of 130 px gain a few points from 5.) */
#define COARSEST_HOLE_PX 16
static int levels_of_hole(rc_box hole) {
  int width = hole.x1 - hole.x0, height = hole.y1 - hole.y0, levels = 1;
  int longer = width > height ? width : height;
  while (longer > COARSEST_HOLE_PX && levels < RC_PAPER_MAX_LEVELS)
    longer = (longer + 1) / 2, levels++;
  return levels;
}

recede_status rc_fill_paper(rc_context *context, const rc_problem *problem,
                            const recede_params *params, rc_image *filled) {
  rc_paper_settings settings = rc_paper_settings_of(params);
  RC_TRY(check_slant(context, &problem->plane, params));
  if (params->method == RECEDE_METHOD_PAPER && !params->paper_literal && !params->paper_levels)
    settings.levels = levels_of_hole(problem->target);
  rc_side picture = {*filled, problem->flags, scale_of_fill(problem, params)}, made = picture;
  RC_TRY(rc_paper_run(context, &settings, (uint64_t)params->seed, &picture, true, &made));
  for (int y = problem->target.y0; y < problem->target.y1; y++)
    for (int x = problem->target.x0; x < problem->target.x1; x++)
      if (*rc_flag(&problem->flags, x, y) & RC_TARGET)
        memcpy(rc_pixel(filled, x, y), rc_pixel(&made.image, x, y),
               (size_t)filled->channels * sizeof(float));
  return RECEDE_OK;
}

static recede_status check_sources(rc_context *context, const rc_mask *flags) {
  size_t pixels = (size_t)flags->width * (size_t)flags->height;
  for (size_t i = 0; i < pixels; i++)
    if (flags->data[i] & RC_SOURCE) return RECEDE_OK;
  return rc_fail(context, RECEDE_EMPTY_SOURCE,
                 "Nothing is left to copy from: no pixel of the exemplar is opaque, finite and "
                 "inside the source region. Widen the source region.");
}

recede_status rc_synthesize_paper(rc_context *context, const rc_image *exemplar,
                                  const rc_mask *flags, const recede_plane *plane,
                                  const recede_params *params, rc_image *result) {
  rc_paper_settings settings = rc_paper_settings_of(params);
  RC_TRY(check_slant(context, plane, params));
  RC_TRY(check_sources(context, flags));
  rc_line scale = params->method == RECEDE_METHOD_KWATRA ? no_scale : rc_scale_channel(plane);
  rc_side from = {*exemplar, *flags, scale}, to = {.image = *result};
  to.scale =
      rc_scale_resampled(&scale, exemplar->width, exemplar->height, result->width, result->height);
  RC_TRY(rc_mask_new(context, result->width, result->height, &to.flags));
  memset(to.flags.data, RC_TARGET, (size_t)result->width * (size_t)result->height);
  RC_TRY(rc_paper_run(context, &settings, (uint64_t)params->seed, &from, false, &to));
  for (int y = 0; y < result->height; y++)
    for (int x = 0; x < result->width; x++)
      memcpy(rc_pixel(result, x, y), rc_pixel(&to.image, x, y),
             (size_t)result->channels * sizeof(float));
  return RECEDE_OK;
}

/* Bytes of the largest tree: members' vectors, two nodes a member with a centroid each; or, in the
 * raw space of the baseline, few nodes with long centroids. */
static uint64_t bytes_of_tree(uint64_t pixels, const rc_paper_settings *settings, int channels) {
  uint64_t most = settings->pca ? RC_MOST_MEMBERS : RC_MOST_RAW_MEMBERS;
  uint64_t members = pixels < most ? pixels : most, widest = (uint64_t)settings->widths[0];
  uint64_t nodes = settings->tree_stop > 0 ? 4096 : 2 * members;
  uint64_t inputs = (settings->pca ? 64 : widest * widest) * (uint64_t)channels + 16;
  uint64_t vectors = settings->pca ? members + 2 * 2048 : 64;
  uint64_t eigen = settings->pca ? 2 * 8 * (inputs + 4) * (inputs + 4) : 0;
  return 4 * inputs * (vectors + (nodes < 2 * members ? nodes : 2 * members) + 64) + members * 24 +
         nodes * 24 + eigen;
}

/* exemplar_pixels: of both sides, and as many again in the coarser levels. */
uint64_t rc_paper_bytes(uint64_t exemplar_pixels, int channels, const recede_params *params) {
  rc_paper_settings settings = rc_paper_settings_of(params);
  uint64_t narrow = (uint64_t)settings.widths[settings.width_count - 1];
  uint64_t step = narrow >= 4 ? narrow / 4 : 1, wide = (uint64_t)channels + settings.scale_channel;
  uint64_t pyramid = 4 * (uint64_t)channels + 1 + (settings.scale_channel ? 6 * wide : 0);
  uint64_t matches = 56 / (step * step) + 1, start = settings.levels < 2 ? 16 : 4;
  return exemplar_pixels * (pyramid + matches + start + 4) + ((uint64_t)2 << 20) +
         bytes_of_tree(exemplar_pixels, &settings, (int)wide);
}
