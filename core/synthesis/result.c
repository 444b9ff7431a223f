#include "synthesis/result.h"

#include <math.h>
#include <string.h>

#include "image/view.h"

static void copy_pixels(const recede_view *from, const recede_view *to) {
  if (from->data == to->data) return;
  for (int y = 0; y < from->height; y++)
    memcpy(rc_view_pixel(to, 0, y), rc_view_pixel(from, 0, y),
           (size_t)from->width * (size_t)from->channels * rc_type_bytes(from->type));
}

float rc_least_known(const recede_view *image, const rc_problem *problem, int x0, int y0) {
  int channels = image->channels < 3 ? 1 : 3;
  float least = 0, pixel[4];
  if (image->type != RECEDE_FLOAT && image->type != RECEDE_HALF) return least;
  for (int y = 0; y < problem->flags.height; y++)
    for (int x = 0; x < problem->flags.width; x++) {
      if (!(*rc_flag(&problem->flags, x, y) & RC_KNOWN)) continue;
      rc_view_read(image, x0 + x, y0 + y, 1, pixel);
      for (int k = 0; k < channels; k++) least = fminf(least, pixel[k]);
    }
  return least;
}

/* One pixel of the result: the fill laid over what was there, by the mask's value. */
static void blend_pixel(const recede_view *result, int x, int y, const float *fill, float least,
                        float amount) {
  float pixel[4];
  int channels = result->channels, colours = channels < 3 ? 1 : 3;
  bool alpha = colours < channels;
  rc_view_read(result, x, y, 1, pixel);
  float old_alpha = alpha && isfinite(pixel[colours]) ? fminf(fmaxf(pixel[colours], 0), 1) : 1.f;
  float new_alpha = amount + old_alpha * (1 - amount);
  for (int k = 0; k < colours; k++) {
    float new = fmaxf(fill[k], least);
    float old = isfinite(pixel[k]) && old_alpha > 0 ? pixel[k] : new;
    pixel[k] = amount >= 1 ? new : (new *amount + old *old_alpha *(1 - amount)) / new_alpha;
  }
  if (alpha) pixel[colours] = new_alpha;
  rc_view_write(result, x, y, 1, pixel);
}

void rc_write_fill(const rc_views *views, const rc_problem *problem, const rc_image *filled,
                   const recede_view *result) {
  float least = rc_least_known(views->image, problem, problem->origin_x, problem->origin_y);
  copy_pixels(views->image, result);
  for (int y = problem->target.y0; y < problem->target.y1; y++)
    for (int x = problem->target.x0; x < problem->target.x1; x++) {
      float amount;
      if (!(*rc_flag(&problem->flags, x, y) & RC_TARGET)) continue;
      rc_view_read(views->mask, problem->origin_x + x, problem->origin_y + y, 1, &amount);
      blend_pixel(result, problem->origin_x + x, problem->origin_y + y, rc_pixel(filled, x, y),
                  least, fminf(amount, 1));
    }
}

void rc_write_synthesis(const rc_image *made, const rc_mask *flags, float least,
                        const recede_view *result) {
  for (int y = 0; y < result->height; y++)
    for (int x = 0; x < result->width; x++) {
      float pixel[4] = {0, 0, 0, 0};
      int colours = made->channels;
      bool there = !flags || *rc_flag(flags, x, y);
      for (int k = 0; k < colours && there; k++) pixel[k] = fmaxf(rc_pixel(made, x, y)[k], least);
      pixel[colours] = there ? 1 : 0;
      rc_view_write(result, x, y, 1, pixel);
    }
}

void rc_write_exemplar(const recede_view *exemplar, const rc_problem *problem,
                       const recede_view *result) {
  size_t bytes = (size_t)result->channels * rc_type_bytes(result->type);
  for (int y = 0; y < result->height; y++)
    for (int x = 0; x < result->width; x++)
      if (*rc_flag(&problem->flags, x, y) & RC_KNOWN)
        memcpy(rc_view_pixel(result, x, y),
               rc_view_pixel(exemplar, x + problem->exemplar_x, y + problem->exemplar_y), bytes);
}
