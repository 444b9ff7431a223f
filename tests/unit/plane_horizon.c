/* Holes that reach the horizon. Near it all is small, so that what a hole has there is little of it
 * and much of what is seen: it must look like what lies beside it. */
#include <math.h>
#include <string.h>

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

/* A street's end: fronts of houses of many widths and greys, each down to where it stands. */
typedef struct street {
  double slant_deg, tilt_deg;
  double foot_px; /* below the horizon, of the houses that reach lowest */
} street;

#define STREET_WIDTH 480
#define STREET_HEIGHT 360
#define WINDOW_PX 9

/* Across the tilt from the middle, and below the horizon, px. */
static void street_place(const street *s, double x, double y, double *across, double *below) {
  double turn = s->tilt_deg * G_PI / 180, focal = STREET_WIDTH / 2. / tan(25 * G_PI / 180);
  double px = x - (STREET_WIDTH - 1) / 2., py = y - (STREET_HEIGHT - 1) / 2.;
  *across = px * cos(turn) + py * sin(turn);
  *below = -px * sin(turn) + py * cos(turn) + focal / tan(s->slant_deg * G_PI / 180);
}

static picture street_picture(const street *s) {
  picture p = picture_of_plane(STREET_WIDTH, STREET_HEIGHT, 1, RECEDE_U8, grains, 6, s->slant_deg,
                               s->tilt_deg);
  for (int y = 0; y < STREET_HEIGHT; y++)
    for (int x = 0; x < STREET_WIDTH; x++) {
      double across, below;
      street_place(s, x, y, &across, &below);
      int front = (int)floor(across / WINDOW_PX);
      if (below < s->foot_px * (.7 + .3 * noise_at(front / 3, 0, 7)))
        picture_set(&p, x, y, 0, (float)(.1 + .8 * noise_at(front, 1, 7)));
    }
  return p;
}

static bool in_street_hole(const street *s, int x, int y, double *below) {
  double across;
  street_place(s, x, y, &across, below);
  return *below > 2 && hypot((across - 70) / 55, (*below - 25) / 35) < 1;
}

/* Of the squares of gradients in the hole, from below the horizon to where all houses stand: the
 * part of those across upright edges. */
static double upright_part(const street *s, const picture *p) {
  double turn = s->tilt_deg * G_PI / 180, upright = 0, all = 0, below;
  for (int y = 1; y + 1 < STREET_HEIGHT; y++)
    for (int x = 1; x + 1 < STREET_WIDTH; x++) {
      if (!in_street_hole(s, x, y, &below) || below < 4 || below > .6 * s->foot_px) continue;
      double gx = (double)picture_get(p, x + 1, y, 0) - (double)picture_get(p, x - 1, y, 0);
      double gy = (double)picture_get(p, x, y + 1, 0) - (double)picture_get(p, x, y - 1, 0);
      double across = gx * cos(turn) + gy * sin(turn), along = gy * cos(turn) - gx * sin(turn);
      all += across * across + along * along;
      if (fabs(along) < .45 * fabs(across)) upright += across * across + along * along;
    }
  g_assert_cmpfloat(all, >, 1);
  return upright / all;
}

/* As a part of the truth's. */
static double filled_upright(const street *s, const char *settings) {
  task t = task_new(street_picture(s), settings);
  double truth = upright_part(s, &t.image), below;
  t.params.slant_deg = s->slant_deg, t.params.tilt_deg = s->tilt_deg;
  for (int y = 0; y < STREET_HEIGHT; y++)
    for (int x = 0; x < STREET_WIDTH; x++)
      if (in_street_hole(s, x, y, &below)) picture_set(&t.mask, x, y, 0, 1);
  task_succeeds(&t);
  double part = upright_part(s, &t.result) / truth;
  g_test_message("slant %.0f, tilt %.0f, %s: %.2f of %.2f", s->slant_deg, s->tilt_deg, settings,
                 part, truth);
  task_clear(&t);
  return part;
}

/* Where the plane is seen so flat that what stands on it hides it, copies within it would lay
 * houses and cars down. */
static void what_stands_stays_upright(void) {
  static const street streets[] = {{85, 0, 40}, {84, 25, 50}, {86, 90, 40}, {85, -10, 60}};
  for (int i = 0; i < (int)G_N_ELEMENTS(streets); i++) {
    g_assert_cmpfloat(filled_upright(&streets[i], "surface=auto"), >, .6);
    g_assert_cmpfloat(filled_upright(&streets[i], "surface=auto engine-standing=0"), <, .2);
  }
}

static guint64 bytes_of(const char *horizon) {
  picture image = picture_new(1400, 1000, 3, RECEDE_U8);
  for (gsize i = 0; i < picture_bytes(&image); i++)
    image.pixels[i] = (guint8)(255 * noise_at((int)i, 0, 1));
  task t = task_new(image, "surface=flat engine-iterations=1 quality=draft");
  task_set(&t, horizon);
  task_hole(&t, (area){500, 680, 900, 960});
  task_succeeds(&t);
  guint64 bytes = t.report.peak_bytes;
  task_clear(&t);
  return bytes;
}

/* Sky is not even read: of the 820 rows that a hole of this size looks at 256 are. */
static void sky_takes_no_memory(void) {
  guint64 sky = bytes_of("orientation=horizon horizon=0,660,1399,660"),
          none = bytes_of("orientation=horizon horizon=0,-900,1399,-900");
  g_test_message("%.2f MB, without a sky %.2f", (double)sky / 1e6, (double)none / 1e6);
  g_assert_cmpfloat((double)sky, <, .9 * (double)none);
}

/* What is refused is counted and told, also where it is not read. */
static void all_of_the_sky_is_refused(void) {
  picture image = picture_new(500, 700, 1, RECEDE_U8);
  for (gsize i = 0; i < picture_bytes(&image); i++)
    image.pixels[i] = (guint8)(255 * noise_at((int)i, 0, 1));
  task t = task_new(image, "quality=draft orientation=horizon horizon=0,500,499,500");
  task_hole(&t, (area){220, 20, 260, 620});
  task_succeeds(&t);
  g_assert_cmpuint(t.report.filled_pixels + t.report.refused_pixels, ==, 40 * 600);
  g_assert_cmpuint(t.report.refused_pixels, >=, 40 * 480);
  g_assert_nonnull(strstr(t.report.warning, "beyond the horizon"));
  task_assert_outside(&t);
  for (int y = 20; y < 500; y++)
    for (int x = 220; x < 260; x++)
      g_assert_cmpfloat(picture_get(&t.result, x, y, 0), ==, picture_get(&t.image, x, y, 0));
  task_clear(&t);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/horizon/haze", haze_goes_on);
  test_add_judged("/horizon/standing", what_stands_stays_upright);
  g_test_add_func("/horizon/thin", thin_haze_goes_on);
  g_test_add_func("/horizon/sky", sky_takes_no_memory);
  g_test_add_func("/horizon/refused", all_of_the_sky_is_refused);
  return g_test_run();
}
