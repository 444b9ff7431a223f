/* Between GEGL's buffers and the core's views. */
#include "pixels.h"

#include <math.h>
#include <string.h>

static gsize type_bytes(recede_type type) {
  return type == RECEDE_U8 ? 1 : type == RECEDE_FLOAT ? 4 : 2;
}

static gboolean is_type(const Babl *format, const char *name) {
  return strcmp(babl_get_name(babl_format_get_type(format, 0)), name) == 0;
}

static gboolean is_encoded_as_seen(const Babl *format) {
  return (babl_get_model_flags(babl_format_get_model(format)) & BABL_MODEL_FLAG_LINEAR) == 0;
}

/* The format the core gets for pixels stored as native. */
static const Babl *format_for_core(const Babl *native, recede_type *type) {
  static const char *const names[] = {NULL, "Y' float", "Y'A float", "R'G'B' float",
                                      "R'G'B'A float"};
  if (is_encoded_as_seen(native)) {
    *type = RECEDE_U8;
    if (is_type(native, "u8")) return native;
    *type = RECEDE_U16;
    if (is_type(native, "u16")) return native;
  }
  *type = RECEDE_FLOAT;
  if (is_encoded_as_seen(native) && is_type(native, "float")) return native;
  return babl_format_with_space(names[babl_format_get_n_components(native)],
                                babl_format_get_space(native));
}

static gboolean allocate(rp_pixels *pixels, int width, int height, int channels, recede_type type,
                         const Babl *format) {
  gsize stride = (gsize)width * (gsize)channels * type_bytes(type);
  pixels->view =
      (recede_view){g_try_malloc_n((gsize)height, stride), stride, width, height, channels, type};
  pixels->format = format;
  return pixels->view.data != NULL;
}

static gboolean read_as(GeglBuffer *buffer, const GeglRectangle *area, const Babl *format,
                        recede_type type, rp_pixels *pixels) {
  if (!allocate(pixels, area->width, area->height, babl_format_get_n_components(format), type,
                format))
    return FALSE;
  gegl_buffer_get(buffer, area, 1.0, format, pixels->view.data, (gint)pixels->view.stride_bytes,
                  GEGL_ABYSS_NONE);
  return TRUE;
}

gboolean rp_pixels_read(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *pixels) {
  recede_type type;
  const Babl *format = format_for_core(gegl_buffer_get_format(buffer), &type);
  return read_as(buffer, area, format, type, pixels);
}

#define STRIP 64 /* rows read at a time: those of GIMP's tiles */

gboolean rp_pixels_are(const rp_pixels *pixels, GeglBuffer *buffer, const GeglRectangle *area) {
  recede_type type;
  const recede_view *view = &pixels->view;
  gsize stride = view->stride_bytes;
  if (area->width != view->width || area->height != view->height ||
      format_for_core(gegl_buffer_get_format(buffer), &type) != pixels->format)
    return FALSE;
  guchar *now = g_try_malloc_n(STRIP, stride);
  gboolean same = now != NULL;
  for (int y = 0; same && y < area->height; y += STRIP) {
    int rows = MIN(STRIP, area->height - y);
    gegl_buffer_get(buffer, GEGL_RECTANGLE(area->x, area->y + y, area->width, rows), 1.0,
                    pixels->format, now, (gint)stride, GEGL_ABYSS_NONE);
    same = memcmp(now, (guchar *)view->data + (gsize)y * stride, (gsize)rows * stride) == 0;
  }
  g_free(now);
  return same;
}

/* 8-bit selections stay bytes, so that the core sees the numbers of a mask in a file. */
gboolean rp_pixels_read_mask(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *mask) {
  gboolean bytes = is_type(gegl_buffer_get_format(buffer), "u8");
  return read_as(buffer, area, babl_format(bytes ? "Y u8" : "Y float"),
                 bytes ? RECEDE_U8 : RECEDE_FLOAT, mask);
}

gboolean rp_pixels_read_source(GeglBuffer *buffer, const GeglRectangle *area, rp_pixels *source) {
  const Babl *native = gegl_buffer_get_format(buffer);
  const char *name = is_encoded_as_seen(native) ? "Y'A float" : "YA float";
  rp_pixels both;
  if (!read_as(buffer, area, babl_format_with_space(name, babl_format_get_space(native)),
               RECEDE_FLOAT, &both))
    return FALSE;
  if (!allocate(source, area->width, area->height, 1, RECEDE_FLOAT, babl_format("Y float"))) {
    rp_pixels_clear(&both);
    return FALSE;
  }
  const float *in = both.view.data;
  float *out = source->view.data;
  gsize count = (gsize)area->width * (gsize)area->height;
  for (gsize i = 0; i < count; i++) out[i] = in[2 * i] * in[2 * i + 1];
  rp_pixels_clear(&both);
  return TRUE;
}

gboolean rp_pixels_like(const rp_pixels *model, int width, int height, rp_pixels *pixels) {
  return allocate(pixels, width, height, model->view.channels, model->view.type, model->format);
}

void rp_pixels_clear(rp_pixels *pixels) {
  g_free(pixels->view.data);
  memset(pixels, 0, sizeof *pixels);
}

