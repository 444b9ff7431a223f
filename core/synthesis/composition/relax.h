/* Screened Poisson: sum over edges of counts (f_p - f_q - drive)^2 + screening f^2, least; by
 * red-black over-relaxation. */
#ifndef RECEDE_SYNTHESIS_COMPOSITION_RELAX_H
#define RECEDE_SYNTHESIS_COMPOSITION_RELAX_H

#include "base/context.h"

/* What an edge counts at the most. */
#define RC_WHOLE_EDGE 128.f

/* Of a box of pixels. Unknowns are kept so that a sweep over one colour runs through memory in
 * order: of each row first the even columns, then the odd ones, half_w of each, channel by channel.
 */
typedef struct rc_relaxation {
  int rows, half_w, channels;
  float *unknown, *drive; /* and the right-hand side: per pixel, what all its edges ask for */
  uint8_t *edges[4]; /* what those to the left, right, above and below count; 0: there is none */
  float screening, relaxation;
} rc_relaxation;

/* The first of the columns of one parity; pads surround them on all sides, so that no border has to
 * be asked for. */
static inline size_t rc_half_row(const rc_relaxation *r, int row, int parity, int channel) {
  size_t line = (size_t)((row + 1) * 2 + parity) * (size_t)r->channels + (size_t)channel;
  return line * (size_t)(r->half_w + 2) + 1;
}
static inline size_t rc_half_edges(const rc_relaxation *r, int row, int parity) {
  return (size_t)(row * 2 + parity) * (size_t)r->half_w;
}

/* All is 0. */
recede_status rc_relaxation_new(rc_context *context, int width, int height, int channels,
                                rc_relaxation *r);
/* So many sweeps, rounded up to a multiple of 8, from the unknowns as they are; drive decays over
 * so many px. */
recede_status rc_relax(rc_context *context, float reach_px, int sweeps, rc_relaxation *r);

#endif
