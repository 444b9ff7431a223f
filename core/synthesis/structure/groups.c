#include "synthesis/structure/groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/eigen.h"
#include "base/memory.h"
#include "base/real.h"

/* A pixel's looks are those of the square around it; then it is what most of that square is. */
#define HALF_PX 2
#define SIDE_PX (2 * HALF_PX + 1)
/* Looks are told apart along an axis on which they vary so many times as much as neighbouring
 * squares do, where two groups explain so much of it, or with less variance more: where two
 * textures meet 4.3 to 24 and .80 to .98. The narrower a path, the less: 2.4 where it is a sixth of
 * the hole. Of 120 single textures none explains .84 from 1.5 on. */
#define LEAST_RATIO 2.
#define CLEAR_RATIO 4.
#define LEAST_EXPLAINED .84
#define LEAST_EXPLAINED_WHERE_CLEAR .78
/* What has no noise at all must not decide: this part of the mean variance is added to all. */
#define LEAST_NOISE 1e-3

typedef struct finder {
  const rc_around *around;
  int beside_px;
  rc_groups *groups;
} finder;

static bool is_beside(const finder *f, size_t at) {
  return f->groups->seen[at] && f->around->from_hole[at] <= f->beside_px;
}

static void add_outer(double matrix[RC_LOOKS * RC_LOOKS], const double v[RC_LOOKS]) {
  for (int i = 0; i < RC_LOOKS; i++)
    for (int k = 0; k < RC_LOOKS; k++) matrix[i * RC_LOOKS + k] += v[i] * v[k];
}

/* Means beside the hole; false: hardly anything is known there. */
static bool means(const finder *f, double mean[RC_LOOKS]) {
  double count = 0;
  memset(mean, 0, RC_LOOKS * sizeof *mean);
  for (size_t i = 0; i < f->around->pixels; i++) {
    if (!is_beside(f, i)) continue;
    for (int k = 0; k < RC_LOOKS; k++) mean[k] += (double)f->groups->looks[i].value[k];
    count++;
  }
  for (int k = 0; k < RC_LOOKS; k++) mean[k] /= fmax(count, 1);
  return count > RC_LOOKS;
}

/* Covariances of the looks beside the hole, and of what squares next to each other differ by. */
static void covariances(const finder *f, const double mean[RC_LOOKS],
                        double all[RC_LOOKS * RC_LOOKS], double near[RC_LOOKS * RC_LOOKS]) {
  size_t width = (size_t)f->around->width, step[2] = {SIDE_PX, SIDE_PX * width};
  double count = 0, pairs = 0, trace = 0, v[RC_LOOKS];
  memset(all, 0, RC_LOOKS * RC_LOOKS * sizeof *all);
  memset(near, 0, RC_LOOKS * RC_LOOKS * sizeof *near);
  for (size_t i = 0; i < f->around->pixels; i++) {
    if (!is_beside(f, i)) continue;
    for (int k = 0; k < RC_LOOKS; k++) v[k] = (double)f->groups->looks[i].value[k] - mean[k];
    add_outer(all, v);
    count++;
    for (int n = 0; n < 2; n++) {
      bool inside = n ? i + step[n] < f->around->pixels : i % width + SIDE_PX < width;
      if (!inside || !is_beside(f, i + step[n])) continue;
      for (int k = 0; k < RC_LOOKS; k++)
        v[k] = (double)(f->groups->looks[i + step[n]].value[k] - f->groups->looks[i].value[k]);
      add_outer(near, v);
      pairs += 2; /* a difference has the variance of both */
    }
  }
  for (int k = 0; k < RC_LOOKS * RC_LOOKS; k++) all[k] /= count, near[k] /= fmax(pairs, 1);
  for (int k = 0; k < RC_LOOKS; k++) trace += all[k * RC_LOOKS + k];
  for (int k = 0; k < RC_LOOKS; k++)
    for (int n = 0; n < 2; n++)
      (n ? all : near)[k * RC_LOOKS + k] += LEAST_NOISE * trace / RC_LOOKS + 1e-12;
}

/* Axes in the order of how much all varies on them for what near does: near is made white, then
 * they are the principal ones. The k-th is column k, and ratio[k] its variance. */
static recede_status find_axes(rc_context *context, const double all[RC_LOOKS * RC_LOOKS],
                               double near[RC_LOOKS * RC_LOOKS], double axes[RC_LOOKS * RC_LOOKS],
                               double ratio[RC_LOOKS]) {
  double values[RC_LOOKS], vectors[RC_LOOKS * RC_LOOKS];
  double white[RC_LOOKS * RC_LOOKS], turned[RC_LOOKS * RC_LOOKS];
  RC_TRY(rc_eigen(context, near, RC_LOOKS, RC_LOOKS, values, vectors));
  for (int i = 0; i < RC_LOOKS; i++)
    for (int k = 0; k < RC_LOOKS; k++)
      white[i * RC_LOOKS + k] = vectors[i * RC_LOOKS + k] / sqrt(fmax(values[k], 1e-12));
  for (int i = 0; i < RC_LOOKS; i++)
    for (int k = 0; k < RC_LOOKS; k++) {
      double sum = 0;
      for (int m = 0; m < RC_LOOKS; m++)
        for (int n = 0; n < RC_LOOKS; n++)
          sum += white[m * RC_LOOKS + i] * all[m * RC_LOOKS + n] * white[n * RC_LOOKS + k];
      turned[i * RC_LOOKS + k] = sum;
    }
  RC_TRY(rc_eigen(context, turned, RC_LOOKS, RC_LOOKS, ratio, vectors));
  for (int i = 0; i < RC_LOOKS; i++)
    for (int k = 0; k < RC_LOOKS; k++) {
      axes[i * RC_LOOKS + k] = 0;
      for (int m = 0; m < RC_LOOKS; m++)
        axes[i * RC_LOOKS + k] += white[i * RC_LOOKS + m] * vectors[m * RC_LOOKS + k];
    }
  return RECEDE_OK;
}

