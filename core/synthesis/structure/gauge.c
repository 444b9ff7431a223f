#include "synthesis/structure/gauge.h"

#include <math.h>

#include "base/memory.h"

/* Joints are looked for so many levels finer than the coarsest, where the hole is 72 px across and
 * more. */
#define FINER_BY 2
/* The picture's brightness by its place across the rails, in steps of so many px where w = 1, seen
 * where scales are near the hole's, so far from it. */
#define BINS_PER_PX 4
#define FAR_PX 1024
#define WIDEST_RATIO 3.f
#define LEAST_SEEN 8
/* Joints are what differs from the mean over so many px to each side: boards have many shades. */
#define HALF_WIDTH_PX 6
#define JOINT_BINS 4
/* Moved across by the gauge, and by twice it and so on up to the rows, joints correlate this well:
 * boards of one width .65 to .97, those of many .38 at the most. A joint's own width comes before
 * they once correlate by less than half of that. */
#define LEAST_GAUGE_PX 6
#define MOST_GAUGE_PX 96
#define LEAST_LIKENESS .5
#define MOST_ROWS 6
/* Where so many are alike, or as many as can be seen, all are. */
#define ALL_ROWS 4096
/* Each multiple is looked for so near to where the one before it puts it. */
#define DRIFT_PX 1

typedef struct joints {
  int count;
  double *value; /* NAN where too little is seen */
} joints;

static recede_status collect(rc_context *context, const rc_image *image, const rc_mask *flags,
                             rc_chart chart, const rc_rails *r, joints *j) {
  double *sum, *seen;
  int half = FAR_PX * BINS_PER_PX, reach = HALF_WIDTH_PX * BINS_PER_PX;
  j->count = 2 * half;
  RC_TRY(RC_NEW_ZERO(context, j->count, &sum));
  RC_TRY(RC_NEW_ZERO(context, j->count, &seen));
  RC_TRY(RC_NEW(context, j->count, &j->value));
  for (int y = 0; y < image->height; y++)
    for (int x = 0; x < image->width; x++) {
      float px = (float)x - chart.x0, py = (float)y - chart.y0,
            w = 1.f + chart.lx * px + chart.ly * py;
      if (!(*rc_flag(flags, x, y) & RC_SOURCE) || !(w > 1 / WIDEST_RATIO && w < WIDEST_RATIO))
        continue;
      float across = (py * r->a - px * r->b) / w, half_px = .5f / w;
      int first = half + (int)floorf((across - half_px) * BINS_PER_PX);
      int last = half + (int)floorf((across + half_px) * BINS_PER_PX);
      if (first < 0 || last >= j->count) continue;
      float value = rc_brightness_at(image, x, y);
      for (int i = first; i <= last; i++) sum[i] += value, seen[i]++;
    }
  for (int i = 0; i < j->count; i++) {
    double around = 0, seen_around = 0;
    j->value[i] = NAN;
    if (seen[i] < LEAST_SEEN || i < reach || i + reach >= j->count) continue;
    for (int k = i - reach; k <= i + reach; k++) around += sum[k], seen_around += seen[k];
    j->value[i] = sum[i] / seen[i] - around / seen_around;
  }
  return RECEDE_OK;
}

/* The joints' correlation with themselves moved by so many bins; NAN where fewer than that are seen
 * twice. */
static double likeness(const joints *j, int lag) {
  double ab = 0, aa = 1e-12, bb = 1e-12, seen = 0;
  for (int i = 0; i + lag < j->count; i++) {
    double a = j->value[i], b = j->value[i + lag];
    if (isnan(a) || isnan(b)) continue;
    ab += a * b, aa += a * a, bb += b * b, seen++;
  }
  return seen < lag ? NAN : ab / sqrt(aa * bb);
}

/* The likeness and place of the best lag from least to most; NAN: too little is seen. */
static double best_lag(const joints *j, int least, int most, int *lag) {
  double best = NAN;
  for (int i = least; i <= most; i++) {
    double here = likeness(j, i);
    if (here > best || (isnan(best) && !isnan(here))) best = here, *lag = i;
  }
  return best;
}

/* The least lag that joints repeat by; 0: none. */
static int first_lag(const joints *j) {
  bool apart = false;
  for (int i = 1; i <= MOST_GAUGE_PX * BINS_PER_PX; i++) {
    double here = likeness(j, i);
    if (here < LEAST_LIKENESS / 2) apart = true;
    if (apart && i >= LEAST_GAUGE_PX * BINS_PER_PX && here >= LEAST_LIKENESS) return i;
  }
  return 0;
}

/* Where, from 0 to the gauge, in bins, joints differ most from what is beside them. */
static float place_of_joints(const joints *j, double gauge) {
  double most = 0;
  int place = 0, rows = (int)(j->count / 2 / gauge);
  for (int first = 0; first < (int)gauge; first++) {
    double sum = 0, seen = 0;
    for (int row = -rows; row < rows; row++)
      for (int i = -JOINT_BINS / 2; i <= JOINT_BINS / 2; i++) {
        int at = j->count / 2 + (int)floor(first + row * gauge + .5) + i;
        if (at < 0 || at >= j->count || isnan(j->value[at])) continue;
        sum += j->value[at], seen++;
      }
    if (seen > 0 && fabs(sum / seen) > most) most = fabs(sum / seen), place = first;
  }
  return (float)place;
}

recede_status rc_gauge_find(rc_context *context, const rc_image *images, const rc_mask *masks,
                            int levels, const rc_chart *chart, rc_rails *rails) {
  joints j;
  bool all = false;
  int level = levels > FINER_BY ? levels - 1 - FINER_BY : 0;
  int drift = DRIFT_PX * BINS_PER_PX, lag = 0;
  rc_block *mark = rc_mark(context);
  rails->gauge = 0, rails->joint = 0, rails->rows = 0;
  RC_TRY(
      collect(context, &images[level], &masks[level], rc_chart_coarser(*chart, level), rails, &j));
  int first = first_lag(&j);
  if (first) {
    best_lag(&j, first, first + 2 * drift, &lag);
    rails->rows = 1, rails->gauge = (float)lag;
    for (int n = 2; n <= MOST_ROWS; n++) {
      int about = (int)(rails->gauge * (float)n + .5f);
      double alike = best_lag(&j, about - drift, about + drift, &lag);
      all = isnan(alike);
      if (!(alike >= LEAST_LIKENESS)) break;
      rails->rows = n, rails->gauge = (float)lag / (float)n;
      all = n == MOST_ROWS;
    }
    if (all) rails->rows = ALL_ROWS;
    float unit = (float)(1 << level) / BINS_PER_PX;
    rails->joint = unit * place_of_joints(&j, rails->gauge);
    rails->gauge *= unit;
  }
  rc_release(context, mark);
  return rc_poll(context);
}
