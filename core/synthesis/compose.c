#include "synthesis/compose.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

/* What an edge between two pixels counts in the join: a tile takes its neighbour's tone on up to
 * its own joint, not across it. So within a copy an edge counts half where the copy changes as much
 * as copies do in the mean. Between copies it counts whole: near the horizon, where hardly two
 * pixels have one copy, those with contrast would else be levelled by those without. */
#define WHOLE_EDGE 128.f
#define LEAST_EDGE 1.f
/* But no farther than this part of the hole, or a small one would have no tone of its own. */
#define REACH_OF_HOLE .2f
#define LEAST_REACH_PX 7.f
/* Where the hole cuts through a thing that no copy continues, its colour must not shine into the
 * hole: an edge to a known pixel that the copy misses by more than so many times the mean counts
 * less, by the fourth power. From twice the mean on, by the square, texture lost its tone, too. */
#define MISSES_BY 4.f
/* Half sweeps, red or black, that are done at once, and the rows of a band: a few hundred KB. */
#define AT_ONCE 16
#define BAND_ROWS 64
/* And columns whose edges are read at once: 24 bytes each. */
#define COLUMNS 64
/* Sources finer than this many px per px, the mean of both directions, are sampled one level
 * coarser. */
#define MIP_AT 1.6f

typedef struct row_sums {
  double change, changes; /* of squares; how many */
  double miss, misses;
} row_sums;

typedef struct composition {
  const rc_level *level;
  const rc_sampler *sampler;
  const rc_image *mips;
  int mip_count, channels;
  rc_image *residual;
  float *value; /* the copies' own values, box by channels */
  /* The join's unknowns are kept so that a sweep over one colour runs through memory in order: of
   * each row first the even columns, then the odd ones, half_w of each, channel by channel. */
  int half_w;
  float *correction; /* what the join adds; NULL: there is none */
  float *drive;      /* right-hand side of the join */
  uint8_t *edges[4]; /* what those to a pixel's neighbours count; 0: there is none */
  float mean_change; /* square between neighbours, sum over channels */
  float mean_miss;   /* how far copies are from the known pixels beside them, a distance */
  row_sums *sums;
  float screening, relaxation;
} composition;

static const int step_x[4] = {-1, 1, 0, 0}, step_y[4] = {0, 0, -1, 1};

/* The first of the columns of one parity; pads surround them on all sides, so that no border has to
 * be asked for. */
static size_t half_row(const composition *c, int row, int parity, int channel) {
  size_t line = (size_t)((row + 1) * 2 + parity) * (size_t)c->channels + (size_t)channel;
  return line * (size_t)(c->half_w + 2) + 1;
}
static size_t half_edges(const composition *c, int row, int parity) {
  return (size_t)(row * 2 + parity) * (size_t)c->half_w;
}

/* The texture that a copy puts at (x, y). */
static void copy_value(const composition *c, rc_copy copy, int x, int y, float *value) {
  const rc_chart *chart = &c->level->chart;
  rc_place place = rc_copy_place(chart, copy, rc_level_x(c->level, x), rc_level_y(c->level, y));
  float sx = place.x + chart->x0, sy = place.y + chart->y0, finer = place.ratio;
  if (!chart->raised) finer *= sqrtf(finer); /* ratio across, ratio^2 along */
  int mip = 0;
  for (; mip + 1 < c->mip_count && finer > MIP_AT; mip++, finer *= .5f)
    sx = (sx + .5f) * .5f - .5f, sy = (sy + .5f) * .5f - .5f;
  rc_sample(c->sampler, &c->mips[mip], sx, sy, value);
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

static bool is_fixed(const rc_level *level, int x, int y) {
  if (!rc_inside(level->width, level->height, x, y)) return false;
  return (level->flags[(size_t)y * (size_t)level->width + (size_t)x] & (RC_TARGET | RC_KNOWN)) ==
         RC_KNOWN;
}

static void sum_misses(const composition *c, int x, int y, row_sums *sums) {
  rc_copy own = c->level->field[rc_level_at(c->level, x, y)];
  float there[3];
  if (isnan(own.a)) return;
  for (int e = 0; e < 4; e++) {
    int nx = x + step_x[e], ny = y + step_y[e];
    if (!is_fixed(c->level, nx, ny)) continue;
    copy_value(c, own, nx, ny, there);
    sums->miss += sqrt((double)change(c, there, rc_pixel(c->residual, nx, ny))), sums->misses++;
  }
}

static void sum_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  row_sums sums = {0, 0, 0, 0};
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    if (!rc_level_is_target(level, x, y)) continue;
    const float *value = c->value + rc_level_at(level, x, y) * (size_t)c->channels;
    const float *below = value + (size_t)level->box_w * (size_t)c->channels;
    if (x + 1 < level->box.x1 && rc_level_is_target(level, x + 1, y))
      sums.change += (double)change(c, value, value + c->channels), sums.changes++;
    if (y + 1 < level->box.y1 && rc_level_is_target(level, x, y + 1))
      sums.change += (double)change(c, value, below), sums.changes++;
    sum_misses(c, x, y, &sums);
  }
  c->sums[item] = sums;
}

