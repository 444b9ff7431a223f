/* Orientation read from a picture. */
#ifndef RECEDE_PLANE_ESTIMATE_H
#define RECEDE_PLANE_ESTIMATE_H

#include "image/image.h"

/* Whether the sources are a smaller part of all that is known, not all but a dirty corner. */
bool rc_sources_are_chosen(const rc_mask *flags);

/* image is the whole picture or a smaller copy of it; only pixels with RC_SOURCE are looked at.
 * Where they are chosen, they are taken to lie on the plane; else
 * there may be a sky. on (may be NULL): an image point (x, y) px that lies on the plane that is
 * meant. *plane gets image's own size and the given field of view; *confidence 0..1.
 * RECEDE_NO_PLANE when nothing can be said (too few pixels, no texture). */
recede_status rc_estimate_plane(rc_context *context, const rc_image *image, const rc_mask *flags,
                                double fov_deg, const double on[2], recede_plane *plane,
                                double *confidence);

#endif
