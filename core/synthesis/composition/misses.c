#include "synthesis/composition/misses.h"

#include <string.h>

#include "base/memory.h"

/* Around a pixel of the border: its square of so many px, and those beside it half. */
#define SQUARE_PX 12
/* What is off the others by so many times the mean miss counts a quarter. By twice, tiles that the
 * border cuts change their tone sooner; by four times flowers shine. */
#define OFF 3.f
/* Of a square: three channels and the weight. */
#define EACH 4

static float *square_at(const rc_misses *m, float *squares, int column, int row) {
  return squares + ((size_t)row * (size_t)m->columns + (size_t)column) * EACH;
}

recede_status rc_misses_new(rc_context *context, rc_box box, int channels, float unit,
                            rc_misses *misses) {
  /* A frame of two around, so that every square of the border has neighbours. */
  *misses = (rc_misses){.x0 = box.x0 - 2 * SQUARE_PX,
                        .y0 = box.y0 - 2 * SQUARE_PX,
                        .columns = (box.x1 - box.x0) / SQUARE_PX + 5,
                        .rows = (box.y1 - box.y0) / SQUARE_PX + 5,
                        .channels = channels,
                        .unit = unit};
  size_t floats = (size_t)misses->columns * (size_t)misses->rows * EACH;
  RC_TRY(RC_NEW_ZERO(context, floats, &misses->sums));
  return RC_NEW_ZERO(context, floats, &misses->common);
}

/* What is in common at (x, y), between the middles of four squares. */
static void common_at(const rc_misses *m, int x, int y, float *common) {
  float column = (float)(x - m->x0) / SQUARE_PX - .5f, row = (float)(y - m->y0) / SQUARE_PX - .5f;
  int i = (int)column, j = (int)row;
  float right = column - (float)i, below = row - (float)j, sums[EACH] = {0};
  for (int n = 0; n < 4; n++) {
    const float *square = square_at(m, m->common, i + (n & 1), j + (n >> 1));
    float weight = (n & 1 ? right : 1.f - right) * (n >> 1 ? below : 1.f - below);
    for (int k = 0; k < EACH; k++) sums[k] += weight * square[k];
  }
  for (int k = 0; k < m->channels; k++)
    common[k] = sums[EACH - 1] > 0.f ? sums[k] / sums[EACH - 1] : 0.f;
}

static float weight_of(const rc_misses *m, const float *miss, const float *common) {
  float off = 0;
  for (int k = 0; k < m->channels; k++) off += (miss[k] - common[k]) * (miss[k] - common[k]);
  off = m->unit > 0.f ? off / (OFF * OFF * m->unit * m->unit) : 0.f;
  return 1.f / ((1.f + off) * (1.f + off));
}

void rc_misses_add(rc_misses *misses, int x, int y, const float *miss) {
  float weight = 1, common[3];
  float *sums =
      square_at(misses, misses->sums, (x - misses->x0) / SQUARE_PX, (y - misses->y0) / SQUARE_PX);
  if (misses->settled) {
    common_at(misses, x, y, common);
    weight = weight_of(misses, miss, common);
  }
  for (int k = 0; k < misses->channels; k++) sums[k] += weight * miss[k];
  sums[EACH - 1] += weight;
}

static void smooth_square(const rc_misses *m, int column, int row) {
  float *to = square_at(m, m->common, column, row);
  memset(to, 0, EACH * sizeof *to);
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      const float *from = square_at(m, m->sums, column + dx, row + dy);
      float weight = (dx ? .5f : 1.f) * (dy ? .5f : 1.f);
      for (int k = 0; k < EACH; k++) to[k] += weight * from[k];
    }
}

void rc_misses_settle(rc_misses *misses) {
  for (int row = 1; row + 1 < misses->rows; row++)
    for (int column = 1; column + 1 < misses->columns; column++) smooth_square(misses, column, row);
  memset(misses->sums, 0,
         (size_t)misses->columns * (size_t)misses->rows * EACH * sizeof *misses->sums);
  misses->settled = true;
}

void rc_misses_tone(const rc_misses *misses, int x, int y, const float *miss, float *tone) {
  common_at(misses, x, y, tone);
  float weight = weight_of(misses, miss, tone);
  for (int k = 0; k < misses->channels; k++) tone[k] += weight * (miss[k] - tone[k]);
}
