#include "synthesis/composition/compose.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/composition/misses.h"
#include "synthesis/composition/relax.h"
#include "synthesis/search/evaluate.h"

/* What an edge between two pixels counts in the join: a tile takes its neighbour's tone on up to
 * its own joint, not across it. So within a copy an edge counts half where the copy changes as much
 * as copies do in the mean. Between copies it counts whole: near the horizon, where hardly two
 * pixels have one copy, those with contrast would else be levelled by those without. */
#define LEAST_EDGE 1.f
/* But no farther than this part of the hole, or a small one would have no tone of its own. */
#define REACH_OF_HOLE .2f
#define LEAST_REACH_PX 7.f
/* Where the hole cuts through a thing that no copy continues, its colour must not shine into the
 * hole: an edge to a known pixel that the copy misses by more than so many times the mean counts
 * less, by the fourth power. From twice the mean on, by the square, texture lost its tone, too. */
#define MISSES_BY 4.f
/* The mean is of misses that are no more than so many times the mean of all: a white line along the
 * border would else be its own measure. */
#define THINGS_MISS_BY 3.f
/* What the border's misses do not have in common reaches so far: flowers that the border cuts do
 * not shine, and what is off a little leaves no seam. */
#define REACH_OF_THINGS_PX 3.f
#define SWEEPS_OF_THINGS 8
/* Sources finer than this many px per px across the tilt are sampled one level coarser. */
#define MIP_AT 1.6f
/* And of a level that is finer still along it so many samples are taken, of one px or a little more
 * each. By mips that went by the mean of both directions copies got soft across, in patches. */
#define TAPS_ROUND .4f
#define MOST_TAPS 8

/* Of a row: squares, and how many. */
typedef struct row_changes {
  double sum, count;
} row_changes;

typedef struct composition {
  const rc_level *level;
  const rc_sampler *sampler;
  const rc_image *mips;
  int mip_count, channels;
  rc_image *residual;
  float *value;       /* the copies' own values, box by channels */
  rc_relaxation join; /* what it adds to the values */
  rc_misses misses;
  int32_t *border; /* indices of the box's pixels that touch known ones, in order */
  int border_count;
  float mean_change; /* square between neighbours, sum over channels */
  float mean_miss;   /* how far copies are from the known pixels beside them, a distance */
  row_changes *changes;
} composition;

static const int step_x[4] = {-1, 1, 0, 0}, step_y[4] = {0, 0, -1, 1};

static bool is_known(const rc_level *level, size_t at) { return level->flags[at] & RC_KNOWN; }

static bool is_fixed(const rc_level *level, int x, int y) {
  return rc_inside(level->width, level->height, x, y) &&
         is_known(level, (size_t)y * (size_t)level->width + (size_t)x);
}

/* The texture that a copy puts at (x, y); false: it leads to nothing known. Flat copies are finer
 * along the tilt than across it: mips go by what is across, and along it the mean of several
 * samples is taken. */
static bool copy_value(const composition *c, rc_copy copy, int x, int y, float *value) {
  const rc_chart *chart = &c->level->chart;
  float at_x = rc_level_x(c->level, x), at_y = rc_level_y(c->level, y), scale = 1.f;
  rc_place place = rc_copy_place(chart, copy, at_x, at_y);
  float across = place.ratio, along = copy.r > 0.f ? across : across * across;
  size_t source;
  bool known = rc_place_at(c->level, &place, &source) && is_known(c->level, source);
  int mip = 0;
  for (; mip + 1 < c->mip_count && across * scale > MIP_AT; mip++) scale *= .5f;
  float wanted = along * scale + TAPS_ROUND; /* NaN where the copy leads beyond the horizon */
  int taps = !(wanted >= 1.f) ? 1 : wanted < MOST_TAPS ? (int)wanted : MOST_TAPS;
  float steep = sqrtf(chart->lx * chart->lx + chart->ly * chart->ly), sum[3] = {0, 0, 0};
  if (copy.r > 0.f || !(steep > 0.f)) taps = 1;
  for (int i = 0; i < taps; i++) {
    if (taps > 1) {
      float step = (((float)i + .5f) / (float)taps - .5f) / steep;
      place = rc_copy_place(chart, copy, at_x + chart->lx * step, at_y + chart->ly * step);
    }
    float sx = (place.x + chart->x0 + .5f) * scale - .5f;
    float sy = (place.y + chart->y0 + .5f) * scale - .5f;
    rc_sample(c->sampler, &c->mips[mip], sx, sy, value);
    for (int k = 0; k < c->channels; k++) sum[k] += value[k];
  }
  for (int k = 0; k < c->channels; k++) value[k] = sum[k] / (float)taps;
  return known;
}

