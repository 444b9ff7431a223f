/* The preview's bitmaps. */
#include "surface.h"

#include <math.h>

/* A source of less than this share of the resolution needed shows: the core's own bound. */
#define MAGNIFIED_BELOW .8
#define DASH_PX 4
#define SHADE_ALPHA .55
#define MAGNIFIED_COLOUR 1, .1, .1, .6

typedef struct {
  guint32 *pixels;
  int stride;
  cairo_surface_t *surface;
} canvas;

static canvas start(int width, int height) {
  canvas c = {.surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height)};
  cairo_surface_flush(c.surface);
  c.pixels = (guint32 *)(void *)cairo_image_surface_get_data(c.surface);
  c.stride = cairo_image_surface_get_stride(c.surface) / 4;
  return c;
}

static cairo_surface_t *finish(canvas *c) {
  cairo_surface_mark_dirty(c->surface);
  return c->surface;
}

static guint32 argb(double red, double green, double blue, double alpha) {
  guint32 a = (guint32)lround(alpha * 255), r = (guint32)lround(red * alpha * 255),
          g = (guint32)lround(green * alpha * 255), b = (guint32)lround(blue * alpha * 255);
  return a << 24 | r << 16 | g << 8 | b;
}

cairo_surface_t *rp_surface_of_pixels(const guchar *rgba, int width, int height) {
  canvas c = start(width, height);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++, rgba += 4)
      c.pixels[y * c.stride + x] =
          argb(rgba[0] / 255., rgba[1] / 255., rgba[2] / 255., rgba[3] / 255.);
  return finish(&c);
}

static gboolean in_mask(const rp_proxy *proxy, int x, int y) {
  return x >= 0 && y >= 0 && x < proxy->width && y < proxy->height &&
         proxy->mask[y * proxy->width + x];
}

cairo_surface_t *rp_surface_of_outline(const rp_proxy *proxy) {
  canvas c = start(proxy->width, proxy->height);
  for (int y = 0; y < proxy->height; y++)
    for (int x = 0; x < proxy->width; x++) {
      if (!in_mask(proxy, x, y)) continue;
      if (in_mask(proxy, x - 1, y) && in_mask(proxy, x + 1, y) && in_mask(proxy, x, y - 1) &&
          in_mask(proxy, x, y + 1))
        continue;
      double shade = (x + y) / DASH_PX % 2;
      c.pixels[y * c.stride + x] = argb(shade, shade, shade, 1);
    }
  return finish(&c);
}

/* The nearest that may be copied: the largest w outside the mask. */
static double largest_source_w(const rp_proxy *proxy, const recede_plane *plane) {
  double largest = 0;
  for (int y = 0; y < proxy->height; y++)
    for (int x = 0; x < proxy->width; x++) {
      int at = y * proxy->width + x;
      if (proxy->mask[at] || (proxy->source && !proxy->source[at]) || !proxy->rgba[4 * at + 3])
        continue;
      largest = fmax(largest, recede_plane_w(plane, x, y));
    }
  return largest;
}

static guint32 shade_of(double scale) {
  if (!(scale > 0)) return argb(.5, .5, .5, SHADE_ALPHA);
  double octaves = fmax(-1, fmin(1, log2(scale) / 2));
  double alpha = SHADE_ALPHA * sqrt(fabs(octaves));
  return octaves < 0 ? argb(.1, .35, 1, alpha) : argb(1, .6, .05, alpha);
}

static cairo_surface_t *shaded(const rp_proxy *proxy, const recede_plane *plane, double w0) {
  canvas c = start(proxy->width, proxy->height);
  double limit = largest_source_w(proxy, plane);
  for (int y = 0; y < proxy->height; y++)
    for (int x = 0; x < proxy->width; x++) {
      double w = recede_plane_w(plane, x, y);
      if (in_mask(proxy, x, y) && w * MAGNIFIED_BELOW > limit)
        c.pixels[y * c.stride + x] = argb(MAGNIFIED_COLOUR);
      else if (w0 > 0)
        c.pixels[y * c.stride + x] = shade_of(w / w0);
    }
  return finish(&c);
}

cairo_surface_t *rp_surface_of_scale(const rp_proxy *proxy, const recede_plane *plane, double x,
                                     double y) {
  double w0 = recede_plane_w(plane, x, y);
  return shaded(proxy, plane, w0 > 0 ? w0 : 1e-3);
}

cairo_surface_t *rp_surface_of_magnified(const rp_proxy *proxy, const recede_plane *plane) {
  return shaded(proxy, plane, 0);
}
