#include "synthesis/structure/dashes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/real.h"
#include "base/spread.h"

/* A pixel stands out if it is brighter than the mean of the square around it by more than so many
 * times the median difference, grain by chance in one of thousands, and by so much of white. */
#define TIMES_MEDIAN 6.f
#define LEAST_CONTRAST .06f
/* The square reaches so far to each side, in parts of the hole's longer side, where w = 1, and in
 * proportion to w elsewhere. */
#define SQUARE_OF_HOLE .25f
#define LEAST_SQUARE_PX 4
/* What is so many times farther or nearer than the hole is not looked at. */
#define WIDEST_RATIO 6.
#define LEAST_PIXELS 6
/* Rectangles with the moments of what a dash covers: a dash of a road is 8 to 20 times as long as
 * wide, and less where it is blurred. */
#define LEAST_ELONGATION 2.5
#define SAMPLES 4096

typedef struct finder {
  const rc_image *image;
  const rc_mask *flags;
  const rc_ground *ground;
  int exponent;
  float square_px, least;
  double *sums; /* of source pixels above and left of each */
  int32_t *counts;
  float *off;
  uint8_t *taken;
  int32_t *stack;
} finder;

static double w_at(const finder *f, int x, int y) {
  double u, v, w;
  return rc_ground_place(f->ground, f->exponent, x, y, &u, &v, &w) ? w : 0;
}

static bool is_looked_at(const finder *f, int x, int y) {
  if (!(*rc_flag(f->flags, x, y) & (RC_SOURCE | RC_ALLOWED))) return false;
  double w = w_at(f, x, y);
  return w > 1 / WIDEST_RATIO && w < WIDEST_RATIO;
}

