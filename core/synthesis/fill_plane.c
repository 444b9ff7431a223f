#include "synthesis/problem.h"

recede_status rc_fill_plane(rc_context *context, const rc_problem *problem,
                            const recede_params *params, rc_image *filled) {
  (void)problem, (void)params, (void)filled;
  return rc_fail(context, RECEDE_INTERNAL, "Method plane is not there yet.");
}

uint64_t rc_plane_bytes(uint64_t pixels, uint64_t target, int channels,
                        const recede_params *params) {
  (void)params;
  return pixels * (uint64_t)channels * 8 + target * 64;
}