static void sample_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    size_t at = rc_level_at(level, x, y);
    float *value = c->value + at * (size_t)c->channels;
    if (!rc_level_is_target(level, x, y)) continue;
    if (isnan(level->field[at].a))
      memset(value, 0, (size_t)c->channels * sizeof *value); /* no source: the tone alone */
    else
      copy_value(c, level->field[at], x, y, value);
  }
}

static float change(const composition *c, const float *from, const float *to) {
  float sum = 0.f;
  for (int k = 0; k < c->channels; k++) sum += (to[k] - from[k]) * (to[k] - from[k]);
  return sum;
}

/* What the copy of target (x, y) has to its side e, or at least here, and by how much the pixel to
 * that side is off it. False: that is no known pixel. */
static bool miss_at(const composition *c, int x, int y, int e, float *there, float *miss) {
  int nx = x + step_x[e], ny = y + step_y[e];
  rc_copy own = c->level->field[rc_level_at(c->level, x, y)];
  if (isnan(own.a) || !is_fixed(c->level, nx, ny)) return false;
  if (!copy_value(c, own, nx, ny, there)) copy_value(c, own, x, y, there);
  for (int k = 0; k < c->channels; k++) miss[k] = rc_pixel(c->residual, nx, ny)[k] - there[k];
  return true;
}

static float square_of(const composition *c, const float *miss) {
  float square = 0.f;
  for (int k = 0; k < c->channels; k++) square += miss[k] * miss[k];
  return square;
}

/* Between targets, to the right and below. */
static void sum_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  row_changes sums = {0, 0};
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    if (!rc_level_is_target(level, x, y)) continue;
    const float *value = c->value + rc_level_at(level, x, y) * (size_t)c->channels;
    const float *below = value + (size_t)level->box_w * (size_t)c->channels;
    if (x + 1 < level->box.x1 && rc_level_is_target(level, x + 1, y))
      sums.sum += (double)change(c, value, value + c->channels), sums.count++;
    if (y + 1 < level->box.y1 && rc_level_is_target(level, x, y + 1))
      sums.sum += (double)change(c, value, below), sums.count++;
  }
  c->changes[item] = sums;
}

static recede_status set_mean_change(rc_context *context, composition *c) {
  double sum = 0, count = 0;
  RC_TRY(RC_NEW(context, c->level->box_h, &c->changes));
  RC_TRY(rc_parallel(context, c->level->box_h, sum_row, c));
  for (int row = 0; row < c->level->box_h; row++)
    sum += c->changes[row].sum, count += c->changes[row].count;
  c->mean_change = count > 0 ? (float)(sum / count) : 0.f;
  return RECEDE_OK;
}

static recede_status collect_border(rc_context *context, composition *c) {
  const rc_box *box = &c->level->box;
  const rc_mask flags = {c->level->width, c->level->height, c->level->flags};
  uint8_t *at;
  RC_TRY(RC_NEW(context, c->level->box_w, &at));
  for (int filling = 0; filling < 2; filling++) {
    c->border_count = 0;
    for (int y = box->y0; y < box->y1; y++) {
      rc_border_of_row(&flags, y, box->x0, box->x1, at);
      for (int x = box->x0; x < box->x1; x++) {
        if (!at[x - box->x0]) continue;
        if (filling) c->border[c->border_count] = (int32_t)rc_level_at(c->level, x, y);
        c->border_count++;
      }
      RC_TRY(rc_poll(context));
    }
    if (!filling) RC_TRY(RC_NEW(context, c->border_count + 1, &c->border));
  }
  return RECEDE_OK;
}

static void border_at(const composition *c, int i, int *x, int *y) {
  *x = c->level->box.x0 + c->border[i] % c->level->box_w;
  *y = c->level->box.y0 + c->border[i] / c->level->box_w;
}