static recede_status sum_up(rc_context *context, const finder *f) {
  size_t stride = (size_t)f->image->width + 1;
  for (int y = 0; y < f->image->height; y++) {
    size_t at = ((size_t)y + 1) * stride + 1;
    double row = 0;
    int32_t count = 0;
    for (int x = 0; x < f->image->width; x++, at++) {
      if (is_looked_at(f, x, y)) row += rc_brightness_at(f->image, x, y), count++;
      f->sums[at] = f->sums[at - stride] + row;
      f->counts[at] = f->counts[at - stride] + count;
    }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

static int clamp(int v, int most) { return v < 0 ? 0 : v > most ? most : v; }

static recede_status compare(rc_context *context, const finder *f) {
  int width = f->image->width, height = f->image->height;
  size_t stride = (size_t)width + 1;
  for (int y = 0; y < height; y++) {
    for (int x = 0; x < width; x++) {
      float *off = &f->off[(size_t)y * (size_t)width + (size_t)x];
      *off = NAN;
      if (!is_looked_at(f, x, y)) continue;
      int reach = (int)((double)f->square_px * w_at(f, x, y));
      if (reach < LEAST_SQUARE_PX) reach = LEAST_SQUARE_PX;
      size_t x0 = (size_t)clamp(x - reach, width), x1 = (size_t)clamp(x + reach + 1, width);
      size_t top = (size_t)clamp(y - reach, height) * stride;
      size_t end = (size_t)clamp(y + reach + 1, height) * stride;
      double sum = f->sums[end + x1] - f->sums[end + x0] - f->sums[top + x1] + f->sums[top + x0];
      int32_t count =
          f->counts[end + x1] - f->counts[end + x0] - f->counts[top + x1] + f->counts[top + x0];
      *off = rc_brightness_at(f->image, x, y) - (float)(sum / count);
    }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

static float usual_difference(const finder *f) {
  float samples[SAMPLES];
  size_t pixels = (size_t)f->image->width * (size_t)f->image->height, step = pixels / SAMPLES + 1;
  int count = 0;
  for (size_t i = 0; i < pixels; i += step)
    if (fabsf(f->off[i]) > 0.f) samples[count++] = fabsf(f->off[i]);
  if (!count) return INFINITY;
  qsort(samples, (size_t)count, sizeof *samples, rc_by_value);
  return samples[count / 2];
}

/* Weighed sums over the pixels of one thing. */
typedef struct moments {
  double weight, u, v, uu, uv, vv, off;
  int pixels;
  double cut, cut_u, cut_v; /* how many of them end with what is known, and their sums */
} moments;

static void add(const finder *f, int x, int y, float off, moments *m) {
  double u, v, w;
  if (!rc_ground_place(f->ground, f->exponent, x, y, &u, &v, &w)) return;
  double weight = (double)off / (w * w * w); /* a pixel's area in the plane */
  m->weight += weight, m->u += weight * u, m->v += weight * v;
  m->uu += weight * u * u, m->uv += weight * u * v, m->vv += weight * v * v;
  m->off += (double)off;
  m->pixels++;
}

static bool stands_out(const finder *f, int32_t pixel) {
  return f->off[pixel] > f->least && !f->taken[pixel];
}

/* All that hangs together with a pixel. */
static moments collect(const finder *f, int32_t pixel) {
  int width = f->image->width, depth = 0;
  moments m = {0};
  f->stack[depth++] = pixel;
  add(f, pixel % width, pixel / width, f->off[pixel], &m);
  f->taken[pixel] = 1;
  while (depth) {
    int here = f->stack[--depth], hx = here % width, hy = here / width;
    bool cut = false;
    for (int y = hy - 1; y <= hy + 1; y++)
      for (int x = hx - 1; x <= hx + 1; x++) {
        if (!rc_inside(width, f->image->height, x, y) || isnan(f->off[y * width + x])) {
          cut = true;
          continue;
        }
        if (!stands_out(f, y * width + x)) continue;
        add(f, x, y, f->off[y * width + x], &m);
        f->taken[y * width + x] = 1;
        f->stack[depth++] = y * width + x;
      }
    if (!cut) continue;
    double u, v, w;
    if (!rc_ground_place(f->ground, f->exponent, hx, hy, &u, &v, &w)) continue;
    m.cut++, m.cut_u += u, m.cut_v += v;
  }
  return m;
}

/* False: too small, or wholly seen and not long. */
static bool is_dash(const finder *f, const moments *m, rc_dash *dash) {
  if (m->pixels < LEAST_PIXELS) return false;
  double u = m->u / m->weight, v = m->v / m->weight;
  double uu = m->uu / m->weight - u * u, vv = m->vv / m->weight - v * v;
  double uv = m->uv / m->weight - u * v;
  rc_spread spread;
  if (!rc_spread_of(uu, uv, vv, &spread)) return false;
  double length = sqrt(12 * spread.great), width = sqrt(12 * spread.little);
  if (!(m->cut > 0) && length < LEAST_ELONGATION * width) return false;
  double x_px, y_px, w;
  if (!rc_ground_px(f->ground, 0, u, v, &x_px, &y_px, &w)) return false;
  *dash = (rc_dash){.u = u,
                    .v = v,
                    .a = spread.x,
                    .b = spread.y,
                    .length = length,
                    .width = width,
                    .w = w,
                    .contrast = m->off / m->pixels,
                    .complete = !(m->cut > 0),
                    .uu = uu,
                    .uv = uv,
                    .vv = vv,
                    .cut_u = m->cut > 0 ? m->cut_u / m->cut : u,
                    .cut_v = m->cut > 0 ? m->cut_v / m->cut : v};
  return true;
}

static recede_status collect_all(rc_context *context, const finder *f, rc_dashes *dashes) {
  rc_dash dash;
  size_t pixels = (size_t)f->image->width * (size_t)f->image->height;
  for (size_t i = 0; i < pixels; i++) {
    if (!stands_out(f, (int32_t)i)) continue;
    moments m = collect(f, (int32_t)i);
    if (!is_dash(f, &m, &dash)) continue;
    if (dashes->count == RC_MOST_DASHES) {
      dashes->count = 0;
      break;
    }
    dashes->found[dashes->count++] = dash;
  }
  return rc_poll(context);
}

recede_status rc_dashes_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                             const rc_ground *ground, int exponent, rc_dashes *dashes) {
  finder f = {.image = image,
              .flags = flags,
              .ground = ground,
              .exponent = exponent,
              .square_px = SQUARE_OF_HOLE * (float)rc_longer_side(rc_box_of(flags, RC_TARGET))};
  size_t width = (size_t)image->width, height = (size_t)image->height;
  *dashes = (rc_dashes){.width = image->width, .height = image->height};
  RC_TRY(RC_NEW(context, width * height, &dashes->off));
  f.off = dashes->off;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, (width + 1) * (height + 1), &f.sums));
  RC_TRY(RC_NEW_ZERO(context, (width + 1) * (height + 1), &f.counts));
  RC_TRY(sum_up(context, &f));
  RC_TRY(compare(context, &f));
  f.least = fmaxf(TIMES_MEDIAN * usual_difference(&f), LEAST_CONTRAST);
  RC_FREE(context, &f.sums);
  RC_TRY(RC_NEW(context, width * height, &f.stack));
  RC_TRY(RC_NEW_ZERO(context, width * height, &f.taken));
  RC_TRY(collect_all(context, &f, dashes));
  rc_release(context, mark);
  return RECEDE_OK;
}

static bool place_on(const rc_ground *old, const rc_ground *ground, double *u, double *v,
                     double *w) {
  double x, y;
  return rc_ground_px(old, 0, *u, *v, &x, &y, w) && rc_ground_place(ground, 0, x, y, u, v, w);
}

void rc_dashes_move(const rc_dashes *from, const rc_ground *old, const rc_ground *ground,
                    rc_dashes *to) {
  *to = *from, to->count = 0;
  for (int i = 0; i < from->count; i++) {
    rc_dash d = from->found[i];
    double u[4], v[4], w;
    bool seen = true;
    for (int k = 0; k < 4; k++) { /* its ends and sides */
      double half = (k & 1 ? .5 : -.5) * (k < 2 ? d.length : d.width);
      u[k] = d.u + half * (k < 2 ? d.a : -d.b), v[k] = d.v + half * (k < 2 ? d.b : d.a);
      seen = seen && place_on(old, ground, &u[k], &v[k], &w);
    }
    if (!seen || !place_on(old, ground, &d.u, &d.v, &d.w)) continue;
    d.length = rc_distance(u[1] - u[0], v[1] - v[0]),
    d.width = rc_distance(u[3] - u[2], v[3] - v[2]);
    d.a = (u[1] - u[0]) / d.length, d.b = (v[1] - v[0]) / d.length;
    to->found[to->count++] = d;
  }
}
