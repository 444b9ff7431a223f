#include "synthesis/standing.h"

#include <math.h>

#include "base/memory.h"

/* Rows of so many px below the horizon are looked at, down to this part of the focal length: a
 * ground of no direction, which is seen so flat there, has 1 / 25 of its gradients across upright
 * edges. */
#define ROW_PX 4
#define MOST_OF_FOCAL .2
/* An edge is upright where the gradient across the tilt is so many times that along it, and lines
 * to the vanishing point lean by more than this. */
#define MOST_RISE .45f
#define LEAST_LEAN .7f
/* Streets have .15 to .6 of their gradients there, motorways, piers and dunes less than .08. */
#define PART_STANDING .12
/* So much is looked at beside the hole, of its width, or px. */
#define WIDTHS_BESIDE 1.f
#define LEAST_BESIDE_PX 40.f

typedef struct row {
  double upright, all; /* squares of gradients */
} row;

/* Where a px lies: across the tilt, and how far below the horizon. */
typedef struct frame {
  rc_chart chart;
  float steep;
  float along_x, along_y; /* towards the viewer */
  float vanishing;        /* across: of the tilt's vanishing point */
  float left, right;      /* across: of what is looked at */
  float nearest_horizon;  /* below the horizon: of the hole's px that is */
} frame;

static float across(const frame *f, float x, float y) { return x * f->along_y - y * f->along_x; }

static float below(const frame *f, int x, int y) {
  return rc_chart_w(&f->chart, (float)x, (float)y) / f->steep;
}

static void look_beside_hole(const rc_mask *flags, frame *f) {
  f->left = f->nearest_horizon = INFINITY, f->right = -INFINITY;
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET)) continue;
      float at = across(f, (float)x, (float)y);
      f->left = fminf(f->left, at), f->right = fmaxf(f->right, at);
      f->nearest_horizon = fminf(f->nearest_horizon, below(f, x, y));
    }
  float beside = fmaxf(WIDTHS_BESIDE * (f->right - f->left), LEAST_BESIDE_PX);
  f->left -= beside, f->right += beside;
}

static bool all_known(const rc_mask *flags, int x, int y) {
  return (*rc_flag(flags, x, y) & *rc_flag(flags, x - 1, y) & *rc_flag(flags, x + 1, y) &
          *rc_flag(flags, x, y - 1) & *rc_flag(flags, x, y + 1) & RC_KNOWN) != 0;
}

static void add_gradient(const frame *f, const rc_image *image, int x, int y, float under,
                         row *to) {
  float gx = rc_brightness_at(image, x + 1, y) - rc_brightness_at(image, x - 1, y);
  float gy = rc_brightness_at(image, x, y + 1) - rc_brightness_at(image, x, y - 1);
  float p = across(f, gx, gy), q = gx * f->along_x + gy * f->along_y;
  float off = fabsf(across(f, (float)x, (float)y) - f->vanishing);
  double square = (double)(p * p + q * q);
  to->all += square;
  if (fabsf(q) < MOST_RISE * fabsf(p) && off > LEAST_LEAN * under) to->upright += square;
}

/* Of the rows from the horizon on those that have the most upright edges more than ground. */
static int count_standing(const row *rows, int count) {
  double excess = 0, most = 0;
  int standing = 0;
  for (int i = 0; i < count; i++) {
    excess += rows[i].upright - PART_STANDING * rows[i].all;
    if (excess > most) most = excess, standing = i + 1;
  }
  return standing;
}

recede_status rc_measure_standing(rc_context *context, const rc_problem *problem,
                                  const rc_image *image, const rc_mask *flags, int exponent,
                                  const rc_chart *finest, float *standing_w) {
  const recede_plane *plane = &problem->plane;
  double unit = 1 << exponent;
  frame f = {.chart = rc_chart_coarser(*finest, exponent)};
  f.steep = sqrtf(f.chart.lx * f.chart.lx + f.chart.ly * f.chart.ly);
  *standing_w = 0.f;
  if (!(f.steep > 0.f)) return RECEDE_OK;
  f.along_x = f.chart.lx / f.steep, f.along_y = f.chart.ly / f.steep;
  double middle_x = (plane->width - 1) / 2. - problem->origin_x;
  double middle_y = (plane->height - 1) / 2. - problem->origin_y;
  f.vanishing =
      across(&f, (float)((middle_x + .5) / unit - .5), (float)((middle_y + .5) / unit - .5));
  look_beside_hole(flags, &f);
  int count = (int)(MOST_OF_FOCAL * plane->focal_px / unit / ROW_PX);
  row *rows;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, count + 1, &rows));
  for (int y = 1; y + 1 < image->height; y++) {
    RC_TRY(rc_poll(context));
    for (int x = 1; x + 1 < image->width; x++) {
      float under = below(&f, x, y), at = across(&f, (float)x, (float)y);
      if (under > 0.f && under < (float)(count * ROW_PX) && at > f.left && at < f.right &&
          all_known(flags, x, y))
        add_gradient(&f, image, x, y, under, &rows[(int)under / ROW_PX]);
    }
  }
  float standing_px = (float)(ROW_PX * count_standing(rows, count));
  if (standing_px > f.nearest_horizon) *standing_w = standing_px * f.steep;
  rc_release(context, mark);
  return RECEDE_OK;
}