/* Of those that are no more than most. */
static recede_status set_mean_miss(rc_context *context, float most, composition *c) {
  double sum = 0, count = 0;
  for (int i = 0; i < c->border_count; i++) {
    float there[3], miss[3];
    int x, y;
    if (i % RC_POLLED_PX == 0) RC_TRY(rc_poll(context));
    border_at(c, i, &x, &y);
    for (int e = 0; e < 4; e++) {
      if (!miss_at(c, x, y, e, there, miss)) continue;
      double distance = sqrt((double)square_of(c, miss));
      if (distance <= (double)most) sum += distance, count++;
    }
  }
  c->mean_miss = count > 0 ? (float)(sum / count) : 0.f;
  return RECEDE_OK;
}

/* Of the edge between two pixels of one copy. */
static uint8_t count_of(const composition *c, const float *from, const float *to) {
  float changed = change(c, from, to);
  float part = c->mean_change > 0.f ? changed / c->mean_change : 0.f;
  float counts = RC_WHOLE_EDGE / (1.f + part);
  return (uint8_t)(counts > LEAST_EDGE ? counts : LEAST_EDGE);
}

/* Of the edge to a known pixel, which is off what the copy has there. */
static uint8_t count_of_fixed(const composition *c, const float *value, const float *there,
                              const float *miss) {
  float counts = (float)count_of(c, value, there), most = MISSES_BY * c->mean_miss;
  float missed = most > 0.f ? square_of(c, miss) / (most * most) : 0.f;
  return (uint8_t)(missed > 1.f ? counts / (missed * missed) : counts);
}

/* What the edge to side e counts, and adds what it asks of pixel (x, y) beyond what the copies'
 * values give already; of a known pixel, which is fixed, the tone alone. */
static uint8_t add_edge(const composition *c, int x, int y, int e, const float *value,
                        float *drive) {
  const rc_level *level = c->level;
  int nx = x + step_x[e], ny = y + step_y[e];
  rc_copy own = level->field[rc_level_at(level, x, y)];
  float there[3], back[3], miss[3], tone[3];
  if (miss_at(c, x, y, e, there, miss)) { /* the copy's own gradient */
    uint8_t counts = count_of_fixed(c, value, there, miss);
    rc_misses_tone(&c->misses, x, y, miss, tone);
    for (int k = 0; k < c->channels; k++) drive[k] += (float)counts * tone[k];
    return counts;
  }
  if (!rc_inside(level->width, level->height, nx, ny) || !rc_level_is_target(level, nx, ny))
    return 0;
  size_t at = rc_level_at(level, nx, ny);
  rc_copy other = level->field[at];
  const float *neighbour = c->value + at * (size_t)c->channels;
  /* Of one dash, whatever its copies are. */
  bool one_thing =
      level->laid && level->laid[at] && level->laid[at] == level->laid[rc_level_at(level, x, y)];
  if (isnan(other.a) || rc_same_copy(own, other) || one_thing) return count_of(c, value, neighbour);
  bool own_goes_on = copy_value(c, own, nx, ny, there);
  bool other_goes_on = copy_value(c, other, x, y, back);
  float share = own_goes_on && other_goes_on ? .5f : 1.f;
  for (int k = 0; k < c->channels; k++) {
    float across = 0.f;
    if (own_goes_on) across += value[k] - there[k];
    if (other_goes_on) across += back[k] - neighbour[k];
    across *= share;
    drive[k] += RC_WHOLE_EDGE * (across - (value[k] - neighbour[k]));
  }
  return (uint8_t)RC_WHOLE_EDGE;
}

static void set_drive(const composition *c, int x, int y, const float *drive) {
  int parity = (x - c->level->box.x0) & 1, column = (x - c->level->box.x0) / 2;
  for (int k = 0; k < c->channels; k++)
    c->join.drive[rc_half_row(&c->join, y - c->level->box.y0, parity, k) + (size_t)column] =
        drive[k];
}

/* The join's index of the edges of (x, y). */
static size_t edge_at(const composition *c, int x, int y) {
  int parity = (x - c->level->box.x0) & 1, column = (x - c->level->box.x0) / 2;
  return rc_half_edges(&c->join, y - c->level->box.y0, parity) + (size_t)column;
}

static void drive_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    size_t at = rc_level_at(level, x, y), edge = edge_at(c, x, y);
    float drive[3] = {0, 0, 0};
    if (!rc_level_is_target(level, x, y) || isnan(level->field[at].a)) continue;
    for (int e = 0; e < 4; e++)
      c->join.edges[e][edge] = add_edge(c, x, y, e, c->value + at * (size_t)c->channels, drive);
    set_drive(c, x, y, drive);
  }
}

