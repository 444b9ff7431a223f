/* A solid marking on plain ground goes on through the hole, whatever it is beside. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define TEXEL_PX 20.
#define PAINT .9

/* The marking: where it is nearest to the middle, its direction in the plane, its width. */
static double at, cosine, sine, width;

/* Of so many values a texel, smooth between them. */
static double smooth_noise(double u, double v, double per_texel, int n) {
  double x = u * per_texel, y = v * per_texel, fx = x - floor(x), fy = y - floor(y);
  int i = (int)floor(x), j = (int)floor(y);
  double upper = noise_at(i, j, n) * (1 - fx) + noise_at(i + 1, j, n) * fx;
  double lower = noise_at(i, j + 1, n) * (1 - fx) + noise_at(i + 1, j + 1, n) * fx;
  return upper * (1 - fy) + lower * fy - .5;
}

/* Asphalt with grains and stains of all sizes. */
static double road(double u, double v, int k) {
  double color = .35 + .01 * k;
  for (int n = 0; n < 4; n++) color += .08 * smooth_noise(u, v, 12. / (1 << n), 50 + n);
  return fabs(u * cosine + v * sine - at) < width / 2 ? PAINT : color;
}

static paint painted(double slant_deg, double tilt_deg, double direction_deg, double far, area hole,
                     const char *settings) {
  at = far, width = .25;
  cosine = cos(direction_deg * G_PI / 180), sine = sin(direction_deg * G_PI / 180);
  picture truth = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, road, TEXEL_PX, slant_deg, tilt_deg);
  task t = task_new(picture_copy(&truth), settings);
  t.params.slant_deg = slant_deg, t.params.tilt_deg = tilt_deg;
  task_round_hole(&t, hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  paint p = task_paint(&t, &truth, hole);
  if (getenv("OUT")) {
    char name[200];
    g_snprintf(name, 200, "%s/%.0f_%.0f_%.0f_%.1f_%d.pgm", getenv("OUT"), slant_deg, tilt_deg, direction_deg, far, hole.x0);
    FILE *f = fopen(name, "wb");
    fprintf(f, "P5 %d %d 255\n", WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 0; x < WIDTH; x++) fputc((int)(255 * picture_get(&t.result, x, y, 0)), f);
    fclose(f);
  }
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("%s, slant %.0f, tilt %.0f, direction %.0f at %.1f: %.0f of %.0f px", settings, slant_deg, tilt_deg,
                 direction_deg, far, p.right, p.all);
  return p;
}

static void go_on(void) {
  static const area holes[] = {{250, 150, 390, 260}, {200, 180, 440, 330}, {280, 220, 360, 320}};
  for (int slant = 60; slant <= 80; slant += 10)
    for (int tilt = 0; tilt <= 90; tilt += 45)
      for (int direction = 0; direction < 180; direction += 15)
        for (int h = 0; h < 3; h++) painted(slant, tilt, direction, 0, holes[h], "surface=flat quality=normal");
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/markings/go-on", go_on);
  return g_test_run();
}
