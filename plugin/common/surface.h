/* surface.h - the preview's bitmaps: photo, selection outline, shade of the scale map. */
#ifndef RP_SURFACE_H
#define RP_SURFACE_H

#include <cairo.h>

#include "proxy.h"

/* rgba: R'G'B'A, not premultiplied. */
cairo_surface_t *rp_surface_of_pixels(const guchar *rgba, int width, int height);
/* The mask's border, dashed black and white. */
cairo_surface_t *rp_surface_of_outline(const rp_proxy *proxy);
/* Scale across the tilt against that at (x, y): blue smaller, orange larger, grey beyond the
 * horizon; red where the fill must magnify. */
cairo_surface_t *rp_surface_of_scale(const rp_proxy *proxy, const recede_plane *plane, double x,
                                     double y);
/* Only where the fill must magnify; NULL: nowhere. */
cairo_surface_t *rp_surface_of_magnified(const rp_proxy *proxy, const recede_plane *plane);

#endif
