#include "synthesis/problem_build.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/view.h"
#include "synthesis/lay.h"

/* The margin around a hole: small ones need several texels, whatever their size; large ones hold
 * many themselves. */
#define LEAST_MARGIN_PX 300
#define MARGIN_OF_HOLE .5
/* So much of a source mask within it is enough. */
#define NEAR_ENOUGH_PX (64 * 64)
/* Target pixels with less than this part of the nearest target pixel's w are not on the plane: a
 * texel there is a hundredth of a px per px of the nearest. */
#define LEAST_W_OF_TARGET .01
/* Source with less than this part of w at the hole is below any use (mip level 5). */
#define LEAST_W_OF_SOURCE .03
/* The coarsest level's hole is at least 18 px across, and its patches see 4 px of what lies beside
 * it and 2 more: a third of the hole's width. Where the picture seems to end, lines may, too. */
#define BESIDE_OF_HOLE 2
#define LEAST_BESIDE_PX 64
/* So that pixels of the six finest levels are what they would be. */
#define ALIGNMENT_PX 64
/* The mask's ring: edges of what was removed bleed this far. */
#define UNTRUSTED_RING_PX 2

static bool is_below(const double line[4], int x, int y) {
  return !line || y > line[1] + (line[3] - line[1]) / (line[2] - line[0]) * (x - line[0]);
}

recede_status rc_sum_target(rc_context *context, const recede_view *mask, rc_box within,
                            const double line[4], rc_target_summary *summary) {
  double sum_x = 0, sum_y = 0;
  float *row;
  *summary = (rc_target_summary){.box = {mask->width, mask->height, 0, 0}};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, mask->width, &row));
  for (int y = within.y0; y < within.y1; y++) {
    rc_view_read(mask, within.x0, y, within.x1 - within.x0, row);
    for (int x = within.x0; x < within.x1; x++) {
      if (!(row[x - within.x0] > 0) || !is_below(line, x, y)) continue;
      rc_box *box = &summary->box;
      if (x < box->x0) box->x0 = x;
      if (x >= box->x1) box->x1 = x + 1;
      if (y < box->y0) box->y0 = y;
      box->y1 = y + 1;
      summary->pixels++;
      sum_x += x;
      sum_y += y;
    }
  }
  rc_release(context, mark);
  summary->x = sum_x / fmax((double)summary->pixels, 1);
  summary->y = sum_y / fmax((double)summary->pixels, 1);
  return RECEDE_OK;
}

recede_status rc_summarize_target(rc_context *context, const recede_view *mask,
                                  rc_target_summary *summary) {
  rc_box all = {0, 0, mask->width, mask->height};
  RC_TRY(rc_sum_target(context, mask, all, NULL, summary));
  if (summary->pixels) return RECEDE_OK;
  return rc_fail(context, RECEDE_EMPTY_TARGET,
                 "The mask selects nothing: all its pixels are black. Paint what is to be filled "
                 "white.");
}

recede_status rc_look_around(rc_context *context, const rc_views *views,
                             rc_target_summary *summary) {
  int width = views->image->width, height = views->image->height, near = 0;
  double margin = MARGIN_OF_HOLE * rc_longer_side(summary->box) + LEAST_MARGIN_PX;
  rc_box around = rc_box_grown(summary->box, (int)fmin(margin, 1 << 20), width, height);
  rc_box all = around;
  float *source, *target;
  summary->looked_at = around;
  if (!views->source) return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, width, &source));
  RC_TRY(RC_NEW(context, width, &target));
  for (int y = 0; y < height && near < NEAR_ENOUGH_PX; y++) {
    rc_view_read(views->source, 0, y, width, source);
    rc_view_read(views->mask, 0, y, width, target);
    for (int x = 0; x < width; x++) {
      if (!(source[x] > .5f) || target[x] > 0) continue;
      near += x >= around.x0 && x < around.x1 && y >= around.y0 && y < around.y1;
      all = (rc_box){x < all.x0 ? x : all.x0, y < all.y0 ? y : all.y0, x >= all.x1 ? x + 1 : all.x1,
                     y >= all.y1 ? y + 1 : all.y1};
    }
    RC_TRY(rc_poll(context));
  }
  rc_release(context, mark);
  if (near < NEAR_ENOUGH_PX) summary->looked_at = all;
  return RECEDE_OK;
}

/* The plane's w in the problem's coordinates, in units of its value at (x, y) of the whole. */
static rc_line line_of(const recede_plane *plane, int origin_x, int origin_y, double x, double y) {
  double unit = recede_plane_w(plane, x, y), f = plane->focal_px;
  return (rc_line){plane->normal[0] / f / unit, plane->normal[1] / f / unit,
                   recede_plane_w(plane, origin_x, origin_y) / unit};
}

