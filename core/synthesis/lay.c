#include "synthesis/lay.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/distance.h"
#include "image/pyramid.h"
#include "image/sampling.h"

/* The spline reaches so far: that near to known pixels unknown ones get values, too. */
#define REACH_PX 4
/* Below this part of the anchor's w a texel is a hundredth of a px. */
#define LEAST_W .01
/* A sample stands for at least so many of its level's pixels along the shorter side of what a pixel
 * covers. */
#define LEAST_PX_OF_LEVEL 1.
#define MOST_LEVELS 12
/* Samples that the covered area may have: obliquely a grid has more. */
#define MOST_OF_AREA 2.
/* The exemplar ends with its pixels' edges; and rounding may be off by so much. */
#define EDGE_PX (.5 + 1e-6)

typedef struct laying {
  rc_image level[MOST_LEVELS]; /* of the exemplar, finest first */
  rc_mask flags[MOST_LEVELS];
  int levels;
  rc_problem *problem;
  rc_sampler *sampler;
  double across[3], along[3]; /* the plane's axes, along where it recedes */
  double px;                  /* of the exemplar, in a unit of the plane */
  double u0, v0;              /* the exemplar's (0, 0) on the plane */
  double least_w;
} laying;

/* Towards the viewer. */
static void nearer(const recede_plane *plane, double *dx, double *dy) {
  double sine = hypot(plane->normal[0], plane->normal[1]);
  *dx = sine > 0 ? plane->normal[0] / sine : 0, *dy = sine > 0 ? plane->normal[1] / sine : 0;
}

/* In the border's pixels, so that these are filled and the exemplar has target all around: where it
 * ended with the picture the bricks' period was found less exactly, and courses drifted. */
void rc_lay_anchor(const recede_plane *plane, double *x, double *y) {
  double dx, dy, cx = (plane->width - 1) / 2., cy = (plane->height - 1) / 2.;
  nearer(plane, &dx, &dy);
  double t_x = fabs(dx) > 1e-9 ? cx / fabs(dx) : INFINITY;
  double t_y = fabs(dy) > 1e-9 ? cy / fabs(dy) : INFINITY, t = fmin(t_x, t_y);
  *x = isfinite(t) ? cx + t * dx : cx, *y = isfinite(t) ? cy + t * dy : cy;
}

/* Where the ray through (x, y) meets the plane at distance 1, on its axes. False beyond it. */
static bool on_plane(const laying *l, double x, double y, double *u, double *v) {
  const recede_plane *plane = &l->problem->plane;
  double w = recede_plane_w(plane, x, y);
  if (!(w > l->least_w)) return false;
  double ray[3] = {(x - (plane->width - 1) / 2.) / plane->focal_px,
                   (y - (plane->height - 1) / 2.) / plane->focal_px, 1};
  *u = *v = 0;
  for (int k = 0; k < 3; k++) *u += ray[k] * l->across[k] / w, *v += ray[k] * l->along[k] / w;
  return true;
}

static bool on_exemplar(const laying *l, double x, double y, double at[2]) {
  const rc_image *exemplar = &l->level[0];
  double u, v;
  if (!on_plane(l, x, y, &u, &v)) return false;
  at[0] = (u - l->u0) * l->px;
  at[1] = (l->v0 - v) * l->px;
  return at[0] >= -EDGE_PX && at[1] >= -EDGE_PX && at[0] <= exemplar->width - 1 + EDGE_PX &&
         at[1] <= exemplar->height - 1 + EDGE_PX;
}

static void set_axes(laying *l) {
  const recede_plane *plane = &l->problem->plane;
  const double *n = plane->normal;
  double x, y, u, v, dx, dy;
  nearer(plane, &dx, &dy);
  l->across[0] = dy, l->across[1] = -dx, l->across[2] = 0;
  l->along[0] = n[1] * l->across[2] - n[2] * l->across[1];
  l->along[1] = n[2] * l->across[0] - n[0] * l->across[2];
  l->along[2] = n[0] * l->across[1] - n[1] * l->across[0];
  if (l->along[2] < 0) /* away from the viewer */
    for (int k = 0; k < 3; k++) l->along[k] = -l->along[k];
  rc_lay_anchor(plane, &x, &y);
  double w = recede_plane_w(plane, x, y);
  l->px = plane->focal_px * w;
  l->least_w = LEAST_W * w;
  on_plane(l, x, y, &u, &v);
  l->u0 = u - (l->level[0].width - 1) / 2. / l->px;
  l->v0 = v + (l->level[0].height - .5) / l->px;
}

