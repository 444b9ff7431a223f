#include "synthesis/profile.h"

#include <math.h>

static bool sample(const rc_ruler *ruler, float x, float y, float *value) {
  int px = (int)floorf(x), py = (int)floorf(y);
  float v[4], fx = x - (float)px, fy = y - (float)py;
  for (int k = 0; k < 4; k++)
    if (!ruler->value(ruler->picture, px + (k & 1), py + (k >> 1), &v[k])) return false;
  *value = (v[0] * (1 - fx) + v[1] * fx) * (1 - fy) + (v[2] * (1 - fx) + v[3] * fx) * fy;
  return true;
}

bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     float mean[RC_PROFILE]) {
  float centre = 0;
  for (int o = 0; o < RC_PROFILE; o++) {
    int found = 0;
    mean[o] = 0;
    for (int k = 0; k < count; k++) {
      float along = from + step * (float)k, across = (float)(o - RC_PROFILE_HALF), value;
      if (!sample(ruler, x + ruler->ux * along - ruler->uy * across,
                  y + ruler->uy * along + ruler->ux * across, &value))
        continue;
      mean[o] += value;
      found++;
    }
    if (3 * found < count) return false;
    mean[o] /= (float)found;
    centre += mean[o] / RC_PROFILE;
  }
  for (int o = 0; o < RC_PROFILE; o++) mean[o] -= centre;
  return true;
}

float rc_profile_dot(const float a[RC_PROFILE], const float b[RC_PROFILE]) {
  float sum = 0;
  for (int o = 0; o < RC_PROFILE; o++) sum += a[o] * b[o];
  return sum;
}
