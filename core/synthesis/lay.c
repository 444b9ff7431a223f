#include "synthesis/lay.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/sampling.h"

/* The spline reaches this far with more than a hundredth of its weight: so far from pixels that are
 * not known. */
#define REACH_PX 3
/* Below this part of the anchor's w a texel is a hundredth of a px. */
#define LEAST_W .01

typedef struct laying {
  const rc_image *exemplar;
  const rc_mask *known; /* flags, RC_KNOWN only where all around it is */
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

static bool on_exemplar(const laying *l, double x, double y, double *ex, double *ey) {
  double u, v;
  if (!on_plane(l, x, y, &u, &v)) return false;
  *ex = (u - l->u0) * l->px;
  *ey = (l->v0 - v) * l->px;
  return *ex >= 0 && *ey >= 0 && *ex <= l->exemplar->width - 1 && *ey <= l->exemplar->height - 1;
}

static void set_axes(laying *l) {
  const recede_plane *plane = &l->problem->plane;
  const double *n = plane->normal;
  double x, y, u, v, dx, dy;
  nearer(plane, &dx, &dy);
  l->across[0] = dy, l->across[1] = -dx, l->across[2] = 0;
  /* normal x across, which recedes: w falls along it. */
  l->along[0] = n[1] * l->across[2] - n[2] * l->across[1];
  l->along[1] = n[2] * l->across[0] - n[0] * l->across[2];
  l->along[2] = n[0] * l->across[1] - n[1] * l->across[0];
  if (l->along[2] < 0)
    for (int k = 0; k < 3; k++) l->along[k] = -l->along[k];
  rc_lay_anchor(plane, &x, &y);
  double w = recede_plane_w(plane, x, y);
  l->px = plane->focal_px * w;
  l->least_w = LEAST_W * w;
  on_plane(l, x, y, &u, &v);
  l->u0 = u - (l->exemplar->width - 1) / 2. / l->px;
  l->v0 = v + (l->exemplar->height - 1) / l->px;
}

/* How many samples a pixel needs each way: as many as pixels of the exemplar lie in it. */
static bool samples_of(const laying *l, int x, int y, int *columns, int *rows) {
  double corner[4][2];
  static const double at[4][2] = {{-.5, -.5}, {.5, -.5}, {-.5, .5}, {.5, .5}};
  for (int i = 0; i < 4; i++)
    if (!on_exemplar(l, x + at[i][0], y + at[i][1], &corner[i][0], &corner[i][1])) return false;
  double wide = 0, high = 0;
  for (int k = 0; k < 2; k++) {
    wide = fmax(wide, fmax(fabs(corner[1][k] - corner[0][k]), fabs(corner[3][k] - corner[2][k])));
    high = fmax(high, fmax(fabs(corner[2][k] - corner[0][k]), fabs(corner[3][k] - corner[1][k])));
  }
  *columns = (int)ceil(fmax(wide - .1, 1)), *rows = (int)ceil(fmax(high - .1, 1));
  return true;
}

static uint8_t lay_pixel(const laying *l, int x, int y, float *pixel) {
  int columns, rows, channels = l->exemplar->channels;
  uint8_t flag = RC_KNOWN | RC_SOURCE;
  double sum[3] = {0, 0, 0};
  if (!samples_of(l, x, y, &columns, &rows)) return RC_TARGET;
  for (int j = 0; j < rows; j++)
    for (int i = 0; i < columns; i++) {
      float value[3];
      double ex, ey;
      if (!on_exemplar(l, x + (i + .5) / columns - .5, y + (j + .5) / rows - .5, &ex, &ey))
        return RC_TARGET;
      flag &= *rc_flag(l->known, (int)(ex + .5), (int)(ey + .5));
      rc_sample(l->sampler, l->exemplar, (float)ex, (float)ey, value);
      for (int k = 0; k < channels; k++) sum[k] += value[k];
    }
  if (!(flag & RC_KNOWN)) return RC_TARGET;
  for (int k = 0; k < channels; k++)
    pixel[k] = fmaxf((float)(sum[k] / (columns * rows)), l->problem->least);
  return flag;
}

static void lay_row(void *user, int y, int thread) {
  const laying *l = user;
  rc_problem *problem = l->problem;
  (void)thread;
  for (int x = 0; x < problem->image.width; x++)
    *rc_flag(&problem->flags, x, y) = lay_pixel(l, x, y, rc_pixel(&problem->image, x, y));
}

static float least_of(const rc_image *image, const rc_mask *flags) {
  float least = 0;
  for (int y = 0; y < image->height; y++)
    for (int x = 0; x < image->width; x++)
      for (int k = 0; k < image->channels && *rc_flag(flags, x, y) & RC_KNOWN; k++)
        least = fminf(least, rc_pixel(image, x, y)[k]);
  return least;
}

/* Pixels near unknown ones lose RC_KNOWN: samples there would hold something of them. */
static void keep_clear(const rc_mask *flags, const rc_mask *known) {
  memcpy(known->data, flags->data, (size_t)flags->width * (size_t)flags->height);
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      if (*rc_flag(flags, x, y) & RC_KNOWN) continue;
      for (int j = y - REACH_PX; j <= y + REACH_PX; j++)
        for (int i = x - REACH_PX; i <= x + REACH_PX; i++)
          if (rc_inside(flags->width, flags->height, i, j)) *rc_flag(known, i, j) = 0;
    }
}

recede_status rc_lay(rc_context *context, const rc_image *exemplar, const rc_mask *flags,
                     rc_problem *problem) {
  rc_mask known;
  laying l = {.exemplar = exemplar, .known = &known, .problem = problem};
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_mask_new(context, flags->width, flags->height, &known));
  RC_TRY(RC_NEW(context, 1, &l.sampler));
  rc_sampler_init(l.sampler, false);
  keep_clear(flags, &known);
  problem->least = least_of(exemplar, flags);
  set_axes(&l);
  RC_TRY(rc_parallel(context, problem->image.height, lay_row, &l));
  rc_release(context, mark);
  return RECEDE_OK;
}
