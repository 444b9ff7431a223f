#include "synthesis/search/trial.h"

#include <string.h>

#include "base/memory.h"

/* All starts together work on at most so many pixels: a level is coarse by its hole's width, and a
 * thin hole may be long. */
#define MOST_PIXELS 16384
/* Patches' distances tell broken joints, contrast tells a bland fill. On hard cases a single start
 * scored 82, the best of four 91, and the one this picks 86 to 87, with prices of .1 to .3. */
#define PRICE_OF_CONTRAST .2
#define MOST_SAMPLES 4096
/* Of a lane, the copy of a level and what a start, a vote and prices allocate: .3 MB where a hole
 * is as wide as long; and what whole copies do. */
#define LANE_BYTES_PER_PX 15
#define LANE_BYTES_PER_BOX_PX 48
#define LANE_BYTES ((size_t)7 << 18)

static int target_pixels(const rc_level *level) {
  int count = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) count += rc_level_is_target(level, x, y);
  return count;
}

recede_status rc_trial_new(rc_context *context, const rc_level *level, rc_trial *trial) {
  int count = target_pixels(level);
  RC_TRY(RC_NEW(context, count, &trial->field));
  RC_TRY(RC_NEW(context, count, &trial->cost));
  return RC_NEW(context, count, &trial->guide);
}

void rc_trial_save(const rc_level *level, rc_trial *trial) {
  size_t n = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      trial->field[n] = level->field[rc_level_at(level, x, y)];
      trial->cost[n] = level->cost[rc_level_at(level, x, y)];
      trial->guide[n++] = level->pixels[(size_t)y * (size_t)level->width + (size_t)x];
    }
}

void rc_trial_restore(rc_level *level, const rc_trial *trial) {
  size_t n = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      level->field[rc_level_at(level, x, y)] = trial->field[n];
      level->cost[rc_level_at(level, x, y)] = trial->cost[n];
      level->pixels[(size_t)y * (size_t)level->width + (size_t)x] = trial->guide[n++];
    }
}

static recede_status lane_new(rc_context *context, const rc_level *level, bool usage,
                              rc_lane *lane) {
  size_t pixels = (size_t)level->width * (size_t)level->height;
  size_t box = (size_t)level->box_w * (size_t)level->box_h;
  rc_level *own = &lane->level;
  *lane = (rc_lane){*level, {NULL, NULL}};
  RC_TRY(RC_NEW(context, pixels, &own->pixels));
  RC_TRY(RC_NEW(context, pixels, &own->weight));
  RC_TRY(RC_NEW(context, box, &own->field));
  RC_TRY(RC_NEW(context, box, &own->cost));
  RC_TRY(RC_NEW(context, box, &lane->scratch.old));
  if (usage) RC_TRY(RC_NEW(context, pixels, &lane->scratch.usage));
  memcpy(own->pixels, level->pixels, pixels * sizeof *own->pixels);
  memcpy(own->weight, level->weight, pixels * sizeof *own->weight);
  memcpy(own->field, level->field, box * sizeof *own->field);
  memcpy(own->cost, level->cost, box * sizeof *own->cost);
  return RECEDE_OK;
}

recede_status rc_lanes_new(rc_context *context, const rc_level *level, const rc_workspace *scratch,
                           int trials, rc_lane **lanes, int *count) {
  size_t bytes = LANE_BYTES_PER_PX * (size_t)level->width * (size_t)level->height +
                 LANE_BYTES_PER_BOX_PX * (size_t)level->box_w * (size_t)level->box_h + LANE_BYTES;
  *count = context->threads < trials ? context->threads : trials;
  while (*count > 1 && (size_t)*count * bytes > RC_MOST_BYTES_OF_LANES) (*count)--;
  RC_TRY(RC_NEW(context, *count, lanes));
  **lanes = (rc_lane){*level, *scratch};
  int copies = *count > 1 ? *count : 0;
  for (int n = 0; n < copies; n++)
    RC_TRY(lane_new(context, level, scratch->usage != NULL, &(*lanes)[n]));
  return RECEDE_OK;
}

int rc_trials_worth(const rc_level *level, int most) {
  int worth = MOST_PIXELS / (target_pixels(level) + 1);
  return worth < 1 ? 1 : worth < most ? worth : most;
}

/* Mean cost, each pixel by the trust in it: it is near the border that a fit means something. */
static double mean_cost(const rc_level *level) {
  double sum = 0, total = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = rc_level_at(level, x, y);
      if (!rc_level_is_target(level, x, y) || isnan(level->field[at].a)) continue;
      double trust = level->weight[(size_t)y * (size_t)level->width + (size_t)x];
      sum += trust * level->cost[at], total += trust;
    }
  return total > 0 ? sum / total : 0;
}

/* Variance within the patch around a pixel that is at least a patch from the border. */
static double patch_variance(const rc_level *level, int x, int y) {
  int32_t sum[RC_COMPONENTS] = {0}, square = 0;
  double count = (2 * RC_PATCH_RADIUS + 1) * (2 * RC_PATCH_RADIUS + 1), deviation = 0;
  for (int dy = -RC_PATCH_RADIUS; dy <= RC_PATCH_RADIUS; dy++)
    for (int dx = -RC_PATCH_RADIUS; dx <= RC_PATCH_RADIUS; dx++) {
      uint32_t pixel = level->pixels[(size_t)(y + dy) * (size_t)level->width + (size_t)(x + dx)];
      for (int k = 0; k < RC_COMPONENTS; k++) {
        int32_t v = (int32_t)(pixel >> 8 * k & 255);
        sum[k] += v, square += v * v;
      }
    }
  for (int k = 0; k < RC_COMPONENTS; k++) deviation += (double)sum[k] * sum[k] / count;
  return (square - deviation) / count;
}

typedef struct mean {
  double sum, count;
} mean;

static bool has_patch(const rc_level *level, int x, int y) {
  return x >= RC_PATCH_RADIUS && y >= RC_PATCH_RADIUS && x + RC_PATCH_RADIUS < level->width &&
         y + RC_PATCH_RADIUS < level->height;
}

/* log2 of the contrast in the hole over that of sources at the same scales. */
static double contrast(const rc_level *level) {
  float least = 1e9f, most = 0.f;
  mean inside = {0, 0}, outside = {0, 0};
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y) || !has_patch(level, x, y)) continue;
      float w = rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
      least = fminf(least, w), most = fmaxf(most, w);
      inside.sum += patch_variance(level, x, y), inside.count++;
    }
  int sources = rc_level_all_sources(level).end, step = sources / MOST_SAMPLES + 1;
  for (int i = 0; i < sources; i += step) {
    int x = level->order[i] % level->width, y = level->order[i] / level->width;
    float w = rc_level_w(level, rc_level_x(level, x), rc_level_y(level, y));
    if (w < least || w > most || !has_patch(level, x, y)) continue;
    outside.sum += patch_variance(level, x, y), outside.count++;
  }
  if (inside.count < 1 || outside.count < 1 || !(outside.sum > 0)) return 0;
  return rc_log2((float)(inside.sum / inside.count + 1e-3)) -
         rc_log2((float)(outside.sum / outside.count + 1e-3));
}

double rc_misfit(const rc_level *level) {
  return mean_cost(level) / level->variance + PRICE_OF_CONTRAST * fabs(contrast(level));
}