static float along(const rc_looks *looks, const double axis[RC_LOOKS]) {
  double sum = 0;
  for (int k = 0; k < RC_LOOKS; k++) sum += axis[k] * (double)looks->value[k];
  return (float)sum;
}

/* Where two groups explain most of the variance of count sorted values (Otsu), and how much. */
static float split_at(const float *value, size_t count, double *explained) {
  double n = (double)count, total = 0, square = 0, sum = 0, most = 0;
  float at = 0;
  for (size_t i = 0; i < count; i++) total += (double)value[i];
  for (size_t i = 0; i < count; i++) {
    double off = (double)value[i] - total / n;
    square += off * off;
  }
  for (size_t i = 1; i < count; i++) {
    sum += (double)value[i - 1];
    double below = (double)i, above = n - below;
    double apart = sum / below - (total - sum) / above;
    double between = below * above / n * apart * apart;
    if (between > most) most = between, at = value[i - 1] + (value[i] - value[i - 1]) / 2;
  }
  *explained = square > 0 ? most / square : 0;
  return at;
}

recede_status rc_groups_smooth(rc_context *context, const rc_around *around, int8_t *label) {
  int8_t *before;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, around->pixels, &before));
  memcpy(before, label, around->pixels);
  for (int y = 0; y < around->height; y++)
    for (int x = 0; x < around->width; x++) {
      size_t at = (size_t)y * (size_t)around->width + (size_t)x;
      int sum = 0;
      if (!(*rc_flag(around->flags, around->box.x0 + x, around->box.y0 + y) & RC_KNOWN)) continue;
      for (int j = y - HALF_PX; j <= y + HALF_PX; j++)
        for (int i = x - HALF_PX; i <= x + HALF_PX; i++)
          if (rc_inside(around->width, around->height, i, j))
            sum += before[(size_t)j * (size_t)around->width + (size_t)i];
      if (sum) label[at] = sum > 0 ? 1 : -1;
    }
  rc_release(context, mark);
  return rc_poll(context);
}

static recede_status look_around(rc_context *context, const rc_around *around, rc_groups *groups) {
  RC_TRY(RC_NEW(context, around->pixels, &groups->looks));
  RC_TRY(RC_NEW(context, around->pixels, &groups->seen));
  for (size_t i = 0; i < around->pixels; i++) {
    int x = around->box.x0 + (int)(i % (size_t)around->width);
    int y = around->box.y0 + (int)(i / (size_t)around->width);
    groups->seen[i] = *rc_flag(around->flags, x, y) & RC_KNOWN &&
                      rc_look(around->image, around->flags, x, y, HALF_PX, &groups->looks[i]);
  }
  return rc_poll(context);
}

/* Adds a way behind those that explain more. */
static void add_way(rc_groups *groups, const rc_way *way) {
  int at = groups->count++;
  for (; at > 0 && groups->ways[at - 1].explained < way->explained; at--)
    groups->ways[at] = groups->ways[at - 1];
  groups->ways[at] = *way;
}

/* Asks each axis on which looks vary enough, whether it tells two groups apart. */
static recede_status ask_axes(rc_context *context, const finder *f,
                              const double axes[RC_LOOKS * RC_LOOKS],
                              const double ratio[RC_LOOKS]) {
  float *value;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, f->around->pixels, &value));
  for (int k = 0; k < RC_LOOKS && ratio[k] >= LEAST_RATIO; k++) {
    rc_way way;
    size_t count = 0;
    for (int i = 0; i < RC_LOOKS; i++) way.axis[i] = axes[i * RC_LOOKS + k];
    for (size_t i = 0; i < f->around->pixels; i++)
      if (is_beside(f, i)) value[count++] = along(&f->groups->looks[i], way.axis);
    qsort(value, count, sizeof *value, rc_by_value);
    way.at = split_at(value, count, &way.explained);
    bool clear = ratio[k] >= CLEAR_RATIO;
    if (way.explained >= (clear ? LEAST_EXPLAINED_WHERE_CLEAR : LEAST_EXPLAINED))
      add_way(f->groups, &way);
    RC_TRY(rc_poll(context));
  }
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_groups_find(rc_context *context, const rc_around *around, int beside_px,
                             rc_groups *groups) {
  double mean[RC_LOOKS], all[RC_LOOKS * RC_LOOKS], near[RC_LOOKS * RC_LOOKS];
  double axes[RC_LOOKS * RC_LOOKS], ratio[RC_LOOKS];
  finder f = {around, beside_px, groups};
  groups->count = 0;
  RC_TRY(look_around(context, around, groups));
  if (!means(&f, mean)) return RECEDE_OK;
  covariances(&f, mean, all, near);
  RC_TRY(find_axes(context, all, near, axes, ratio));
  return ask_axes(context, &f, axes, ratio);
}

recede_status rc_groups_label(rc_context *context, const rc_around *around, const rc_groups *groups,
                              const rc_way *way, int8_t *label) {
  for (size_t i = 0; i < around->pixels; i++)
    label[i] = !groups->seen[i] ? 0 : along(&groups->looks[i], way->axis) > way->at ? 1 : -1;
  return rc_groups_smooth(context, around, label);
}
