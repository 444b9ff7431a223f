#include "synthesis/search/gain.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"

/* Sums over each row's sources. */
typedef struct deviation {
  const rc_image *residual;
  const rc_mask *flags;
  double *squares;
  int *counts;
} deviation;

static void sum_row(void *user, int y, int thread) {
  const deviation *d = user;
  const float *pixel = rc_pixel(d->residual, 0, y);
  const uint8_t *flags = rc_flag(d->flags, 0, y);
  int channels = d->residual->channels, count = 0;
  double square = 0;
  (void)thread;
  for (int x = 0; x < d->residual->width; x++, pixel += channels) {
    if (!(flags[x] & RC_SOURCE)) continue;
    for (int k = 0; k < channels; k++) square += (double)pixel[k] * (double)pixel[k];
    count += channels;
  }
  d->squares[y] = square, d->counts[y] = count;
}

recede_status rc_find_gain(rc_context *context, const rc_image *residual, const rc_mask *flags,
                           float *gain) {
  deviation d = {residual, flags, NULL, NULL};
  double square = 0, count = 0;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, residual->height, &d.squares));
  RC_TRY(RC_NEW(context, residual->height, &d.counts));
  RC_TRY(rc_parallel(context, residual->height, sum_row, &d));
  for (int y = 0; y < residual->height; y++) square += d.squares[y], count += d.counts[y];
  rc_release(context, mark);
  double off = count > 0 ? sqrt(square / count) : 0;
  *gain = off > 1e-9 ? (float)(127 / (RC_GAIN_DEVIATIONS * off)) : 1.f;
  return RECEDE_OK;
}