/* How a pixel is sampled: in a grid of so many, of this level. */
typedef struct sampling {
  int level, columns, rows;
} sampling;

/* From the parallelogram of the exemplar that the pixel covers. False: some of it is not there. */
static bool sampling_of(const laying *l, int x, int y, sampling *s) {
  static const double at[4][2] = {{-.5, -.5}, {.5, -.5}, {-.5, .5}, {.5, .5}};
  double corner[4][2];
  for (int i = 0; i < 4; i++)
    if (!on_exemplar(l, x + at[i][0], y + at[i][1], corner[i])) return false;
  double right[2] = {corner[1][0] - corner[0][0], corner[1][1] - corner[0][1]};
  double down[2] = {corner[2][0] - corner[0][0], corner[2][1] - corner[0][1]};
  double wide = hypot(right[0], right[1]), high = hypot(down[0], down[1]);
  double area = fabs(right[0] * down[1] - right[1] * down[0]);
  double thin = area / fmax(fmax(wide, high), 1e-9), scale = 1;
  s->level = 0;
  for (; s->level < l->levels - 1 && thin * scale >= 2 * LEAST_PX_OF_LEVEL; s->level++) scale /= 2;
  double columns = fmax(wide * scale, 1), rows = fmax(high * scale, 1);
  double too_many = columns * rows / (MOST_OF_AREA * fmax(area * scale * scale, 1));
  if (too_many > 1) columns /= sqrt(too_many), rows /= sqrt(too_many);
  s->columns = (int)ceil(fmax(columns - .1, 1)), s->rows = (int)ceil(fmax(rows - .1, 1));
  return true;
}

/* Its flags are the nearest pixel's; where that is not known nothing is added. */
static uint8_t add_sample(const laying *l, int level, const double at[2], double sum[3]) {
  const rc_image *image = &l->level[level];
  double scale = 1. / (1 << level), x = (at[0] + .5) * scale - .5, y = (at[1] + .5) * scale - .5;
  int nearest_x = (int)floor(x + .5), nearest_y = (int)floor(y + .5);
  nearest_x = nearest_x < 0 ? 0 : nearest_x < image->width ? nearest_x : image->width - 1;
  nearest_y = nearest_y < 0 ? 0 : nearest_y < image->height ? nearest_y : image->height - 1;
  uint8_t flag = *rc_flag(&l->flags[level], nearest_x, nearest_y);
  float value[3];
  if (!(flag & RC_KNOWN)) return flag;
  rc_sample(l->sampler, image, (float)x, (float)y, value);
  for (int k = 0; k < image->channels; k++) sum[k] += value[k];
  return flag;
}

/* From those samples that are known, if half of them are. */
static uint8_t lay_pixel(const laying *l, int x, int y, float *pixel) {
  sampling s;
  uint8_t all = RC_KNOWN | RC_SOURCE;
  double sum[3] = {0, 0, 0};
  int known = 0;
  if (!sampling_of(l, x, y, &s)) return RC_TARGET;
  for (int j = 0; j < s.rows; j++)
    for (int i = 0; i < s.columns; i++) {
      double at[2];
      if (!on_exemplar(l, x + (i + .5) / s.columns - .5, y + (j + .5) / s.rows - .5, at))
        return RC_TARGET;
      uint8_t flag = add_sample(l, s.level, at, sum);
      if (flag & RC_KNOWN) known++, all &= flag;
    }
  if (2 * known < s.columns * s.rows) return RC_TARGET;
  for (int k = 0; k < l->level[0].channels; k++)
    pixel[k] = fmaxf((float)(sum[k] / known), l->problem->least);
  return all;
}

static void lay_row(void *user, int y, int thread) {
  const laying *l = user;
  rc_problem *problem = l->problem;
  (void)thread;
  for (int x = 0; x < problem->image.width; x++)
    *rc_flag(&problem->flags, x, y) = lay_pixel(l, x, y, rc_pixel(&problem->image, x, y));
}

