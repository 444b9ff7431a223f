#include "synthesis/structure/profile.h"

#include <math.h>

/* Lines of the plane get wider as w does. But nearer to each other samples see the same, and
 * farther they leave out what lies between. */
#define LEAST_SAMPLE_PX .5f
#define MOST_SAMPLE_PX 3.f

bool rc_ruler_sample(const rc_ruler *ruler, float x, float y, float *value) {
  int px = (int)floorf(x), py = (int)floorf(y);
  float v[4], fx = x - (float)px, fy = y - (float)py;
  for (int k = 0; k < 4; k++)
    if (!ruler->value(ruler->picture, px + (k & 1), py + (k >> 1), &v[k])) return false;
  *value = (v[0] * (1 - fx) + v[1] * fx) * (1 - fy) + (v[2] * (1 - fx) + v[3] * fx) * fy;
  return true;
}

float rc_ruler_px(const rc_chart *chart, float x, float y) {
  if (!chart) return 1.f;
  float px = rc_chart_w(chart, x, y);
  return px < LEAST_SAMPLE_PX ? LEAST_SAMPLE_PX : px > MOST_SAMPLE_PX ? MOST_SAMPLE_PX : px;
}

bool rc_ruler_mean(const rc_ruler *ruler, float x, float y, float across, float from, float step,
                   int count, float *mean) {
  int found = 0;
  float sum = 0;
  for (int k = 0; k < count; k++) {
    float along = from + step * (float)k, value;
    float px = x + ruler->ux * along, py = y + ruler->uy * along;
    float off = across * rc_ruler_px(ruler->chart, px, py);
    if (!rc_ruler_sample(ruler, px - ruler->uy * off, py + ruler->ux * off, &value)) continue;
    sum += value;
    found++;
  }
  *mean = sum / (float)(found ? found : 1);
  return 3 * found >= count;
}

bool rc_profile_mean(const rc_ruler *ruler, float x, float y, float from, float step, int count,
                     rc_profile *profile) {
  profile->tone = 0;
  for (int o = 0; o < RC_PROFILE; o++) {
    float across = (float)(o - RC_PROFILE_HALF);
    if (!rc_ruler_mean(ruler, x, y, across, from, step, count, &profile->mean[o])) return false;
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

bool rc_profiles_alike(const rc_profile *a, const rc_profile *b, float least_likeness,
                       float most_unlike) {
  float aa = rc_profile_dot(a, a), bb = rc_profile_dot(b, b), most = most_unlike * most_unlike;
  return rc_profile_dot(a, b) > least_likeness * sqrtf(aa * bb) && aa < most * bb && bb < most * aa;
}
