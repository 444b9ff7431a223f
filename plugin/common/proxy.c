/* The picture at preview size. */
#include "proxy.h"

#include <math.h>
#include <string.h>

/* The picture's pixels that proxy pixel i stands for: [first, next). */
static int first(const rp_proxy *proxy, int i, int limit) {
  int pixel = (int)(i * proxy->shrink);
  return MIN(pixel, limit - 1);
}
static int next(const rp_proxy *proxy, int i, int limit) {
  int pixel = (int)((i + 1) * proxy->shrink);
  return CLAMP(pixel, first(proxy, i, limit) + 1, limit);
}

static void add_row(const rp_proxy *proxy, const guchar *row, int width, guint32 *sums) {
  for (int x = 0; x < proxy->width; x++) {
    int x1 = next(proxy, x, width);
    for (int from = first(proxy, x, width); from < x1; from++) {
      guint32 alpha = row[4 * from + 3];
      for (int k = 0; k < 3; k++) sums[5 * x + k] += row[4 * from + k] * alpha;
      sums[5 * x + 3] += alpha;
      sums[5 * x + 4]++;
    }
  }
}

static void write_row(const rp_proxy *proxy, const guint32 *sums, guchar *out) {
  for (int x = 0; x < proxy->width; x++) {
    guint32 alpha = sums[5 * x + 3], count = sums[5 * x + 4];
    for (int k = 0; k < 3; k++)
      out[4 * x + k] = alpha ? (guchar)((sums[5 * x + k] + alpha / 2) / alpha) : 0;
    out[4 * x + 3] = (guchar)(alpha / count);
  }
}

static void shrink_picture(const rp_picture *picture, rp_proxy *proxy) {
  const recede_view *image = &picture->image.view;
  const Babl *fish = babl_fish(picture->image.format, babl_format("R'G'B'A u8"));
  guchar *row = g_malloc_n((gsize)image->width, 4);
  guint32 *sums = g_malloc_n((gsize)proxy->width, 5 * sizeof *sums);
  for (int y = 0; y < proxy->height; y++) {
    memset(sums, 0, (gsize)proxy->width * 5 * sizeof *sums);
    int y1 = next(proxy, y, image->height);
    for (int from = first(proxy, y, image->height); from < y1; from++) {
      babl_process(fish, (guchar *)image->data + (gsize)from * image->stride_bytes, row,
                   image->width);
      add_row(proxy, row, image->width, sums);
    }
    write_row(proxy, sums, proxy->rgba + (gsize)y * (gsize)proxy->width * 4);
  }
  g_free(sums);
  g_free(row);
}

static float largest_in(const recede_view *mask, const rp_proxy *proxy, int x, int y) {
  float largest = 0;
  for (int j = first(proxy, y, mask->height); j < next(proxy, y, mask->height); j++)
    for (int i = first(proxy, x, mask->width); i < next(proxy, x, mask->width); i++)
      largest = MAX(largest, rp_mask_value(mask, i, j));
  return largest;
}

static void shrink_mask(const recede_view *mask, const rp_proxy *proxy, float above, guchar *out) {
  for (int y = 0; y < proxy->height; y++)
    for (int x = 0; x < proxy->width; x++)
      out[y * proxy->width + x] = mask->data && largest_in(mask, proxy, x, y) > above ? 255 : 0;
}

static gboolean make_room(int width, int height, int longest, rp_proxy *proxy) {
  proxy->shrink = MAX(1., (double)MAX(width, height) / longest);
  proxy->width = MAX(1, (int)lround(width / proxy->shrink));
  proxy->height = MAX(1, (int)lround(height / proxy->shrink));
  gsize pixels = (gsize)proxy->width * (gsize)proxy->height;
  proxy->rgba = g_try_malloc0(pixels * 4);
  proxy->mask = g_try_malloc0(pixels);
  proxy->ends = g_try_new(int, 2 * (gsize)proxy->height);
  proxy->source = NULL;
  if (proxy->rgba && proxy->mask && proxy->ends) return TRUE;
  rp_proxy_clear(proxy);
  return FALSE;
}

gboolean rp_proxy_new_blank(int width, int height, int longest, rp_proxy *proxy) {
  if (!make_room(width, height, longest, proxy)) return FALSE;
  rp_proxy_find_ends(proxy);
  return TRUE;
}

gboolean rp_proxy_new(const rp_picture *picture, int longest, rp_proxy *proxy) {
  if (!make_room(picture->area.width, picture->area.height, longest, proxy)) return FALSE;
  shrink_picture(picture, proxy);
  shrink_mask(&picture->mask.view, proxy, 0, proxy->mask);
  rp_proxy_find_ends(proxy);
  return TRUE;
}

void rp_proxy_find_ends(rp_proxy *proxy) {
  for (int y = 0; y < proxy->height; y++) {
    int *ends = proxy->ends + 2 * y;
    ends[0] = ends[1] = -1;
    for (int x = 0; x < proxy->width; x++) {
      int at = y * proxy->width + x;
      if (proxy->mask[at] || (proxy->source && !proxy->source[at]) || !proxy->rgba[4 * at + 3])
        continue;
      if (ends[0] < 0) ends[0] = x;
      ends[1] = x;
    }
  }
}

void rp_proxy_set_source(rp_proxy *proxy, const rp_picture *picture) {
  g_clear_pointer(&proxy->source, g_free);
  if (picture->source.view.data) {
    proxy->source = g_malloc((gsize)proxy->width * (gsize)proxy->height);
    shrink_mask(&picture->source.view, proxy, .5f, proxy->source);
  }
  rp_proxy_find_ends(proxy);
}

void rp_proxy_clear(rp_proxy *proxy) {
  g_clear_pointer(&proxy->rgba, g_free);
  g_clear_pointer(&proxy->mask, g_free);
  g_clear_pointer(&proxy->source, g_free);
  g_clear_pointer(&proxy->ends, g_free);
}

void rp_proxy_centre(const rp_proxy *proxy, double *x, double *y) {
  double sum_x = 0, sum_y = 0, count = 0;
  for (int j = 0; j < proxy->height; j++)
    for (int i = 0; i < proxy->width; i++)
      if (proxy->mask[j * proxy->width + i]) sum_x += i, sum_y += j, count++;
  *x = count > 0 ? sum_x / count : (proxy->width - 1) / 2.;
  *y = count > 0 ? sum_y / count : (proxy->height - 1) / 2.;
}