/* What is left of the border's misses without their tone. */
static void drive_things_row(void *user, int item, int thread) {
  const composition *c = user;
  int y = c->level->box.y0 + item;
  (void)thread;
  for (int x = c->level->box.x0; x < c->level->box.x1; x++) {
    float drive[3] = {0, 0, 0}, there[3], miss[3], tone[3];
    if (!rc_level_is_target(c->level, x, y)) continue;
    for (int e = 0; e < 4; e++) {
      if (!miss_at(c, x, y, e, there, miss)) continue;
      rc_misses_tone(&c->misses, x, y, miss, tone);
      float counts = (float)c->join.edges[e][edge_at(c, x, y)];
      for (int k = 0; k < c->channels; k++) drive[k] += counts * (miss[k] - tone[k]);
    }
    set_drive(c, x, y, drive);
  }
}

/* Adds what was solved to the values, and begins anew. */
static void correct_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    int parity = (x - level->box.x0) & 1, column = (x - level->box.x0) / 2;
    bool is_target = rc_level_is_target(level, x, level->box.y0 + item);
    float *value = c->value + rc_level_at(level, x, level->box.y0 + item) * (size_t)c->channels;
    for (int k = 0; k < c->channels; k++) {
      float *solved = c->join.unknown + rc_half_row(&c->join, item, parity, k) + column;
      if (is_target) value[k] += *solved;
      *solved = 0;
    }
  }
}

static recede_status find_tone_of_misses(rc_context *context, composition *c) {
  float there[3], miss[3];
  int x, y;
  RC_TRY(rc_misses_new(context, c->level->box, c->channels, c->mean_miss, &c->misses));
  for (int round = 0; round < RC_MISS_ROUNDS; round++) {
    for (int i = 0; i < c->border_count; i++) {
      if (i % RC_POLLED_PX == 0) RC_TRY(rc_poll(context));
      border_at(c, i, &x, &y);
      for (int e = 0; e < 4; e++)
        if (miss_at(c, x, y, e, there, miss)) rc_misses_add(&c->misses, x, y, miss);
    }
    rc_misses_settle(&c->misses);
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

static recede_status solve_join(rc_context *context, const rc_join *join, composition *c) {
  int rows = c->level->box_h, columns = c->level->box_w;
  float of_hole = REACH_OF_HOLE * (float)(rows < columns ? rows : columns);
  float reach_px = fminf(join->reach_px, fmaxf(of_hole, LEAST_REACH_PX));
  RC_TRY(rc_relaxation_new(context, columns, rows, c->channels, &c->join));
  RC_TRY(collect_border(context, c));
  RC_TRY(set_mean_change(context, c));
  RC_TRY(set_mean_miss(context, INFINITY, c));
  RC_TRY(set_mean_miss(context, THINGS_MISS_BY * c->mean_miss, c));
  RC_TRY(find_tone_of_misses(context, c));
  RC_TRY(rc_parallel(context, rows, drive_row, c));
  RC_TRY(rc_relax(context, reach_px, join->sweeps, &c->join));
  RC_TRY(rc_parallel(context, rows, correct_row, c));
  RC_TRY(rc_parallel(context, rows, drive_things_row, c));
  RC_TRY(rc_relax(context, REACH_OF_THINGS_PX, SWEEPS_OF_THINGS, &c->join));
  return rc_parallel(context, rows, correct_row, c);
}

static void write_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    const float *value = c->value + rc_level_at(level, x, y) * (size_t)c->channels;
    if (rc_level_is_target(level, x, y))
      memcpy(rc_pixel(c->residual, x, y), value, (size_t)c->channels * sizeof *value);
  }
}

recede_status rc_compose(rc_context *context, const rc_level *level, const rc_sampler *sampler,
                         const rc_image *mips, int mip_count, const rc_join *join,
                         rc_image *residual) {
  composition c = {.level = level,
                   .sampler = sampler,
                   .mips = mips,
                   .mip_count = mip_count,
                   .channels = residual->channels,
                   .residual = residual};
  size_t values = (size_t)level->box_w * (size_t)level->box_h * (size_t)c.channels;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, values, &c.value));
  RC_TRY(rc_parallel(context, level->box_h, sample_row, &c));
  if (join) RC_TRY(solve_join(context, join, &c));
  RC_TRY(rc_parallel(context, level->box_h, write_row, &c));
  rc_release(context, mark);
  return RECEDE_OK;
}