static recede_status set_means(rc_context *context, composition *c) {
  row_sums all = {0, 0, 0, 0};
  RC_TRY(RC_NEW(context, c->level->box_h, &c->sums));
  RC_TRY(rc_parallel(context, c->level->box_h, sum_row, c));
  for (int row = 0; row < c->level->box_h; row++) {
    all.change += c->sums[row].change, all.changes += c->sums[row].changes;
    all.miss += c->sums[row].miss, all.misses += c->sums[row].misses;
  }
  c->mean_change = all.changes > 0 ? (float)(all.change / all.changes) : 0.f;
  c->mean_miss = all.misses > 0 ? (float)(all.miss / all.misses) : 0.f;
  return RECEDE_OK;
}

/* Of the edge between two pixels of one copy. */
static uint8_t count_of(const composition *c, const float *from, const float *to) {
  float changed = change(c, from, to);
  float part = c->mean_change > 0.f ? changed / c->mean_change : 0.f;
  float counts = WHOLE_EDGE / (1.f + part);
  return (uint8_t)(counts > LEAST_EDGE ? counts : LEAST_EDGE);
}

/* Of the edge to a known pixel, of which the copy says what is there. */
static uint8_t count_of_fixed(const composition *c, const float *value, const float *there,
                              const float *fixed) {
  float counts = (float)count_of(c, value, there), most = MISSES_BY * c->mean_miss;
  float missed = most > 0.f ? change(c, fixed, there) / (most * most) : 0.f;
  if (missed > 1.f) counts /= missed * missed;
  return (uint8_t)(counts > LEAST_EDGE ? counts : LEAST_EDGE);
}

/* What the edge to (nx, ny) counts, and adds what it asks of pixel (x, y) beyond what the copies'
 * values give already. */
static uint8_t add_edge(const composition *c, int x, int y, int nx, int ny, const float *value,
                        float *drive) {
  const rc_level *level = c->level;
  rc_copy own = level->field[rc_level_at(level, x, y)];
  float there[3], back[3];
  if (!rc_level_is_target(level, nx, ny)) { /* a known pixel, fixed; the copy's own gradient */
    const float *fixed = rc_pixel(c->residual, nx, ny);
    copy_value(c, own, nx, ny, there);
    uint8_t counts = count_of_fixed(c, value, there, fixed);
    for (int k = 0; k < c->channels; k++) drive[k] += (float)counts * (fixed[k] - there[k]);
    return counts;
  }
  size_t at = rc_level_at(level, nx, ny);
  rc_copy other = level->field[at];
  const float *neighbour = c->value + at * (size_t)c->channels;
  if (isnan(other.a) || rc_same_copy(own, other)) return count_of(c, value, neighbour);
  copy_value(c, own, nx, ny, there);
  copy_value(c, other, x, y, back);
  for (int k = 0; k < c->channels; k++) {
    float across = .5f * ((value[k] - there[k]) + (back[k] - neighbour[k]));
    drive[k] += WHOLE_EDGE * (across - (value[k] - neighbour[k]));
  }
  return (uint8_t)WHOLE_EDGE;
}

static void drive_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    size_t at = rc_level_at(level, x, y);
    int parity = (x - level->box.x0) & 1, column = (x - level->box.x0) / 2;
    size_t edge = half_edges(c, item, parity) + (size_t)column;
    float drive[3] = {0, 0, 0};
    if (!rc_level_is_target(level, x, y) || isnan(level->field[at].a)) continue;
    for (int e = 0; e < 4; e++) {
      int nx = x + step_x[e], ny = y + step_y[e];
      if (!rc_inside(level->width, level->height, nx, ny)) continue;
      if (!(level->flags[(size_t)ny * (size_t)level->width + (size_t)nx] & (RC_TARGET | RC_KNOWN)))
        continue;
      c->edges[e][edge] = add_edge(c, x, y, nx, ny, c->value + at * (size_t)c->channels, drive);
    }
    for (int k = 0; k < c->channels; k++)
      c->drive[half_row(c, item, parity, k) + (size_t)column] = drive[k];
  }
}

/* What the edges of some columns count, the same for all channels. */
typedef struct edge_counts {
  float left[COLUMNS], right[COLUMNS], up[COLUMNS], down[COLUMNS], all[COLUMNS];
  float step[COLUMNS]; /* 0 for pixels without edges, which are none of the join's and stay 0 */
} edge_counts;

static void count_edges(const composition *c, size_t edge, int columns, edge_counts *counts) {
  const uint8_t *l = c->edges[0] + edge, *r = c->edges[1] + edge, *u = c->edges[2] + edge,
                *d = c->edges[3] + edge;
  for (int i = 0; i < columns; i++) {
    int edges = l[i] + r[i] + u[i] + d[i];
    counts->left[i] = (float)l[i], counts->right[i] = (float)r[i];
    counts->up[i] = (float)u[i], counts->down[i] = (float)d[i];
    counts->all[i] = (float)edges + c->screening;
    counts->step[i] = (float)(edges > 0) * (c->relaxation / counts->all[i]);
  }
}

