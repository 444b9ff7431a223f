/* picture.h - what a procedure works on, read once from the host, and its result, in memory.
 *
 * The host reads its buffers into it, the core runs on it, the host writes the result back: the
 * image is touched once, at the end. */
#ifndef RP_PICTURE_H
#define RP_PICTURE_H

#include "arguments.h"
#include "pixels.h"
#include "worker.h"

typedef struct {
  GeglRectangle area;     /* what was read, in the drawable's coordinates */
  int offset_x, offset_y; /* of the drawable in the image */
  rp_pixels image, mask, source, hard_mask, result;
  GeglRectangle box;  /* where the mask is above zero, within area */
  recede_plane plane; /* of area: the one that result was made with */
} rp_picture;

typedef enum {
  RP_READ_OK,
  RP_READ_NO_MEMORY,
  RP_READ_OUTSIDE /* nothing of the selection lies in the area */
} rp_read_status;

/* Reads area of a drawable and the selection (in image coordinates) over it; selection NULL: there
 * is none, the mask stays empty. */
rp_read_status rp_picture_read(rp_picture *picture, GeglBuffer *drawable, GeglBuffer *selection,
                               const GeglRectangle *area, int offset_x, int offset_y);
/* The light parts of another drawable, whose offsets are given, are what may be copied from. */
gboolean rp_picture_read_source(rp_picture *picture, GeglBuffer *buffer, int offset_x,
                                int offset_y);
/* Whether the mask is what selection has where area lies now. */
gboolean rp_picture_is_masked_by(const rp_picture *picture, GeglBuffer *selection, int offset_x,
                                 int offset_y);
void rp_picture_clear(rp_picture *picture);

/* Make room for the result and fill the request. FALSE: no memory.
 * blend: the mask's values blend the fill in; else all of the mask is filled at full strength, and
 * blending is left to the alpha of a new layer. */
gboolean rp_picture_request_fill(rp_picture *picture, const recede_params *params, gboolean blend,
                                 rp_request *request);
/* The area is the exemplar, the mask its source. */
gboolean rp_picture_request_synthesize(rp_picture *picture, const recede_params *params, int width,
                                       int height, rp_request *request);

#endif
