/* Between the host's drawables and a picture. */
#include "exchange.h"

#include "intl.h"

rp_read_status rp_read(const rp_host *host, rp_procedure procedure, rp_picture *picture) {
  rp_read_status status = RP_READ_OUTSIDE;
  rp_drawable drawable = rp_host_open(host, procedure);
  GeglBuffer *selection = rp_host_open_selection(host);
  if (drawable.area.width > 0 && drawable.area.height > 0)
    status = rp_picture_read(picture, drawable.buffer, selection, &drawable.area, drawable.offset_x,
                             drawable.offset_y);
  g_object_unref(drawable.buffer);
  g_clear_object(&selection);
  return status;
}

gboolean rp_read_source(const rp_host *host, int id, rp_picture *picture, char **message) {
  rp_drawable other;
  if (!rp_host_open_other(host, id, &other)) {
    *message = g_strdup(_("source: there is no such channel or layer in this image."));
    return FALSE;
  }
  gboolean read = rp_picture_read_source(picture, other.buffer, other.offset_x, other.offset_y);
  g_object_unref(other.buffer);
  if (!read) *message = g_strdup(rp_no_memory());
  return read;
}

/* The shadow's merge is what GIMP can undo; it works in floats, and blends by the selection. The
 * exact bytes are then laid over it. */
void rp_write_in_place(const rp_host *host, const rp_picture *picture) {
  const GeglRectangle *box = &picture->box;
  if (rp_host_alpha_locked(host)) rp_pixels_keep_alpha(&picture->image.view, &picture->result.view);
  GeglBuffer *drawable = rp_host_open(host, RP_FILL).buffer;
  GeglBuffer *exact = rp_pixels_replaced(drawable, &picture->result, &picture->mask.view, box);
  g_object_unref(drawable);
  GeglBuffer *shadow = rp_host_open_shadow(host);
  rp_pixels_write(shadow, &picture->result, &picture->mask.view, box);
  g_object_unref(shadow);
  rp_host_merge_shadow(host);
  drawable = rp_host_open(host, RP_FILL).buffer;
  gegl_buffer_copy(exact, box, GEGL_ABYSS_NONE, drawable, box);
  g_object_unref(drawable);
  g_object_unref(exact);
  rp_host_updated(host, box);
}