static void relax(const edge_counts *restrict counts, int columns, const float *restrict drive,
                  const float *restrict left, const float *restrict up, const float *restrict down,
                  float *restrict own) {
  for (int i = 0; i < columns; i++) {
    float sum = drive[i] - counts->all[i] * own[i] + counts->left[i] * left[i] +
                counts->right[i] * left[i + 1] + counts->up[i] * up[i] + counts->down[i] * down[i];
    own[i] += counts->step[i] * sum;
  }
}

static void relax_row(const composition *c, int row, int half_sweep) {
  int parity = (row + half_sweep) & 1;
  float *all = c->correction;
  edge_counts counts;
  for (int first = 0; first < c->half_w; first += COLUMNS) {
    int columns = c->half_w - first < COLUMNS ? c->half_w - first : COLUMNS;
    count_edges(c, half_edges(c, row, parity) + (size_t)first, columns, &counts);
    for (int k = 0; k < c->channels; k++) {
      size_t own = half_row(c, row, parity, k) + (size_t)first;
      size_t across = half_row(c, row, !parity, k) + (size_t)first;
      size_t above = half_row(c, row - 1, parity, k) + (size_t)first;
      size_t below = half_row(c, row + 1, parity, k) + (size_t)first;
      relax(&counts, columns, c->drive + own, all + across - !parity, all + above, all + below,
            all + own);
    }
  }
}

/* A half sweep needs its neighbours' rows after the one before. So a band loses a row at each end
 * with every half sweep ... */
static void relax_band(void *user, int band, int thread) {
  const composition *c = user;
  int rows = c->level->box_h, first = band * BAND_ROWS, end = first + BAND_ROWS;
  (void)thread;
  for (int h = 0; h < AT_ONCE; h++) {
    int from = first ? first + h : 0, to = end < rows ? end - h : rows;
    for (int row = from; row < to; row++) relax_row(c, row, h);
  }
}

/* ... and between two bands as many are left to be done, two more each time. */
static void relax_seam(void *user, int seam, int thread) {
  const composition *c = user;
  int rows = c->level->box_h, middle = (seam + 1) * BAND_ROWS;
  (void)thread;
  for (int h = 1; h < AT_ONCE; h++)
    for (int row = middle - h; row < middle + h && row < rows; row++) relax_row(c, row, h);
}

static recede_status solve_join(rc_context *context, const rc_join *join, composition *c) {
  int rows = c->level->box_h;
  size_t count = (size_t)(rows + 2) * 2 * (size_t)c->channels * (size_t)(c->half_w + 2);
  RC_TRY(RC_NEW_ZERO(context, count, &c->correction));
  RC_TRY(RC_NEW_ZERO(context, count, &c->drive));
  for (int e = 0; e < 4; e++)
    RC_TRY(RC_NEW_ZERO(context, (size_t)rows * 2 * (size_t)c->half_w, &c->edges[e]));
  RC_TRY(set_means(context, c));
  /* Red-black over-relaxation by what is best for whole edges: their Jacobi radius is */
  float of_hole = REACH_OF_HOLE * (float)(rows < c->level->box_w ? rows : c->level->box_w);
  float reach_px = fminf(join->reach_px, fmaxf(of_hole, LEAST_REACH_PX));
  float screening = 1.f / (reach_px * reach_px), radius = 4.f / (4.f + screening);
  c->screening = WHOLE_EDGE * screening;
  c->relaxation = 2.f / (1.f + sqrtf(1.f - radius * radius));
  RC_TRY(rc_parallel(context, rows, drive_row, c));
  int bands = (rows + BAND_ROWS - 1) / BAND_ROWS;
  for (int done = 0; done < 2 * join->sweeps; done += AT_ONCE) {
    RC_TRY(rc_parallel(context, bands, relax_band, c));
    RC_TRY(rc_parallel(context, bands - 1, relax_seam, c));
  }
  return RECEDE_OK;
}

static void write_row(void *user, int item, int thread) {
  const composition *c = user;
  const rc_level *level = c->level;
  int y = level->box.y0 + item;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    int parity = (x - level->box.x0) & 1, column = (x - level->box.x0) / 2;
    const float *value = c->value + rc_level_at(level, x, y) * (size_t)c->channels;
    if (!rc_level_is_target(level, x, y)) continue;
    for (int k = 0; k < c->channels; k++) {
      size_t at = half_row(c, item, parity, k) + (size_t)column;
      rc_pixel(c->residual, x, y)[k] = value[k] + (c->correction ? c->correction[at] : 0.f);
    }
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
                   .residual = residual,
                   .half_w = (level->box_w + 1) / 2};
  size_t values = (size_t)level->box_w * (size_t)level->box_h * (size_t)c.channels;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, values, &c.value));
  RC_TRY(rc_parallel(context, level->box_h, sample_row, &c));
  if (join) RC_TRY(solve_join(context, join, &c));
  RC_TRY(rc_parallel(context, level->box_h, write_row, &c));
  rc_release(context, mark);
  return RECEDE_OK;
}
