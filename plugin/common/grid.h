/* grid.h - a plane drawn as one sees it: squares lying on it, its horizon, where it recedes to. */
#ifndef RP_GRID_H
#define RP_GRID_H

#include <cairo.h>
#include <glib.h>

#include "recede.h"

/* Around the image point (x, y). zoom: widget px per image px, for line widths. */
void rp_grid_draw(const recede_plane *plane, cairo_t *cairo, double x, double y, double zoom,
                  gboolean with_squares);
/* The horizon's ends where it leaves the image and a margin around it, left one first. FALSE: it is
 * not near the image. */
gboolean rp_grid_horizon(const recede_plane *plane, double ends[4]);

#endif
