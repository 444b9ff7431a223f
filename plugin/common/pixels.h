/* pixels.h - between GIMP's buffers (GEGL) and the core's views.
 *
 * What is stored as 8-bit or 16-bit integers or as floats, encoded as seen, goes to the core as it
 * is; everything else (linear light, 32-bit integers, half, double) goes as float, encoded as seen
 * in the drawable's own colour space. Bytes that are not to change are never converted. */
#ifndef RP_PIXELS_H
#define RP_PIXELS_H

#include <gegl.h>

#include "recede.h"

typedef struct {
  recede_view view;   /* .data NULL: there is none */
  const Babl *format; /* of the view's pixels */
} rp_pixels;

/* A drawable's pixels within area. FALSE: no memory. Free with rp_pixels_clear(). */
gboolean rp_pixels_read(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *pixels);
/* Whether rp_pixels_read() would read the same again. */
gboolean rp_pixels_are(const rp_pixels *pixels, GeglBuffer *buffer, const GeglRectangle *area);
/* A selection's or a channel's values within area, zero outside the buffer. */
gboolean rp_pixels_read_mask(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *mask);
/* How light a drawable is, times its alpha: what may be copied from. */
gboolean rp_pixels_read_source(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *source);
gboolean rp_pixels_like(const rp_pixels *model, int width, int height, rp_pixels *pixels);
void rp_pixels_clear(rp_pixels *pixels);

/* Where mask is above zero; FALSE when nowhere. */
gboolean rp_mask_bounds(const recede_view *mask, GeglRectangle *bounds);
/* A copy in which every value above zero is full. FALSE: no memory. */
gboolean rp_mask_harden(const recede_view *mask, rp_pixels *hard);
float rp_mask_value(const recede_view *mask, int x, int y);
#define RP_ALL_COMPONENTS (~0u)

/* box of buffer in a buffer of its own, with result's pixels under the mask, and of them those
 * components that have their bit in components; every other byte is as it was. */
GeglBuffer *rp_pixels_replaced(GeglBuffer *buffer, const rp_pixels *result, const recede_view *mask,
                               const GeglRectangle *box, unsigned components);
/* Writes them into the buffer of a layer that is as large as box, with the mask as alpha. What lies
 * beyond plane's horizon was not filled: nothing of it. */
void rp_pixels_write_layer(GeglBuffer *buffer, const rp_pixels *result, const recede_view *mask,
                           const recede_plane *plane, const GeglRectangle *box);
/* All of result into a buffer of its size. */
void rp_pixels_write_all(GeglBuffer *buffer, const rp_pixels *result);

#endif
