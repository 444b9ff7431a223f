/* Scale maps: how many px a texel takes, exactly and as the paper's eqs 1-3 have it. */
#include <math.h>

#include "recede.h"

/* Eqs 1-3 read correctly: S(p) = S_max - (Y_proj - Y_min) S_delta / Y_delta (the printed eq. 3 has
 * Y_max for S_max), y upwards, (w - 1) / 2 for the centre, |sin|, |cos| for tilts outside 0..90. */
static double paper_scale(const recede_plane *plane, double x, double y) {
  double slant, tilt, fov;
  recede_plane_angles(plane, &slant, &tilt, &fov);
  double radian = 3.14159265358979323846 / 180, sine = sin(tilt * radian),
         cosine = cos(tilt * radian);
  double s_min = cos(slant * radian), s_max = 1 / s_min; /* eq. 1 */
  double half_w = (plane->width - 1) / 2., half_h = (plane->height - 1) / 2.;
  double y_max = half_w * fabs(sine) + half_h * fabs(cosine); /* eq. 2 */
  double y_proj = (x - half_w) * sine - (y - half_h) * cosine;
  if (slant >= 90) return NAN;
  if (y_max == 0) return 1;
  return s_max - (y_proj + y_max) * (s_max - s_min) / (2 * y_max); /* eq. 3 */
}

double recede_scale_at(const recede_plane *plane, recede_scale_kind kind, double ref_x,
                       double ref_y, double x, double y) {
  if (kind == RECEDE_SCALE_PAPER) return paper_scale(plane, x, y);
  double w = recede_plane_w(plane, x, y), w0 = recede_plane_w(plane, ref_x, ref_y);
  if (!(w > 0) || !(w0 > 0)) return NAN;
  switch (kind) {
    case RECEDE_SCALE_ACROSS: return w / w0;
    case RECEDE_SCALE_ALONG: return w * w / w0;
    default: return w * w * w / (w0 * w0);
  }
}

recede_status recede_scale_map(const recede_plane *plane, recede_scale_kind kind, double ref_x,
                               double ref_y, const recede_view *out) {
  if (!out || !out->data || out->type != RECEDE_FLOAT || out->channels != 1 ||
      out->width != plane->width || out->height != plane->height ||
      out->stride_bytes < (size_t)out->width * sizeof(float) || (unsigned)kind > RECEDE_SCALE_PAPER)
    return RECEDE_ARGUMENT;
  if (kind == RECEDE_SCALE_PAPER ? plane->normal[2] <= 0 : recede_plane_w(plane, ref_x, ref_y) <= 0)
    return RECEDE_NO_PLANE;
  for (int y = 0; y < out->height; y++) {
    float *row = (float *)(void *)((char *)out->data + (size_t)y * out->stride_bytes);
    for (int x = 0; x < out->width; x++)
      row[x] = (float)recede_scale_at(plane, kind, ref_x, ref_y, x, y);
  }
  return RECEDE_OK;
}