typedef struct reading {
  const rc_views *views;
  rc_problem *problem;
  float *values, *scratch; /* a row of each for every thread */
  int *nonfinite;          /* of each row */
} reading;

static void read_row(void *user, int y, int thread) {
  const reading *r = user;
  rc_problem *problem = r->problem;
  int width = problem->image.width, channels = r->views->image->channels,
      colours = channels < 3 ? 1 : 3;
  float *values = r->values + (size_t)thread * (size_t)width * (size_t)channels;
  float *scratch = r->scratch + (size_t)thread * (size_t)width;
  uint8_t *flags = rc_flag(&problem->flags, 0, y);
  rc_view_read(r->views->image, problem->origin_x, problem->origin_y + y, width, values);
  r->nonfinite[y] = rc_classify_row(r->views, problem->origin_x, problem->origin_y + y, width,
                                    values, scratch, flags);
  /* What is not known is written, too: a page that was read first, as 0, would cost the write that
   * fills it a fault that all threads wait for. */
  for (int x = 0; x < width; x++)
    for (int k = 0; k < colours; k++)
      rc_pixel(&problem->image, x, y)[k] = flags[x] & RC_KNOWN ? values[x * channels + k] : 0.f;
}

static recede_status read_pixels(rc_context *context, const rc_views *views, rc_problem *problem) {
  size_t width = (size_t)problem->image.width, threads = (size_t)context->threads;
  reading r = {.views = views, .problem = problem};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, threads * width * (size_t)views->image->channels, &r.values));
  RC_TRY(RC_NEW(context, threads * width, &r.scratch));
  RC_TRY(RC_NEW(context, problem->image.height, &r.nonfinite));
  RC_TRY(rc_parallel(context, problem->image.height, read_row, &r));
  for (int y = 0; y < problem->image.height; y++)
    context->report.nonfinite_pixels += (uint64_t)r.nonfinite[y];
  rc_release(context, mark);
  return RECEDE_OK;
}

/* w where the target comes nearest, and its centroid on the plane. */
static double nearest_w(const rc_problem *problem, double *x, double *y) {
  double nearest = 0, sum_x = 0, sum_y = 0, count = 0;
  rc_box box = rc_box_of(&problem->flags, RC_TARGET);
  for (int py = box.y0; py < box.y1; py++)
    for (int px = box.x0; px < box.x1; px++) {
      if (!(*rc_flag(&problem->flags, px, py) & RC_TARGET)) continue;
      double w = recede_plane_w(&problem->plane, problem->origin_x + px, problem->origin_y + py);
      if (w <= 0) continue;
      nearest = fmax(nearest, w);
      sum_x += px, sum_y += py, count++;
    }
  if (count > 0) *x = problem->origin_x + sum_x / count, *y = problem->origin_y + sum_y / count;
  return nearest;
}

/* Takes target pixels beyond the horizon out; sets target box. The least w of those left. */
static double refuse_beyond(rc_context *context, rc_problem *problem, double least_target_w) {
  rc_box *box = &problem->target, all = rc_box_of(&problem->flags, RC_TARGET);
  double least = INFINITY;
  *box = (rc_box){problem->flags.width, problem->flags.height, 0, 0};
  for (int y = all.y0; y < all.y1; y++)
    for (int x = all.x0; x < all.x1; x++) {
      uint8_t *flag = rc_flag(&problem->flags, x, y);
      double w = rc_w(&problem->line, x, y);
      if (!(*flag & RC_TARGET)) continue;
      if (w < least_target_w) {
        *flag = 0;
        context->report.refused_pixels++;
        continue;
      }
      context->report.filled_pixels++;
      least = fmin(least, w);
      if (x < box->x0) box->x0 = x;
      if (x >= box->x1) box->x1 = x + 1;
      if (y < box->y0) box->y0 = y;
      box->y1 = y + 1;
    }
  return least;
}

/* Source that is too far away is none, unless target is as far. */
static void refuse_far_source(rc_problem *problem, double least_target_w) {
  double least = fmin(LEAST_W_OF_SOURCE, least_target_w);
  int last = problem->flags.width - 1;
  for (int y = 0; y < problem->flags.height; y++) {
    /* Along a row w only grows, or only falls. */
    if (rc_w(&problem->line, 0, y) >= least && rc_w(&problem->line, last, y) >= least) continue;
    for (int x = 0; x <= last; x++)
      if (rc_w(&problem->line, x, y) < least)
        *rc_flag(&problem->flags, x, y) &= (uint8_t)~RC_SOURCE;
  }
}

/* Target that has target, or the picture's end, on its four sides. */
static bool is_inner(const rc_mask *flags, int x, int y) {
  const uint8_t *flag = rc_flag(flags, x, y);
  ptrdiff_t row = flags->width;
  return (x == 0 || flag[-1] & RC_TARGET) && (x == flags->width - 1 || flag[1] & RC_TARGET) &&
         (y == 0 || flag[-row] & RC_TARGET) && (y == flags->height - 1 || flag[row] & RC_TARGET);
}