static guchar *at(const recede_view *view, int x, int y) {
  return (guchar *)view->data + (gsize)y * view->stride_bytes +
         (gsize)x * (gsize)view->channels * type_bytes(view->type);
}

float rp_mask_value(const recede_view *mask, int x, int y) {
  const guchar *value = at(mask, x, y);
  float number;
  if (mask->type == RECEDE_U8) return *value / 255.f;
  memcpy(&number, value, sizeof number);
  return number;
}

gboolean rp_mask_bounds(const recede_view *mask, GeglRectangle *bounds) {
  int x0 = mask->width, x1 = -1, y0 = mask->height, y1 = -1;
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++) {
      if (!(rp_mask_value(mask, x, y) > 0)) continue;
      x0 = MIN(x0, x), x1 = MAX(x1, x);
      y0 = MIN(y0, y), y1 = y;
    }
  if (x1 < 0) return FALSE;
  *bounds = *GEGL_RECTANGLE(x0, y0, x1 - x0 + 1, y1 - y0 + 1);
  return TRUE;
}

gboolean rp_mask_harden(const recede_view *mask, rp_pixels *hard) {
  if (!allocate(hard, mask->width, mask->height, 1, RECEDE_U8, babl_format("Y u8"))) return FALSE;
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++)
      *at(&hard->view, x, y) = rp_mask_value(mask, x, y) > 0 ? 255 : 0;
  return TRUE;
}

static void replace(guchar *pixel, const guchar *by, const Babl *format, unsigned components) {
  gsize count = (gsize)babl_format_get_n_components(format);
  gsize bytes = (gsize)babl_format_get_bytes_per_pixel(format) / count;
  for (gsize i = 0; i < count; i++)
    if (components >> i & 1) memcpy(pixel + i * bytes, by + i * bytes, bytes);
}

static void write_row(GeglBuffer *buffer, const Babl *fish, const rp_pixels *result,
                      const recede_view *mask, const GeglRectangle *row, unsigned components) {
  const Babl *native = gegl_buffer_get_format(buffer);
  gsize bytes = (gsize)babl_format_get_bytes_per_pixel(native);
  guchar *old = g_malloc_n((gsize)row->width, bytes),
         *converted = g_malloc_n((gsize)row->width, bytes);
  gegl_buffer_get(buffer, row, 1.0, native, old, GEGL_AUTO_ROWSTRIDE, GEGL_ABYSS_NONE);
  babl_process(fish, at(&result->view, row->x, row->y), converted, row->width);
  for (int x = 0; x < row->width; x++)
    if (rp_mask_value(mask, row->x + x, row->y) > 0)
      replace(old + (gsize)x * bytes, converted + (gsize)x * bytes, native, components);
  gegl_buffer_set(buffer, row, 0, native, old, GEGL_AUTO_ROWSTRIDE);
  g_free(old);
  g_free(converted);
}

GeglBuffer *rp_pixels_replaced(GeglBuffer *buffer, const rp_pixels *result, const recede_view *mask,
                               const GeglRectangle *box, unsigned components) {
  const Babl *native = gegl_buffer_get_format(buffer);
  const Babl *fish = babl_fish(result->format, native);
  GeglBuffer *copy = gegl_buffer_new(box, native);
  gegl_buffer_copy(buffer, box, GEGL_ABYSS_NONE, copy, box);
  for (int y = box->y; y < box->y + box->height; y++)
    write_row(copy, fish, result, mask, GEGL_RECTANGLE(box->x, y, box->width, 1), components);
  return copy;
}

/* A filled pixel's alpha is 1. The core also leaves what is just below the horizon as it was: where
 * that is transparent, so is the layer. */
static float alpha_in_layer(const recede_view *mask, const recede_plane *plane, int x, int y,
                            float alpha) {
  return recede_plane_w(plane, x, y) > 0 ? rp_mask_value(mask, x, y) * alpha : 0;
}

void rp_pixels_write_layer(GeglBuffer *buffer, const rp_pixels *result, const recede_view *mask,
                           const recede_plane *plane, const GeglRectangle *box) {
  const Babl *space = babl_format_get_space(gegl_buffer_get_format(buffer));
  const Babl *format = babl_format_with_space("R'G'B'A float", space);
  const Babl *fish = babl_fish(result->format, format);
  float *row = g_malloc_n((gsize)box->width, 4 * sizeof *row);
  for (int y = 0; y < box->height; y++) {
    babl_process(fish, at(&result->view, box->x, box->y + y), row, box->width);
    for (int x = 0; x < box->width; x++)
      row[4 * x + 3] = alpha_in_layer(mask, plane, box->x + x, box->y + y, row[4 * x + 3]);
    gegl_buffer_set(buffer, GEGL_RECTANGLE(0, y, box->width, 1), 0, format, row,
                    GEGL_AUTO_ROWSTRIDE);
  }
  g_free(row);
}

void rp_pixels_write_all(GeglBuffer *buffer, const rp_pixels *result) {
  gegl_buffer_set(buffer, GEGL_RECTANGLE(0, 0, result->view.width, result->view.height), 0,
                  result->format, result->view.data, (gint)result->view.stride_bytes);
}