static recede_status find_least(rc_context *context, const laying *l) {
  const rc_image *image = &l->level[0];
  for (int y = 0; y < image->height; y++) {
    for (int x = 0; x < image->width; x++)
      for (int k = 0; k < image->channels && *rc_flag(&l->flags[0], x, y) & RC_KNOWN; k++)
        l->problem->least = fminf(l->problem->least, rc_pixel(image, x, y)[k]);
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

/* The mean of the neighbours that had a value before this pass. Coarser levels have something there
 * already, of what few known pixels are near. */
static void continue_pixel(const rc_image *image, const uint8_t *passes, int pass, int x, int y) {
  float sum[3] = {0, 0, 0}, count = 0;
  for (int j = y - 1; j <= y + 1; j++)
    for (int i = x - 1; i <= x + 1; i++) {
      if (!rc_inside(image->width, image->height, i, j)) continue;
      if (passes[(size_t)j * (size_t)image->width + (size_t)i] >= pass) continue;
      for (int k = 0; k < image->channels; k++) sum[k] += rc_pixel(image, i, j)[k];
      count++;
    }
  for (int k = 0; k < image->channels && count > 0; k++) rc_pixel(image, x, y)[k] = sum[k] / count;
}

/* The spline weighs what lies beside a known pixel: where that is unknown it goes on as it is. */
static recede_status continue_unknown(rc_context *context, const rc_image *image,
                                      const rc_mask *flags) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  uint8_t *unknown, *passes; /* of each pixel: how far it is from a known one, which is 0 */
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &unknown));
  RC_TRY(RC_NEW(context, pixels, &passes));
  for (size_t i = 0; i < pixels; i++) unknown[i] = !(flags->data[i] & RC_KNOWN);
  rc_distance_inside(unknown, 1, image->width, image->height, false, passes);
  for (int pass = 1; pass <= REACH_PX; pass++)
    for (int y = 0; y < image->height; y++) {
      for (int x = 0; x < image->width; x++)
        if (passes[(size_t)y * (size_t)image->width + (size_t)x] == pass)
          continue_pixel(image, passes, pass, x, y);
      RC_TRY(rc_poll(context));
    }
  rc_release(context, mark);
  return RECEDE_OK;
}

/* A pixel is known where half of the finer level's four are, and source where those are. */
static void halve_flags(const rc_mask *fine, const rc_mask *coarse) {
  for (int y = 0; y < coarse->height; y++)
    for (int x = 0; x < coarse->width; x++) {
      int there = 0, known = 0;
      uint8_t all = RC_KNOWN | RC_SOURCE;
      for (int i = 0; i < 4; i++) {
        int fx = 2 * x + (i & 1), fy = 2 * y + (i >> 1);
        if (!rc_inside(fine->width, fine->height, fx, fy)) continue;
        uint8_t flag = *rc_flag(fine, fx, fy);
        there++;
        if (flag & RC_KNOWN) known++, all &= flag;
      }
      *rc_flag(coarse, x, y) = 2 * known >= there ? all : 0;
    }
}

static recede_status build_levels(rc_context *context, laying *l) {
  for (;; l->levels++) {
    int last = l->levels - 1;
    RC_TRY(continue_unknown(context, &l->level[last], &l->flags[last]));
    if (l->levels == MOST_LEVELS || l->level[last].width < 2 || l->level[last].height < 2)
      return RECEDE_OK;
    RC_TRY(rc_half(context, &l->level[last], &l->flags[last], &l->level[last + 1],
                   &l->flags[last + 1]));
    halve_flags(&l->flags[last], &l->flags[last + 1]);
    RC_TRY(rc_poll(context));
  }
}

recede_status rc_lay(rc_context *context, const rc_image *exemplar, const rc_mask *flags,
                     rc_problem *problem) {
  laying l = {.level = {*exemplar}, .flags = {*flags}, .levels = 1, .problem = problem};
  rc_block *mark = rc_mark(context);
  problem->least = 0;
  RC_TRY(RC_NEW(context, 1, &l.sampler));
  rc_sampler_init(l.sampler, false);
  RC_TRY(find_least(context, &l));
  RC_TRY(build_levels(context, &l));
  set_axes(&l);
  RC_TRY(rc_parallel(context, problem->image.height, lay_row, &l));
  rc_release(context, mark);
  return RECEDE_OK;
}
