/* GIMP 3: reading and writing drawables. */
#include "host.h"

#include "../common/intl.h"

gboolean rp_host_is_there(const rp_host *host) {
  return gimp_image_is_valid(host->image) && gimp_item_is_valid(GIMP_ITEM(host->drawable));
}

/* A group's lock holds for all that lies in it, a layer's for its mask. */
static gboolean is_locked(GimpItem *item) {
  if (gimp_item_is_layer_mask(item)) item = GIMP_ITEM(gimp_layer_from_mask(GIMP_LAYER_MASK(item)));
  for (; item; item = gimp_item_get_parent(item))
    if (gimp_item_get_lock_content(item)) return TRUE;
  return FALSE;
}

/* Filters that are not merged change what a layer shows, not its pixels. */
static gboolean is_filtered(GimpDrawable *drawable) {
  GimpDrawableFilter **filters = gimp_drawable_get_filters(drawable);
  gboolean filtered = FALSE;
  for (int i = 0; filters && filters[i]; i++)
    filtered = filtered || gimp_drawable_filter_get_visible(filters[i]);
  g_free(filters);
  return filtered;
}

rp_target rp_host_target(const rp_host *host) {
  GimpItem *item = GIMP_ITEM(host->drawable);
  gboolean is_layer = gimp_item_is_layer(item);
  return (rp_target){.elsewhere = gimp_item_get_image(item) != host->image,
                     .group = gimp_item_is_group_layer(item),
                     .indexed = gimp_drawable_is_indexed(host->drawable),
                     .locked = is_locked(item),
                     .filtered = is_filtered(host->drawable),
                     .text = gimp_item_is_text_layer(item),
                     .floating = is_layer && gimp_layer_is_floating_sel(GIMP_LAYER(item)),
                     .is_layer = is_layer};
}

gboolean rp_host_has_selection(const rp_host *host) {
  return !gimp_selection_is_empty(host->image);
}

rp_drawable rp_host_open(const rp_host *host, rp_procedure procedure) {
  rp_drawable drawable = {.buffer = gimp_drawable_get_buffer(host->drawable)};
  GeglRectangle *area = &drawable.area;
  *area = *gegl_buffer_get_extent(drawable.buffer);
  if (procedure == RP_SYNTHESIZE)
    gimp_drawable_mask_intersect(host->drawable, &area->x, &area->y, &area->width, &area->height);
  gimp_drawable_get_offsets(host->drawable, &drawable.offset_x, &drawable.offset_y);
  return drawable;
}

GeglBuffer *rp_host_open_selection(const rp_host *host) {
  if (!rp_host_has_selection(host)) return NULL;
  return gimp_drawable_get_buffer(GIMP_DRAWABLE(gimp_image_get_selection(host->image)));
}

gboolean rp_host_open_other(const rp_host *host, int id, rp_drawable *drawable) {
  GimpDrawable *other = gimp_drawable_get_by_id(id);
  if (!other || gimp_item_get_image(GIMP_ITEM(other)) != host->image) return FALSE;
  *drawable = (rp_drawable){.buffer = gimp_drawable_get_buffer(other)};
  gimp_drawable_get_offsets(other, &drawable->offset_x, &drawable->offset_y);
  return TRUE;
}

/* GIMP tells of alpha in RGB images only; in gray ones it is taken to be on. */
unsigned rp_host_components(const rp_host *host) {
  static const GimpChannelType rgb[] = {GIMP_CHANNEL_RED, GIMP_CHANNEL_GREEN, GIMP_CHANNEL_BLUE,
                                        GIMP_CHANNEL_ALPHA},
                               gray[] = {GIMP_CHANNEL_GRAY};
  unsigned off = 0;
  if (!GIMP_IS_LAYER(host->drawable)) return RP_ALL_COMPONENTS;
  gboolean is_gray = gimp_drawable_is_gray(host->drawable);
  for (int i = 0; i < (is_gray ? 1 : 4); i++)
    if (!gimp_image_get_component_active(host->image, (is_gray ? gray : rgb)[i])) off |= 1u << i;
  if (gimp_layer_get_lock_alpha(GIMP_LAYER(host->drawable))) off |= is_gray ? 1u << 1 : 1u << 3;
  return RP_ALL_COMPONENTS & ~off;
}

GeglBuffer *rp_host_open_shadow(const rp_host *host) {
  return gimp_drawable_get_shadow_buffer(host->drawable);
}

gboolean rp_host_merge_shadow(const rp_host *host) {
  return gimp_drawable_merge_shadow(host->drawable, TRUE);
}

