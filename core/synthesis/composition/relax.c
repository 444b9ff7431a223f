#include "synthesis/composition/relax.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"

/* Half sweeps, red or black, that are done at once, and the rows of a band: a few hundred KB. */
#define AT_ONCE 16
#define BAND_ROWS 64
/* And columns whose edges are read at once: 24 bytes each. */
#define COLUMNS 64

recede_status rc_relaxation_new(rc_context *context, int width, int height, int channels,
                                rc_relaxation *r) {
  *r = (rc_relaxation){.rows = height, .half_w = (width + 1) / 2, .channels = channels};
  size_t count = rc_half_row(r, height + 1, 0, 0);
  RC_TRY(RC_NEW_ZERO(context, count, &r->unknown));
  RC_TRY(RC_NEW_ZERO(context, count, &r->drive));
  for (int e = 0; e < 4; e++)
    RC_TRY(RC_NEW_ZERO(context, (size_t)height * 2 * (size_t)r->half_w, &r->edges[e]));
  return RECEDE_OK;
}

/* What the edges of some columns count, the same for all channels. */
typedef struct edge_counts {
  float left[COLUMNS], right[COLUMNS], up[COLUMNS], down[COLUMNS], all[COLUMNS];
  float step[COLUMNS]; /* 0 for pixels without edges, which are none of the join's and stay 0 */
} edge_counts;

static void count_edges(const rc_relaxation *join, size_t edge, int columns, edge_counts *counts) {
  const uint8_t *l = join->edges[0] + edge, *r = join->edges[1] + edge, *u = join->edges[2] + edge,
                *d = join->edges[3] + edge;
  for (int i = 0; i < columns; i++) {
    int edges = l[i] + r[i] + u[i] + d[i];
    counts->left[i] = (float)l[i], counts->right[i] = (float)r[i];
    counts->up[i] = (float)u[i], counts->down[i] = (float)d[i];
    counts->all[i] = (float)edges + join->screening;
    counts->step[i] = (float)(edges > 0) * (join->relaxation / counts->all[i]);
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

static void relax_row(const rc_relaxation *r, int row, int half_sweep) {
  int parity = (row + half_sweep) & 1;
  float *all = r->unknown;
  edge_counts counts;
  for (int first = 0; first < r->half_w; first += COLUMNS) {
    int columns = r->half_w - first < COLUMNS ? r->half_w - first : COLUMNS;
    count_edges(r, rc_half_edges(r, row, parity) + (size_t)first, columns, &counts);
    for (int k = 0; k < r->channels; k++) {
      size_t own = rc_half_row(r, row, parity, k) + (size_t)first;
      size_t across = rc_half_row(r, row, !parity, k) + (size_t)first;
      size_t above = rc_half_row(r, row - 1, parity, k) + (size_t)first;
      size_t below = rc_half_row(r, row + 1, parity, k) + (size_t)first;
      relax(&counts, columns, r->drive + own, all + across - !parity, all + above, all + below,
            all + own);
    }
  }
}

/* A half sweep needs its neighbours' rows after the one before. So a band loses a row at each end
 * with every half sweep ... */
static void relax_band(void *user, int band, int thread) {
  const rc_relaxation *r = user;
  int rows = r->rows, first = band * BAND_ROWS, end = first + BAND_ROWS;
  (void)thread;
  for (int h = 0; h < AT_ONCE; h++) {
    int from = first ? first + h : 0, to = end < rows ? end - h : rows;
    for (int row = from; row < to; row++) relax_row(r, row, h);
  }
}

/* ... and between two bands as many are left to be done, two more each time. */
static void relax_seam(void *user, int seam, int thread) {
  const rc_relaxation *r = user;
  int rows = r->rows, middle = (seam + 1) * BAND_ROWS;
  (void)thread;
  for (int h = 1; h < AT_ONCE; h++)
    for (int row = middle - h; row < middle + h && row < rows; row++) relax_row(r, row, h);
}

recede_status rc_relax(rc_context *context, float reach_px, int sweeps, rc_relaxation *r) {
  int bands = (r->rows + BAND_ROWS - 1) / BAND_ROWS;
  /* Over-relaxed by what is best for whole edges: their Jacobi radius is */
  float screening = 1.f / (reach_px * reach_px), radius = 4.f / (4.f + screening);
  r->screening = RC_WHOLE_EDGE * screening;
  r->relaxation = 2.f / (1.f + sqrtf(1.f - radius * radius));
  for (int done = 0; done < 2 * sweeps; done += AT_ONCE) {
    RC_TRY(rc_parallel(context, bands, relax_band, r));
    RC_TRY(rc_parallel(context, bands - 1, relax_seam, r));
  }
  return RECEDE_OK;
}
