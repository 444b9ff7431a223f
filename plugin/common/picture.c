/* What a procedure works on, in memory. */
#include "picture.h"

#include <string.h>

static gboolean read_mask(GeglBuffer *selection, const GeglRectangle *area, int offset_x,
                          int offset_y, rp_pixels *mask) {
  GeglRectangle in_image = *area;
  in_image.x += offset_x;
  in_image.y += offset_y;
  return rp_pixels_read_mask(selection, &in_image, mask);
}

rp_read_status rp_picture_read(rp_picture *picture, GeglBuffer *drawable, GeglBuffer *selection,
                               const GeglRectangle *area, int offset_x, int offset_y) {
  memset(picture, 0, sizeof *picture);
  picture->area = *area;
  picture->offset_x = offset_x;
  picture->offset_y = offset_y;
  picture->box = *GEGL_RECTANGLE(0, 0, area->width, area->height);
  if (selection) {
    if (!read_mask(selection, area, offset_x, offset_y, &picture->mask)) return RP_READ_NO_MEMORY;
    if (!rp_mask_bounds(&picture->mask.view, &picture->box)) return RP_READ_OUTSIDE;
  }
  return rp_pixels_read(drawable, area, &picture->image) ? RP_READ_OK : RP_READ_NO_MEMORY;
}

gboolean rp_picture_read_source(rp_picture *picture, GeglBuffer *buffer, int offset_x,
                                int offset_y) {
  GeglRectangle there = picture->area;
  there.x += picture->offset_x - offset_x;
  there.y += picture->offset_y - offset_y;
  rp_pixels_clear(&picture->source);
  return rp_pixels_read_source(buffer, &there, &picture->source);
}

gboolean rp_picture_is_masked_by(const rp_picture *picture, GeglBuffer *selection, int offset_x,
                                 int offset_y) {
  const recede_view *mask = &picture->mask.view;
  rp_pixels now;
  if (!selection || !mask->data) return !selection && !mask->data;
  gboolean same =
      read_mask(selection, &picture->area, offset_x, offset_y, &now) &&
      now.view.type == mask->type &&
      memcmp(now.view.data, mask->data, (gsize)mask->height * (gsize)mask->stride_bytes) == 0;
  rp_pixels_clear(&now);
  return same;
}

void rp_picture_clear(rp_picture *picture) {
  rp_pixels_clear(&picture->image);
  rp_pixels_clear(&picture->mask);
  rp_pixels_clear(&picture->source);
  rp_pixels_clear(&picture->hard_mask);
  rp_pixels_clear(&picture->result);
}

gboolean rp_picture_request_fill(rp_picture *picture, const recede_params *params, gboolean blend,
                                 rp_request *request) {
  rp_pixels_clear(&picture->result);
  rp_pixels_clear(&picture->hard_mask);
  if (!rp_pixels_like(&picture->image, picture->area.width, picture->area.height, &picture->result))
    return FALSE;
  if (!blend && !rp_mask_harden(&picture->mask.view, &picture->hard_mask)) return FALSE;
  *request = (rp_request){.run = RP_RUN_FILL,
                          .params = *params,
                          .image = picture->image.view,
                          .mask = blend ? picture->mask.view : picture->hard_mask.view,
                          .source = picture->source.view,
                          .result = picture->result.view};
  return TRUE;
}

gboolean rp_picture_request_synthesize(rp_picture *picture, const recede_params *params, int width,
                                       int height, rp_request *request) {
  rp_pixels_clear(&picture->result);
  if (!rp_pixels_like(&picture->image, width, height, &picture->result)) return FALSE;
  *request = (rp_request){.run = RP_RUN_SYNTHESIZE,
                          .params = *params,
                          .image = picture->image.view,
                          .source = picture->mask.view,
                          .result = picture->result.view};
  return TRUE;
}
