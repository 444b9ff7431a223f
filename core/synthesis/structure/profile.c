#include "synthesis/structure/profile.h"

#include <math.h>

bool rc_ruler_sample(const rc_ruler *ruler, float x, float y, float *value) {
  int px = (int)floorf(x), py = (int)floorf(y);
  float v[4], fx = x - (float)px, fy = y - (float)py;
  for (int k = 0; k < 4; k++)
    if (!ruler->value(ruler->picture, px + (k & 1), py + (k >> 1), &v[k])) return false;
  *value = (v[0] * (1 - fx) + v[1] * fx) * (1 - fy) + (v[2] * (1 - fx) + v[3] * fx) * fy;
  return true;
}

bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     rc_profile *profile) {
  profile->tone = 0;
  for (int o = 0; o < RC_PROFILE; o++) {
    int found = 0;
    float sum = 0;
    for (int k = 0; k < count; k++) {
      float along = from + step * (float)k, across = (float)(o - RC_PROFILE_HALF), value;
      if (!rc_ruler_sample(ruler, x + ruler->ux * along - ruler->uy * across,
                           y + ruler->uy * along + ruler->ux * across, &value))
        continue;
      sum += value;
      found++;
    }
    if (3 * found < count) return false;
    profile->mean[o] = sum / (float)found;
    profile->tone += profile->mean[o] / RC_PROFILE;
  }
  for (int o = 0; o < RC_PROFILE; o++) profile->mean[o] -= profile->tone;
  return true;
}

float rc_profile_dot(const rc_profile *a, const rc_profile *b) {
  float sum = 0;
  for (int o = 0; o < RC_PROFILE; o++) sum += a->mean[o] * b->mean[o];
  return sum;
}
