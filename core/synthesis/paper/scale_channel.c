#include "synthesis/paper/scale_channel.h"

rc_line rc_scale_channel(const recede_plane *plane) {
  double c = recede_scale_at(plane, RECEDE_SCALE_PAPER, 0, 0, 0, 0);
  return (rc_line){recede_scale_at(plane, RECEDE_SCALE_PAPER, 0, 0, 1, 0) - c,
                   recede_scale_at(plane, RECEDE_SCALE_PAPER, 0, 0, 0, 1) - c, c};
}

rc_line rc_scale_resampled(const rc_line *scale, int width, int height, int new_width,
                           int new_height) {
  double x = new_width > 1 ? (width - 1.) / (new_width - 1) : 1;
  double y = new_height > 1 ? (height - 1.) / (new_height - 1) : 1;
  return (rc_line){scale->a * x, scale->b * y, scale->c};
}

rc_line rc_scale_moved(const rc_line *scale, int x, int y) {
  return (rc_line){scale->a, scale->b, rc_w(scale, x, y)};
}