static void distrust_ring(rc_mask *flags) {
  rc_box box = rc_box_of(flags, RC_TARGET);
  for (int y = box.y0; y < box.y1; y++)
    for (int x = box.x0; x < box.x1; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET) || is_inner(flags, x, y)) continue;
      for (int dy = -UNTRUSTED_RING_PX; dy <= UNTRUSTED_RING_PX; dy++)
        for (int dx = -UNTRUSTED_RING_PX; dx <= UNTRUSTED_RING_PX; dx++)
          if (rc_inside(flags->width, flags->height, x + dx, y + dy))
            *rc_flag(flags, x + dx, y + dy) &= (uint8_t)~RC_SOURCE;
    }
}

static recede_status check_source(rc_context *context, const rc_problem *problem) {
  size_t pixels = (size_t)problem->flags.width * (size_t)problem->flags.height;
  for (size_t i = 0; i < pixels; i++)
    if (problem->flags.data[i] & RC_SOURCE) return RECEDE_OK;
  if (problem->synthesis)
    return rc_fail(
        context, RECEDE_EMPTY_SOURCE,
        "Nothing is left to copy from: the exemplar is too small, or too little of it is "
        "opaque, finite, on the plane and inside the source region.");
  return rc_fail(
      context, RECEDE_EMPTY_SOURCE,
      "Nothing is left to copy from: no pixel more than %d px from the mask is opaque, finite, on "
      "the plane and inside the source region. Mask less or widen the source region.",
      UNTRUSTED_RING_PX);
}

/* Of the box what lies on the plane's side of the horizon, and so much beside it as patches of the
 * coarsest level reach, and lines are looked for: skies are often half of a picture. */
static rc_box before_horizon(const recede_plane *plane, rc_box box, rc_box target) {
  int px = rc_shorter_side(target) / BESIDE_OF_HOLE + LEAST_BESIDE_PX;
  rc_box on = {box.x1, box.y1, box.x0, box.y0};
  for (int y = box.y0; y < box.y1; y++)
    if (fmax(recede_plane_w(plane, box.x0, y), recede_plane_w(plane, box.x1 - 1, y)) > 0)
      on.y0 = y < on.y0 ? y : on.y0, on.y1 = y + 1;
  for (int x = box.x0; x < box.x1; x++)
    if (fmax(recede_plane_w(plane, x, box.y0), recede_plane_w(plane, x, box.y1 - 1)) > 0)
      on.x0 = x < on.x0 ? x : on.x0, on.x1 = x + 1;
  if (on.x1 <= on.x0) return box; /* nothing: that is told later */
  on = (rc_box){on.x0 - px, on.y0 - px, on.x1 + px, on.y1 + px};
  if (on.x0 > box.x0) on.x0 -= (on.x0 - box.x0) % ALIGNMENT_PX;
  if (on.y0 > box.y0) on.y0 -= (on.y0 - box.y0) % ALIGNMENT_PX;
  return rc_box_common(box, on);
}

recede_status rc_problem_of_fill(rc_context *context, const rc_views *views,
                                 const recede_plane *plane, const rc_target_summary *summary,
                                 rc_problem *problem) {
  rc_box box = before_horizon(plane, summary->looked_at, summary->box);
  double x = summary->x, y = summary->y;
  *problem = (rc_problem){.plane = *plane,
                          .origin_x = box.x0,
                          .origin_y = box.y0,
                          .cut_x = box.x0 - summary->looked_at.x0,
                          .cut_y = box.y0 - summary->looked_at.y0,
                          .shorter_px = rc_shorter_side(summary->looked_at)};
  int colours = views->image->channels < 3 ? 1 : 3;
  RC_TRY(rc_image_new(context, box.x1 - box.x0, box.y1 - box.y0, colours, &problem->image));
  RC_TRY(rc_mask_new(context, box.x1 - box.x0, box.y1 - box.y0, &problem->flags));
  RC_TRY(read_pixels(context, views, problem));
  double nearest = nearest_w(problem, &x, &y);
  if (!(nearest > 0))
    return rc_fail(
        context, RECEDE_EMPTY_TARGET,
        "All %llu px of the mask lie beyond the horizon: there is no plane to fill. Move "
        "the horizon or fill with the frontal orientation.",
        (unsigned long long)summary->pixels);
  problem->line = line_of(plane, box.x0, box.y0, x, y);
  double least_w = LEAST_W_OF_TARGET * nearest / recede_plane_w(plane, x, y);
  refuse_far_source(problem, refuse_beyond(context, problem, least_w));
  /* Some may lie farther beyond it than is read. */
  context->report.refused_pixels = summary->pixels - context->report.filled_pixels;
  distrust_ring(&problem->flags);
  if (context->report.refused_pixels)
    rc_warn(
        context,
        "%llu of %llu px of the mask lie beyond the horizon and were left as they were. Fill them "
        "in a second run, with the frontal orientation or on a plane of their own.",
        (unsigned long long)context->report.refused_pixels, (unsigned long long)summary->pixels);
  return check_source(context, problem);
}

