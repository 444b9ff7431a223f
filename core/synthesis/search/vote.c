#include "synthesis/search/vote.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"
#include "synthesis/search/evaluate.h"

/* Every second patch in x and y votes: a quarter of the work, and no score lost. */
#define STRIDE 2
/* Sharpness of the vote: exp(-cost / (2 * .05 * p75)). */
#define SHARPNESS .05f

typedef struct ballot {
  rc_level *level;
  float *weight; /* of each box pixel's patch */
  float scale;   /* of the costs: weights are its exponentials */
} ballot;

/* The 75th percentile of a regular sample of the costs. */
static float upper_quartile(const rc_level *level) {
  float sample[1024];
  int count = 0;
  size_t box = (size_t)level->box_w * (size_t)level->box_h, step = box / 1024 + 1;
  for (size_t i = 0; i < box && count < 1024; i += step) {
    int x = level->box.x0 + (int)(i % (size_t)level->box_w);
    int y = level->box.y0 + (int)(i / (size_t)level->box_w);
    if (rc_level_is_target(level, x, y) && level->cost[i] < RC_NO_COST)
      sample[count++] = level->cost[i];
  }
  if (!count) return 1.f;
  qsort(sample, (size_t)count, sizeof *sample, rc_by_value);
  return fmaxf(sample[count * 3 / 4], 1e-3f);
}

static void weight_row(void *user, int item, int thread) {
  const ballot *b = user;
  const rc_level *level = b->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    size_t at = rc_level_at(level, x, y);
    bool votes = rc_level_is_target(level, x, y) && !isnan(level->field[at].a);
    float trust = level->weight[(size_t)y * (size_t)level->width + (size_t)x];
    /* The floor keeps a pixel whose patches all fit badly from having no vote at all. */
    b->weight[at] = votes ? trust * fmaxf(rc_exp(b->scale * level->cost[at]), 1e-6f) : 0.f;
  }
}

/* What the copy of box pixel at proposes for a pixel. */
typedef struct proposal {
  rc_copy copy;
  float value[RC_COMPONENTS];
  bool valid;
} proposal;

static void propose(const rc_level *level, size_t at, int x, int y, proposal *p) {
  uint32_t pixel = 0;
  rc_copy copy = level->field[at];
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
  p->copy = copy;
  p->valid = rc_place_field_pixel(level, &place, at, &pixel);
  for (int k = 0; k < RC_COMPONENTS; k++) p->value[k] = (float)(pixel >> 8 * k & 255);
}

static void vote_pixel(const ballot *b, int x, int y) {
  const rc_level *level = b->level;
  float sum[RC_COMPONENTS] = {0}, total = 0.f;
  proposal p = {.copy = {NAN, NAN, NAN}};
  for (int py = y - RC_PATCH_RADIUS; py <= y + RC_PATCH_RADIUS; py += STRIDE) {
    if (py < level->box.y0 || py >= level->box.y1) continue;
    for (int px = x - RC_PATCH_RADIUS; px <= x + RC_PATCH_RADIUS; px += STRIDE) {
      if (px < level->box.x0 || px >= level->box.x1) continue;
      size_t at = rc_level_at(level, px, py);
      float weight = b->weight[at];
      if (!(weight > 0.f) || !rc_level_same_board(level, x, y, px, py)) continue;
      if (!rc_same_copy(level->field[at], p.copy)) /* neighbours mostly agree */
        propose(level, at, x, y, &p);
      if (!p.valid) continue;
      for (int k = 0; k < RC_COMPONENTS; k++) sum[k] += weight * p.value[k];
      total += weight;
    }
  }
  if (!(total > 0.f)) return;
  uint32_t pixel = 0;
  for (int k = 0; k < RC_COMPONENTS; k++) pixel |= (uint32_t)(sum[k] / total + .5f) << 8 * k;
  level->pixels[(size_t)y * (size_t)level->width + (size_t)x] = pixel;
}

/* Only sources are read, which are no target pixels: the guide can be written in place. */
static void vote_row(void *user, int item, int thread) {
  const ballot *b = user;
  int y = b->level->box.y0 + item;
  (void)thread;
  for (int x = b->level->box.x0; x < b->level->box.x1; x++)
    if (rc_level_is_target(b->level, x, y)) vote_pixel(b, x, y);
}

recede_status rc_vote(rc_context *context, rc_level *level) {
  ballot b = {level, NULL, -1.f / (2.f * SHARPNESS * upper_quartile(level))};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)level->box_w * (size_t)level->box_h, &b.weight));
  RC_TRY(rc_parallel(context, level->box_h, weight_row, &b));
  RC_TRY(rc_parallel(context, level->box_h, vote_row, &b));
  rc_release(context, mark);
  return RECEDE_OK;
}

void rc_field_from_coarser(rc_level *level, const rc_level *coarser) {
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = rc_level_at(level, x, y);
      level->field[at] = (rc_copy){NAN, NAN, NAN};
      level->cost[at] = RC_NO_COST;
      if (!rc_level_is_target(level, x, y)) continue;
      size_t from = rc_level_at(coarser, x / 2, y / 2); /* a target, for it has one in it */
      level->field[at] = rc_copy_finer(coarser->field[from]);
      level->cost[at] = coarser->cost[from];
    }
}
