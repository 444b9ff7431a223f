#include "plane/estimate.h"

recede_status rc_estimate_plane(rc_context *context, const rc_image *image, const rc_mask *flags,
                                double fov_deg, recede_plane *plane, double *confidence) {
  (void)image, (void)flags, (void)fov_deg, (void)plane, (void)confidence;
  return rc_fail(context, RECEDE_NO_PLANE,
                 "Reading the orientation from the picture is not there yet: give slant and tilt.");
}
