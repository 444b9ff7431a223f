#include "pixels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t pixels_type_bytes(recede_type type) {
  return type == RECEDE_U8 ? 1 : type == RECEDE_FLOAT ? 4 : 2;
}

uint64_t pixels_bytes(int width, int height, int channels, recede_type type) {
  return (uint64_t)width * (uint64_t)height * (uint64_t)channels * pixels_type_bytes(type);
}

recede_view pixels_new(int width, int height, int channels, recede_type type) {
  recede_view view = {NULL, 0, width, height, channels, type};
  view.stride_bytes = (size_t)width * (size_t)channels * pixels_type_bytes(type);
  view.data = calloc((size_t)height, view.stride_bytes);
  return view;
}

static unsigned char *pixel_at(const recede_view *view, int x, int y) {
  return (unsigned char *)view->data + (size_t)y * view->stride_bytes +
         (size_t)x * (size_t)view->channels * pixels_type_bytes(view->type);
}

/* IEEE half to float and back (to nearest, ties to even), without the compiler's _Float16, which
 * gcc 12 lacks on some machines. */
static float from_half(uint16_t half) {
  int exponent = half >> 10 & 31, fraction = half & 1023;
  float value = exponent == 0    ? ldexpf((float)fraction, -24)
                : exponent == 31 ? (fraction ? NAN : INFINITY)
                                 : ldexpf((float)(fraction + 1024), exponent - 25);
  return half & 0x8000 ? -value : value;
}

static uint16_t to_half(float value) {
  uint16_t sign = signbit(value) ? 0x8000 : 0;
  float size = fabsf(value);
  int exponent;
  if (isnan(value)) return (uint16_t)(sign | 0x7e00);
  if (size >= 65520) return (uint16_t)(sign | 0x7c00);
  if (size < 0x1p-14f) return (uint16_t)(sign | (uint16_t)lrintf(size * 0x1p24f));
  frexpf(size, &exponent);                             /* size = f 2^exponent, f in [1/2, 1) */
  long fraction = lrintf(ldexpf(size, 11 - exponent)); /* 1024..2048; a carry moves up rightly */
  return (uint16_t)(sign | (((exponent + 14) << 10) + (fraction - 1024)));
}

float pixels_get(const recede_view *view, int x, int y, int channel) {
  const void *at = pixel_at(view, x, y);
  switch (view->type) {
    case RECEDE_U8: return ((const uint8_t *)at)[channel] / 255.f;
    case RECEDE_U16: return ((const uint16_t *)at)[channel] / 65535.f;
    case RECEDE_HALF: return from_half(((const uint16_t *)at)[channel]);
    default: return ((const float *)at)[channel];
  }
}

static float clamp01(float value) { return value > 0 ? fminf(value, 1) : 0; }

void pixels_set(const recede_view *view, int x, int y, int channel, float value) {
  void *at = pixel_at(view, x, y);
  switch (view->type) {
    case RECEDE_U8: ((uint8_t *)at)[channel] = (uint8_t)(clamp01(value) * 255 + .5f); break;
    case RECEDE_U16: ((uint16_t *)at)[channel] = (uint16_t)(clamp01(value) * 65535 + .5f); break;
    case RECEDE_HALF: ((uint16_t *)at)[channel] = to_half(value); break;
    default: ((float *)at)[channel] = value;
  }
}

bool pixels_turn_swaps(int orientation) { return orientation >= 5; }
int pixels_turn_inverse(int orientation) {
  return orientation == 6 ? 8 : orientation == 8 ? 6 : orientation;
}

/* Exif: 2 mirrored left-right, 3 by 180 degrees, 4 mirrored up-down, 5 transposed, 6 to be turned
 * 90 clockwise, 7 transposed over the other diagonal, 8 to be turned 90 counter-clockwise. */
void pixels_turn(const recede_view *from, int orientation, const recede_view *to) {
  size_t bytes = (size_t)from->channels * pixels_type_bytes(from->type);
  int last_x = from->width - 1, last_y = from->height - 1;
  for (int y = 0; y < to->height; y++)
    for (int x = 0; x < to->width; x++) {
      bool swap = pixels_turn_swaps(orientation);
      int sx = swap ? y : x, sy = swap ? x : y;
      if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8)
        sx = last_x - sx;
      if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7)
        sy = last_y - sy;
      memcpy(pixel_at(to, x, y), pixel_at(from, sx, sy), bytes);
    }
}

