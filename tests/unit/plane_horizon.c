/* Holes that reach the horizon. Near it all is small, so that what a hole has there is little of it
 * and much of what is seen: it must look like what lies beside it. */
#include <math.h>

#include "plane_scene.h"

#define SLANT_DEG 84.
#define SKY .95
#define HAZE .71

typedef struct scene {
  int width, height;
  double haze; /* reaches so far from the horizon; of w, 1 in the middle of the picture */
  double deep; /* the hole's middle is so much lower than the horizon, of the height */
} scene;

static double nearness(const scene *s, double tilt_deg, double x, double y) {
  recede_plane plane;
  g_assert_cmpint(recede_plane_from_angles(s->width, s->height, SLANT_DEG, tilt_deg, 50, &plane),
                  ==, RECEDE_OK);
  return recede_plane_w(&plane, x, y) /
         recede_plane_w(&plane, (s->width - 1) / 2., (s->height - 1) / 2.);
}

/* A dark coarse ground, bright haze where it is far, and sky. */
static picture ground_in_haze(const scene *s, double tilt_deg) {
  picture p = picture_new(s->width, s->height, 1, RECEDE_U8);
  for (int y = 0; y < s->height; y++)
    for (int x = 0; x < s->width; x++) {
      double w = nearness(s, tilt_deg, x, y);
      double ground = .2 + .2 * noise_at(x / 3, y / 3, 5);
      double haze = HAZE + .02 * (noise_at(x, y, 6) - .5);
      picture_set(&p, x, y, 0, (float)(w > s->haze ? ground : w > 0 ? haze : SKY));
    }
  return p;
}

/* How far what a hole across the horizon gets near it is from the haze beside: mean of its pixels.
 */
static double off_the_haze(const scene *s, const char *settings, double tilt_deg) {
  double sum = 0, count = 0, radius = s->height / 5.;
  double up_x = sin(tilt_deg * G_PI / 180), up_y = -cos(tilt_deg * G_PI / 180);
  /* w falls by 1 from the middle to the horizon */
  double slope = nearness(s, tilt_deg, (s->width - 1) / 2. - up_x, (s->height - 1) / 2. - up_y) - 1;
  double off = 1 / slope - s->deep * s->height;
  task t = task_new(ground_in_haze(s, tilt_deg), settings);
  t.params.slant_deg = SLANT_DEG, t.params.tilt_deg = tilt_deg;
  for (int y = 0; y < s->height; y++)
    for (int x = 0; x < s->width; x++)
      if (hypot(x - (s->width - 1) / 2. - off * up_x, y - (s->height - 1) / 2. - off * up_y) <
          radius)
        picture_set(&t.mask, x, y, 0, 1);
  task_succeeds(&t);
  g_assert_cmpuint(t.report.refused_pixels, >, 1000);
  for (int y = 0; y < s->height; y++)
    for (int x = 0; x < s->width; x++) {
      double w = nearness(s, tilt_deg, x, y);
      if (!(picture_get(&t.mask, x, y, 0) > 0) || w < .03 || w > .8 * s->haze) continue;
      sum += fabs(picture_get(&t.result, x, y, 0) - HAZE), count++;
    }
  task_clear(&t);
  g_test_message("%d px, %s, tilt %.0f: %.4f off, of %.0f px", s->width, settings, tilt_deg,
                 sum / count, count);
  g_assert_cmpfloat(count, >, 300);
  return sum / count;
}

static void haze_goes_on(void) {
  static const scene s = {480, 360, .25, 0};
  static const double tilts_deg[] = {0, 30, 90, -160};
  static const char *const settings[] = {"surface=flat", "surface=raised",
                                         "surface=flat quality=draft"};
  for (int i = 0; i < (int)G_N_ELEMENTS(tilts_deg); i++)
    for (int k = 0; k < (int)G_N_ELEMENTS(settings); k++)
      g_assert_cmpfloat(off_the_haze(&s, settings[k], tilts_deg[i]), <, .05);
}

/* A strip of haze so thin that a coarse level has no patch of it: by its copies it would be ground.
 */
static void thin_haze_goes_on(void) {
  static const scene s = {1000, 750, .12, .1};
  double with = off_the_haze(&s, "surface=raised", 0);
  double without = off_the_haze(&s, "surface=raised engine-beside=0", 0);
  g_assert_cmpfloat(with, <, .03);
  g_assert_cmpfloat(with, <, .5 * without);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/horizon/haze", haze_goes_on);
  g_test_add_func("/horizon/thin", thin_haze_goes_on);
  return g_test_run();
}
