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

/* The nearest that may be copied: the largest w outside the mask. w is linear in x, so that the
 * largest of a row is at one of its ends. */
static double largest_source_w(const rp_proxy *proxy, const recede_plane *plane) {
  double largest = 0;
  for (int y = 0; y < proxy->height; y++) {
    const int *ends = proxy->ends + 2 * y;
    if (ends[0] < 0) continue;
    largest = fmax(largest, recede_plane_w(plane, ends[0], y));
    largest = fmax(largest, recede_plane_w(plane, ends[1], y));
  }
  return largest;
}

/* Scales from 0 to LARGEST, beyond which the shade does not change, in steps no eye can tell. */
#define LARGEST 4
#define STEPS 256

static void make_shades(guint32 shades[LARGEST * STEPS + 1]) {
  for (int i = 0; i <= LARGEST * STEPS; i++) {
    double octaves = i ? fmax(-1, log2((double)i / STEPS) / 2) : -1;
    double alpha = SHADE_ALPHA * sqrt(fabs(octaves));
    shades[i] = octaves < 0 ? argb(.1, .35, 1, alpha) : argb(1, .6, .05, alpha);
  }
}

typedef struct {
  const rp_proxy *proxy;
  double limit; /* what is nearer than this must be magnified */
  guint32 magnified;
} judge;

static judge judge_of(const rp_proxy *proxy, const recede_plane *plane) {
  return (judge){proxy, largest_source_w(proxy, plane) / MAGNIFIED_BELOW, argb(MAGNIFIED_COLOUR)};
}

static gboolean must_magnify(const judge *j, int x, int y, double w) {
  return w > j->limit && j->proxy->mask[y * j->proxy->width + x];
}

cairo_surface_t *rp_surface_of_scale(const rp_proxy *proxy, const recede_plane *plane, double x,
                                     double y) {
  guint32 shades[LARGEST * STEPS + 1], beyond = argb(.5, .5, .5, SHADE_ALPHA);
  double w0 = recede_plane_w(plane, x, y);
  judge j = judge_of(proxy, plane);
  canvas c = start(proxy->width, proxy->height);
  if (!(w0 > 0)) w0 = 1e-3;
  make_shades(shades);
  for (int row = 0; row < proxy->height; row++) {
    double first = recede_plane_w(plane, 0, row), step = recede_plane_w(plane, 1, row) - first;
    for (int i = 0; i < proxy->width; i++) {
      double w = first + i * step, scale = fmin(w / w0, LARGEST);
      guint32 shade = scale > 0 ? shades[(int)(scale * STEPS)] : beyond;
      c.pixels[row * c.stride + i] = must_magnify(&j, i, row, w) ? j.magnified : shade;
    }
  }
  return finish(&c);
}

cairo_surface_t *rp_surface_of_magnified(const rp_proxy *proxy, const recede_plane *plane) {
  judge j = judge_of(proxy, plane);
  canvas c = {.surface = NULL};
  for (int y = 0; y < proxy->height; y++) {
    double first = recede_plane_w(plane, 0, y), step = recede_plane_w(plane, 1, y) - first;
    for (int x = 0; x < proxy->width; x++) {
      if (!must_magnify(&j, x, y, first + x * step)) continue;
      if (!c.surface) c = start(proxy->width, proxy->height);
      c.pixels[y * c.stride + x] = j.magnified;
    }
  }
  return c.surface ? finish(&c) : NULL;
}
