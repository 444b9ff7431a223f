/* Callers' pixels in and out: any of the public types as floats and back. */
#ifndef RECEDE_IMAGE_VIEW_H
#define RECEDE_IMAGE_VIEW_H

#include "base/context.h"

/* RECEDE_ARGUMENT with a message that starts with name. channels 0: any of 1..4. */
recede_status rc_view_check(rc_context *context, const recede_view *view, const char *name,
                            int channels);
size_t rc_type_bytes(recede_type type);
/* count channel values of row y from column x on, as floats (integers / maximum). */
void rc_view_read(const recede_view *view, int x, int y, int count_px, float *values);
/* The inverse: clamped and rounded for integer types, as they are for floats. */
void rc_view_write(const recede_view *view, int x, int y, int count_px, const float *values);
static inline void *rc_view_pixel(const recede_view *view, int x, int y) {
  return (char *)view->data + (size_t)y * view->stride_bytes +
         (size_t)x * (size_t)view->channels * rc_type_bytes(view->type);
}
/* A hash of the pixels' bytes, row by row, without what lies between rows. */
uint64_t rc_view_hash(const recede_view *view);

#endif
