#include "image/view.h"

#include <math.h>
#include <string.h>

#include "base/random.h"

size_t rc_type_bytes(recede_type type) {
  return type == RECEDE_U8 ? 1 : type == RECEDE_FLOAT ? 4 : 2;
}

recede_status rc_view_check(rc_context *context, const recede_view *view, const char *name,
                            int channels) {
  if (!view || !view->data) return rc_fail(context, RECEDE_ARGUMENT, "%s: no pixels given.", name);
  if (view->width < 1 || view->height < 1 || view->width > 1 << 20 || view->height > 1 << 20)
    return rc_fail(context, RECEDE_ARGUMENT, "%s: its size %d x %d is outside 1..1048576.", name,
                   view->width, view->height);
  if (channels ? view->channels != channels : view->channels < 1 || view->channels > 4)
    return rc_fail(context, RECEDE_ARGUMENT, "%s: %d channels; %s needed.", name, view->channels,
                   channels == 1 ? "1 is" : "1 to 4 are");
  if ((unsigned)view->type > RECEDE_FLOAT)
    return rc_fail(context, RECEDE_ARGUMENT, "%s: unknown pixel type %d.", name, (int)view->type);
  size_t row = (size_t)view->width * (size_t)view->channels * rc_type_bytes(view->type);
  if (view->stride_bytes < row)
    return rc_fail(context, RECEDE_ARGUMENT, "%s: a stride of %zu bytes is less than a row's %zu.",
                   name, view->stride_bytes, row);
  return RECEDE_OK;
}

static float half_to_float(uint16_t half) {
  uint32_t sign = (uint32_t)(half & 0x8000) << 16, exponent = half >> 10 & 31, bits;
  uint32_t mantissa = half & 0x3ff;
  float value;
  if (exponent == 31) {
    bits = sign | 0x7f800000 | mantissa << 13;
  } else if (exponent) {
    bits = sign | (exponent + 112) << 23 | mantissa << 13;
  } else {
    value = (float)mantissa * 0x1p-24f;
    return sign ? -value : value;
  }
  memcpy(&value, &bits, 4);
  return value;
}

/* Rounds to nearest, ties to even; beyond the largest half becomes infinite. */
static uint16_t float_to_half(float value) {
  uint32_t bits;
  memcpy(&bits, &value, 4);
  uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
  bits &= 0x7fffffff;
  if (bits > 0x7f800000) return sign | 0x7e00;
  if (bits >= 0x477ff000) return sign | 0x7c00;
  if (bits < 0x38800000) {
    float small = fabsf(value) * 0x1p24f;
    return (uint16_t)(sign | (uint16_t)lrintf(small));
  }
  bits += 0xfff + (bits >> 13 & 1);
  return (uint16_t)(sign | (uint16_t)((bits - 0x38000000) >> 13));
}

void rc_view_read(const recede_view *view, int x, int y, int count_px, float *values) {
  const void *pixel = rc_view_pixel(view, x, y);
  int count = count_px * view->channels;
  switch (view->type) {
    case RECEDE_U8:
      for (int i = 0; i < count; i++) values[i] = (float)((const uint8_t *)pixel)[i] / 255.f;
      break;
    case RECEDE_U16:
      for (int i = 0; i < count; i++) values[i] = (float)((const uint16_t *)pixel)[i] / 65535.f;
      break;
    case RECEDE_HALF:
      for (int i = 0; i < count; i++) values[i] = half_to_float(((const uint16_t *)pixel)[i]);
      break;
    case RECEDE_FLOAT: memcpy(values, pixel, (size_t)count * sizeof *values); break;
  }
}

static float clamped(float value) { return value < 0.f ? 0.f : value > 1.f ? 1.f : value; }

void rc_view_write(const recede_view *view, int x, int y, int count_px, const float *values) {
  void *pixel = rc_view_pixel(view, x, y);
  int count = count_px * view->channels;
  switch (view->type) {
    case RECEDE_U8:
      for (int i = 0; i < count; i++)
        ((uint8_t *)pixel)[i] = (uint8_t)(clamped(values[i]) * 255.f + .5f);
      break;
    case RECEDE_U16:
      for (int i = 0; i < count; i++)
        ((uint16_t *)pixel)[i] = (uint16_t)(clamped(values[i]) * 65535.f + .5f);
      break;
    case RECEDE_HALF:
      for (int i = 0; i < count; i++) ((uint16_t *)pixel)[i] = float_to_half(values[i]);
      break;
    case RECEDE_FLOAT: memcpy(pixel, values, (size_t)count * sizeof *values); break;
  }
}

uint64_t rc_view_hash(const recede_view *view) {
  size_t row = (size_t)view->width * (size_t)view->channels * rc_type_bytes(view->type);
  uint64_t hash = (uint64_t)view->width << 32 ^ (uint64_t)view->height ^
                  (uint64_t)view->channels << 24 ^ (uint64_t)view->type << 28;
  for (int y = 0; y < view->height; y++) {
    const unsigned char *bytes = rc_view_pixel(view, 0, y);
    size_t i = 0;
    for (; i + 8 <= row; i += 8) {
      uint64_t word;
      memcpy(&word, bytes + i, 8);
      hash = rc_mix(hash ^ word) + 0x9e3779b97f4a7c15u;
    }
    for (; i < row; i++) hash = rc_mix(hash ^ bytes[i]) + 0x9e3779b97f4a7c15u;
  }
  return hash;
}