void rp_host_select_nothing(rp_host *host) {
  gimp_image_undo_group_start(host->image);
  host->selected = rp_host_has_selection(host)
                       ? gimp_channel_copy(GIMP_CHANNEL(gimp_image_get_selection(host->image)))
                       : NULL;
  gimp_selection_none(host->image);
}

/* The copy is in no image, so that nothing shows in the Channels dialog: combining is what takes
 * one that is not. */
void rp_host_select_again(rp_host *host) {
  if (host->selected) {
    gimp_channel_combine_masks(GIMP_CHANNEL(gimp_image_get_selection(host->image)), host->selected,
                               GIMP_CHANNEL_OP_ADD, 0, 0);
    gimp_item_delete(GIMP_ITEM(host->selected));
  }
  gimp_image_undo_group_end(host->image);
}

void rp_host_updated(const rp_host *host, const GeglRectangle *box) {
  gimp_drawable_update(host->drawable, box->x, box->y, box->width, box->height);
}

static GimpImageType type_with_alpha(GimpDrawable *drawable) {
  return gimp_drawable_is_gray(drawable) ? GIMP_GRAYA_IMAGE : GIMP_RGBA_IMAGE;
}

gboolean rp_host_write_new_layer(rp_host *host, const rp_picture *picture) {
  const GeglRectangle *box = &picture->box;
  gint x, y;
  GimpLayer *layer = gimp_layer_new(host->image, _("Perspective Fill"), box->width, box->height,
                                    type_with_alpha(host->drawable), 100, GIMP_LAYER_MODE_NORMAL);
  if (!layer) return FALSE;
  GeglBuffer *buffer = gimp_drawable_get_buffer(GIMP_DRAWABLE(layer));
  rp_pixels_write_layer(buffer, &picture->result, &picture->mask.view, &picture->plane, box);
  g_object_unref(buffer);
  gimp_drawable_get_offsets(host->drawable, &x, &y);
  gimp_layer_set_offsets(layer, x + box->x, y + box->y);
  GimpItem *below = GIMP_ITEM(host->drawable), *parent = gimp_item_get_parent(below);
  return gimp_image_insert_layer(host->image, layer, parent ? GIMP_LAYER(parent) : NULL,
                                 gimp_image_get_item_position(host->image, below));
}

static void copy_properties(GimpImage *from, GimpImage *to) {
  gdouble x, y;
  GimpColorProfile *profile = gimp_image_get_color_profile(from);
  if (profile) {
    gimp_image_set_color_profile(to, profile);
    g_object_unref(profile);
  }
  gimp_image_get_resolution(from, &x, &y);
  gimp_image_set_resolution(to, x, y);
  gimp_image_set_unit(to, gimp_image_get_unit(from));
}

gboolean rp_host_write_new_image(rp_host *host, const rp_picture *picture) {
  int width = picture->result.view.width, height = picture->result.view.height;
  GimpImageBaseType base = gimp_drawable_is_gray(host->drawable) ? GIMP_GRAY : GIMP_RGB;
  GimpImageType type = gimp_drawable_is_gray(host->drawable) ? GIMP_GRAY_IMAGE : GIMP_RGB_IMAGE;
  if (picture->result.view.channels % 2 == 0) type = type_with_alpha(host->drawable);
  host->new_image =
      gimp_image_new_with_precision(width, height, base, gimp_image_get_precision(host->image));
  if (!host->new_image) return FALSE;
  gimp_image_undo_disable(host->new_image);
  copy_properties(host->image, host->new_image);
  GimpLayer *layer = gimp_layer_new(host->new_image, _("Perspective Texture"), width, height, type,
                                    100, GIMP_LAYER_MODE_NORMAL);
  gimp_image_insert_layer(host->new_image, layer, NULL, 0);
  GeglBuffer *buffer = gimp_drawable_get_buffer(GIMP_DRAWABLE(layer));
  rp_pixels_write_all(buffer, &picture->result);
  g_object_unref(buffer);
  gimp_drawable_update(GIMP_DRAWABLE(layer), 0, 0, width, height);
  gimp_image_undo_enable(host->new_image);
  return TRUE;
}

int rp_host_threads(void) { return gimp_get_num_processors(); }

void rp_host_progress(const char *title, const char *text, double fraction) {
  static gboolean begun;
  if (!begun) gimp_progress_init(title);
  begun = TRUE;
  gimp_progress_set_text(text);
  gimp_progress_update(fraction);
}

void rp_host_message(const char *text) { gimp_message(text); }