/* All of a view as a problem has it. */
static recede_status read_all(rc_context *context, const rc_views *views, rc_problem *part) {
  int width = views->image->width, height = views->image->height;
  int colours = views->image->channels < 3 ? 1 : 3;
  *part = (rc_problem){.origin_x = 0, .origin_y = 0};
  RC_TRY(rc_image_new(context, width, height, colours, &part->image));
  RC_TRY(rc_mask_new(context, width, height, &part->flags));
  return read_pixels(context, views, part);
}

/* The exemplar as it is, or what the result has room for. */
static recede_status put_in_middle(rc_context *context, const rc_views *exemplar,
                                   rc_problem *problem) {
  int width = problem->image.width, height = problem->image.height;
  rc_views cropped = *exemplar;
  recede_view middle = *exemplar->image, source;
  int cut_x = middle.width > width ? (middle.width - width) / 2 : 0;
  int cut_y = middle.height > height ? (middle.height - height) / 2 : 0;
  middle.data = rc_view_pixel(exemplar->image, cut_x, cut_y);
  middle.width = middle.width > width ? width : middle.width;
  middle.height = middle.height > height ? height : middle.height;
  cropped.image = &middle;
  if (exemplar->source) {
    source = *exemplar->source;
    source.data = rc_view_pixel(exemplar->source, cut_x, cut_y);
    cropped.source = &source;
  }
  rc_problem part;
  int x0 = (width - middle.width) / 2, y0 = (height - middle.height) / 2;
  problem->exemplar_x = cut_x - x0, problem->exemplar_y = cut_y - y0;
  RC_TRY(read_all(context, &cropped, &part));
  memset(problem->flags.data, RC_TARGET, (size_t)width * (size_t)height);
  for (int y = 0; y < middle.height; y++) {
    memcpy(rc_pixel(&problem->image, x0, y0 + y), rc_pixel(&part.image, 0, y),
           (size_t)middle.width * (size_t)part.image.channels * sizeof(float));
    for (int x = 0; x < middle.width; x++) {
      uint8_t flag = *rc_flag(&part.flags, x, y);
      *rc_flag(&problem->flags, x0 + x, y0 + y) = flag & RC_KNOWN ? flag : RC_TARGET;
    }
  }
  return RECEDE_OK;
}

static recede_status lay(rc_context *context, const rc_views *exemplar, rc_problem *problem) {
  rc_problem all;
  RC_TRY(read_all(context, exemplar, &all));
  return rc_lay(context, &all.image, &all.flags, problem);
}

recede_status rc_problem_of_synthesis(rc_context *context, const rc_views *exemplar,
                                      const recede_plane *plane, bool laid, rc_problem *problem) {
  int width = plane->width, height = plane->height;
  double x = (width - 1) / 2., y = (height - 1) / 2., unused_x = 0, unused_y = 0;
  *problem = (rc_problem){
      .plane = *plane, .shorter_px = width < height ? width : height, .synthesis = true};
  if (laid) rc_lay_anchor(plane, &x, &y);
  if (recede_plane_w(plane, x, y) <= 0)
    return rc_fail(context, RECEDE_NO_PLANE,
                   laid ? "The result shows nothing of the plane, or only a corner: the rest lies "
                          "beyond the horizon. Give a smaller slant."
                        : "The exemplar's centre lies beyond the horizon: give a slant below 90 "
                          "degrees.");
  RC_TRY(
      rc_image_new(context, width, height, exemplar->image->channels < 3 ? 1 : 3, &problem->image));
  RC_TRY(rc_mask_new(context, width, height, &problem->flags));
  rc_block *mark = rc_mark(context);
  RC_TRY(laid ? lay(context, exemplar, problem) : put_in_middle(context, exemplar, problem));
  rc_release(context, mark);
  double nearest = nearest_w(problem, &unused_x, &unused_y);
  problem->line = line_of(plane, 0, 0, x, y);
  double least_w = LEAST_W_OF_TARGET * nearest / recede_plane_w(plane, x, y);
  refuse_far_source(problem, refuse_beyond(context, problem, least_w));
  if (context->report.refused_pixels)
    rc_warn(context, "%llu px of the result lie beyond the horizon and are left empty.",
            (unsigned long long)context->report.refused_pixels);
  return check_source(context, problem);
}
