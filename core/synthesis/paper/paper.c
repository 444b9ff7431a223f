#include "synthesis/problem.h"

recede_status rc_fill_paper(rc_context *context, const rc_problem *problem,
                            const recede_params *params, rc_image *filled) {
  (void)problem, (void)params, (void)filled;
  return rc_fail(context, RECEDE_INTERNAL, "Method paper is not there yet.");
}

recede_status rc_synthesize_paper(rc_context *context, const rc_image *exemplar,
                                  const rc_mask *flags, const recede_plane *plane,
                                  const recede_params *params, rc_image *result) {
  (void)exemplar, (void)flags, (void)plane, (void)params, (void)result;
  return rc_fail(context, RECEDE_INTERNAL, "Method paper is not there yet.");
}

uint64_t rc_paper_bytes(uint64_t exemplar_pixels, uint64_t target, int channels,
                        const recede_params *params) {
  (void)params;
  return (exemplar_pixels + target) * (uint64_t)channels * 64;
}
