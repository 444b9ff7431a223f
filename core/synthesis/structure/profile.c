#include "synthesis/structure/profile.h"

#include <math.h>

/* Lines of the plane get wider as w does. But nearer to each other samples see the same, and
 * farther they leave out what lies between. */
#define LEAST_SAMPLE_PX .5f
#define MOST_SAMPLE_PX 3.f

/* A row of samples across, and one more: the compiler makes vectors of it. */
#define LANES (RC_PROFILE + 1)

static int floor_of(float value) {
  int whole = (int)value;
  return whole - ((float)whole > value);
}

/* Whether there are pixels to all sides of what lies between (x, y) and the next ones. */
static bool is_within(const rc_mask *flags, int x, int y) {
  return x >= 0 && y >= 0 && x < flags->width - 1 && y < flags->height - 1;
}

static float between(float a, float b, float c, float d, float fx, float fy) {
  return (a * (1 - fx) + b * fx) * (1 - fy) + (c * (1 - fx) + d * fx) * fy;
}

bool rc_ruler_sample(const rc_ruler *ruler, float x, float y, float *value) {
  int px = floor_of(x), py = floor_of(y), width = ruler->picture->flags->width;
  if (!is_within(ruler->picture->flags, px, py)) return false;
  const float *v = ruler->picture->value + (size_t)py * (size_t)width + (size_t)px;
  float here = between(v[0], v[1], v[width], v[width + 1], x - (float)px, y - (float)py);
  if (isnan(here)) return false;
  *value = here;
  return true;
}

/* RC_PROFILE samples so far from each other across (x, y); NAN: it is not seen. */
static void sample_across(const rc_ruler *ruler, float x, float y, float apart,
                          float value[LANES]) {
  const rc_mask *flags = ruler->picture->flags;
  float at_x[LANES], at_y[LANES], corner[4][LANES];
  int px[LANES], py[LANES];
  for (int o = 0; o < LANES; o++) {
    float off = (float)(o - RC_PROFILE_HALF) * apart;
    at_x[o] = x - ruler->uy * off, at_y[o] = y + ruler->ux * off;
    px[o] = floor_of(at_x[o]), py[o] = floor_of(at_y[o]);
  }
  for (int o = 0; o < RC_PROFILE; o++) {
    bool within = is_within(flags, px[o], py[o]);
    const float *v = ruler->picture->value;
    if (within) v += (size_t)py[o] * (size_t)flags->width + (size_t)px[o];
    for (int k = 0; k < 4; k++) corner[k][o] = within ? v[(k >> 1) * flags->width + (k & 1)] : NAN;
  }
  for (int k = 0; k < 4; k++) corner[k][RC_PROFILE] = NAN;
  for (int o = 0; o < LANES; o++)
    value[o] = between(corner[0][o], corner[1][o], corner[2][o], corner[3][o],
                       at_x[o] - (float)px[o], at_y[o] - (float)py[o]);
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
  float sum[LANES] = {0}, value[LANES];
  int found[LANES] = {0};
  for (int k = 0; k < count; k++) {
    float along = from + step * (float)k;
    float px = x + ruler->ux * along, py = y + ruler->uy * along;
    sample_across(ruler, px, py, rc_ruler_px(ruler->chart, px, py), value);
    for (int o = 0; o < LANES; o++) {
      bool seen = !isnan(value[o]);
      sum[o] += seen ? value[o] : 0.f;
      found[o] += seen;
    }
  }
  profile->tone = 0;
  for (int o = 0; o < RC_PROFILE; o++) {
    if (3 * found[o] < count) return false;
    profile->mean[o] = sum[o] / (float)(found[o] ? found[o] : 1);
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