static int alpha_of(const recede_view *view) {
  return view->channels == 2 || view->channels == 4 ? view->channels - 1 : -1;
}

static bool opaque(const recede_view *view, const recede_view *mask) {
  int alpha = alpha_of(view);
  for (int y = 0; alpha >= 0 && y < view->height; y++)
    for (int x = 0; x < view->width; x++)
      if (pixels_get(view, x, y, alpha) != 1 && !(mask && pixels_get(mask, x, y, 0) > 0))
        return false;
  return true;
}

bool pixels_opaque(const recede_view *view) { return opaque(view, NULL); }

bool pixels_opaque_outside(const recede_view *view, const recede_view *mask) {
  return opaque(view, mask);
}

void pixels_convert(const recede_view *from, const recede_view *to) {
  int alpha = alpha_of(from), new_alpha = alpha_of(to);
  int colours = from->channels < 3 ? 1 : 3;
  for (int y = 0; y < to->height; y++)
    for (int x = 0; x < to->width; x++)
      for (int c = 0; c < to->channels; c++) {
        int source = c == new_alpha ? alpha : c < colours ? c : 0;
        pixels_set(to, x, y, c, source < 0 ? 1 : pixels_get(from, x, y, source));
      }
}

bool pixels_to_mask(const recede_view *from, bool premultiplied, const recede_view *to, int *bad_x,
                    int *bad_y) {
  static const float rec709[3] = {.2126f, .7152f, .0722f};
  int alpha = premultiplied ? -1 : alpha_of(from);
  for (int y = 0; y < to->height; y++)
    for (int x = 0; x < to->width; x++) {
      float value = pixels_get(from, x, y, 0);
      if (from->channels >= 3) {
        float green = pixels_get(from, x, y, 1), blue = pixels_get(from, x, y, 2);
        /* Equal channels must give their very value. */
        if (value != green || value != blue)
          value = rec709[0] * value + rec709[1] * green + rec709[2] * blue;
      }
      if (alpha >= 0) value *= pixels_get(from, x, y, alpha);
      if (!isfinite(value)) {
        *bad_x = x, *bad_y = y;
        return false;
      }
      pixels_set(to, x, y, 0, value);
    }
  return true;
}

static void scale_colours(const recede_view *view, int x, int y, float factor) {
  for (int c = 0; c < view->channels - 1; c++)
    pixels_set(view, x, y, c, pixels_get(view, x, y, c) * factor);
}

void pixels_unpremultiply(const recede_view *view) {
  for (int y = 0; y < view->height; y++)
    for (int x = 0; x < view->width; x++) {
      float alpha = pixels_get(view, x, y, view->channels - 1);
      if (alpha > 0 && alpha != 1) scale_colours(view, x, y, 1 / alpha);
    }
}

void pixels_premultiply(const recede_view *view) {
  for (int y = 0; y < view->height; y++)
    for (int x = 0; x < view->width; x++)
      scale_colours(view, x, y, pixels_get(view, x, y, view->channels - 1));
}

void pixels_premultiply_filled(const recede_view *result, const recede_view *original,
                               const recede_view *mask) {
  size_t bytes = (size_t)result->channels * pixels_type_bytes(result->type);
  for (int y = 0; y < result->height; y++)
    for (int x = 0; x < result->width; x++) {
      if (!(pixels_get(mask, x, y, 0) > 0))
        memcpy(pixel_at(result, x, y), pixel_at(original, x, y), bytes);
      else
        scale_colours(result, x, y, pixels_get(result, x, y, result->channels - 1));
    }
}

void pixels_premultiply_around(const recede_view *result, const recede_view *divided,
                               const recede_view *original) {
  size_t bytes = (size_t)result->channels * pixels_type_bytes(result->type);
  /* Either may be the larger: below 0 is what the result has no room for. */
  int left = (result->width - divided->width) / 2, top = (result->height - divided->height) / 2;
  for (int y = 0; y < result->height; y++)
    for (int x = 0; x < result->width; x++) {
      int sx = x - left, sy = y - top;
      bool within = sx >= 0 && sy >= 0 && sx < divided->width && sy < divided->height;
      if (within && memcmp(pixel_at(result, x, y), pixel_at(divided, sx, sy), bytes) == 0)
        memcpy(pixel_at(result, x, y), pixel_at(original, sx, sy), bytes);
      else
        scale_colours(result, x, y, pixels_get(result, x, y, result->channels - 1));
    }
}
