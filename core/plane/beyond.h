/* A hole that the plane's horizon crosses, where what lies beyond it looks like what lies before:
 * such a horizon is none. */
#ifndef RECEDE_PLANE_BEYOND_H
#define RECEDE_PLANE_BEYOND_H

#include "image/image.h"
#include "recede.h"

/* Which part of what lies around the hole (RC_TARGET) beyond the horizon looks like what lies
 * around it on the plane: 0..1. 0, too, where the horizon does not cross the hole, or too little is
 * seen. */
recede_status rc_alike_beyond(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const recede_plane *plane, double *part);

#endif
