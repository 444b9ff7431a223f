/* Between the host's drawables and a picture. */
#include "exchange.h"

#include "intl.h"

const char *rp_read(const rp_host *host, rp_procedure procedure, rp_picture *picture) {
  rp_read_status status = RP_READ_OUTSIDE;
  rp_drawable drawable = rp_host_open(host, procedure);
  GeglBuffer *selection = rp_host_open_selection(host);
  *picture = (rp_picture){.area = drawable.area};
  if (drawable.area.width > 0 && drawable.area.height > 0)
    status = rp_picture_read(picture, drawable.buffer, selection, &drawable.area, drawable.offset_x,
                             drawable.offset_y);
  g_object_unref(drawable.buffer);
  g_clear_object(&selection);
  if (status == RP_READ_OK) return NULL;
  rp_picture_clear(picture);
  return status == RP_READ_OUTSIDE ? rp_selection_outside() : rp_no_memory();
}

static gboolean selection_is_mask(const rp_host *host, const rp_drawable *drawable,
                                  const rp_picture *picture) {
  GeglBuffer *selection = rp_host_open_selection(host);
  gboolean same =
      rp_picture_is_masked_by(picture, selection, drawable->offset_x, drawable->offset_y);
  g_clear_object(&selection);
  return same;
}

gboolean rp_is_as_read(const rp_host *host, rp_procedure procedure, const rp_picture *picture) {
  rp_drawable now = rp_host_open(host, procedure);
  gboolean same = gegl_rectangle_equal(&now.area, &picture->area) &&
                  now.offset_x == picture->offset_x && now.offset_y == picture->offset_y &&
                  selection_is_mask(host, &now, picture) &&
                  rp_pixels_are(&picture->image, now.buffer, &now.area);
  g_object_unref(now.buffer);
  return same;
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

char *rp_misfit(const rp_host *host, const rp_picture *picture) {
  rp_drawable now = rp_host_open(host, RP_FILL);
  g_object_unref(now.buffer);
  if (gegl_rectangle_equal(&now.area, &picture->area)) return NULL;
  return g_strdup_printf(_("The layer was %d × %d px when the fill began and is %d × %d px now. "
                           "Nothing was written; start again."),
                         picture->area.width, picture->area.height, now.area.width,
                         now.area.height);
}

static void fill_shadow(const rp_host *host, GeglBuffer *drawable, GeglBuffer *exact,
                        const GeglRectangle *box) {
  GeglBuffer *shadow = rp_host_open_shadow(host);
  gegl_buffer_copy(drawable, NULL, GEGL_ABYSS_NONE, shadow, NULL);
  gegl_buffer_copy(exact, box, GEGL_ABYSS_NONE, shadow, box);
  g_object_unref(shadow);
}

static void write_exact(const rp_host *host, GeglBuffer *exact, const GeglRectangle *box) {
  rp_drawable drawable = rp_host_open(host, RP_FILL);
  gegl_buffer_copy(exact, box, GEGL_ABYSS_NONE, drawable.buffer, box);
  g_object_unref(drawable.buffer);
  rp_host_updated(host, box);
}

/* The shadow's merge is what GIMP can undo; it works in floats, within the selection's bounds, and
 * blends by it. The exact bytes are then laid over it. When the selection is not the mask any more,
 * nothing is selected meanwhile, and all of the drawable is merged and written. The shadow has all
 * of the drawable in any case: a selection that changes just then has it merged elsewhere. */
gboolean rp_write_in_place(rp_host *host, const rp_picture *picture) {
  rp_drawable drawable = rp_host_open(host, RP_FILL);
  gboolean selected = selection_is_mask(host, &drawable, picture);
  const GeglRectangle *box = selected ? &picture->box : &picture->area;
  GeglBuffer *exact = rp_pixels_replaced(drawable.buffer, &picture->result, &picture->mask.view,
                                         box, rp_host_components(host));
  if (!selected) rp_host_select_nothing(host);
  fill_shadow(host, drawable.buffer, exact, box);
  g_object_unref(drawable.buffer);
  gboolean merged = rp_host_merge_shadow(host);
  if (merged) write_exact(host, exact, box);
  g_object_unref(exact);
  if (!selected) rp_host_select_again(host);
  return merged;
}
