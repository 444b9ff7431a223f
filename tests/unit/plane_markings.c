/* A solid marking on plain ground goes on through the hole. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define TEXEL_PX 20.
#define PAINT .9
#define MARKING .25

/* What the marking is at right angles to, and so many texels off the picture's middle. */
static double cosine, sine, offset;

/* Asphalt with grains and stains of all sizes. */
static double road(double u, double v, int k) {
  double color = .35 + .01 * k;
  for (int n = 0; n < 4; n++) color += .08 * smooth_noise(u, v, 12. / (1 << n), 50 + n);
  return fabs(u * cosine + v * sine - offset) < MARKING / 2 ? PAINT : color;
}

static paint painted(double slant_deg, double tilt_deg, double direction_deg, area hole) {
  cosine = cos(direction_deg * G_PI / 180), sine = sin(direction_deg * G_PI / 180);
  picture truth =
      picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, road, TEXEL_PX, slant_deg, tilt_deg);
  task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
  t.params.slant_deg = slant_deg, t.params.tilt_deg = tilt_deg;
  task_round_hole(&t, hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  paint p = task_paint(&t, &truth, hole);
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("slant %.0f, tilt %.0f, direction %.0f, hole at %d,%d: %.0f of %.0f px", slant_deg,
                 tilt_deg, direction_deg, hole.x0, hole.y0, p.right, p.all);
  return p;
}

typedef struct scene {
  double slant_deg, tilt_deg, direction_deg;
  area hole;
} scene;

static double part_right(const scene *scenes, int count) {
  paint sum = {0, 0, 0};
  for (int i = 0; i < count; i++) {
    const scene *s = &scenes[i];
    paint p = painted(s->slant_deg, s->tilt_deg, s->direction_deg, s->hole);
    sum.right += p.right, sum.all += p.all;
  }
  g_test_message("together %.2f", sum.right / sum.all);
  return sum.right / sum.all;
}

#define SMALL \
  { 280, 220, 360, 320 }
#define MIDDLE \
  { 250, 150, 390, 260 }
#define LARGE \
  { 200, 180, 440, 330 }

/* What crosses the view has one width. Plain ground fits itself better than any marking does. */
static void go_on(void) {
  static const scene scenes[] = {
      {60, 0, 45, MIDDLE}, {60, 45, 120, LARGE}, {60, 90, 15, LARGE}, {70, 0, 165, MIDDLE},
      {70, 0, 120, LARGE}, {70, 45, 15, MIDDLE}, {70, 45, 15, LARGE}, {80, 0, 165, LARGE},
  };
  g_assert_cmpfloat(part_right(scenes, G_N_ELEMENTS(scenes)), >, .8);
}

/* What leads to the viewer is nowhere as wide as in the hole but there. */
static void get_wider(void) {
  static const scene scenes[] = {
      {70, 0, 0, LARGE}, {70, 90, 0, LARGE}, {70, 45, 0, MIDDLE}, {80, 0, 0, LARGE},
      {80, 0, 0, SMALL}, {80, 45, 0, LARGE}, {80, 45, 15, SMALL}, {80, 0, 15, LARGE},
  };
  g_assert_cmpfloat(part_right(scenes, G_N_ELEMENTS(scenes)), >, .7);
}

/* One that leads to the horizon beside the middle is several times narrower at one end of the hole
 * than at the other, and at one end of a run beside it, too. */
static void get_narrower(void) {
  static const scene scenes[] = {
      {76, 0, 0, {120, 110, 300, 240}}, {76, 0, 0, {100, 150, 260, 280}},
      {78, 0, 0, {120, 130, 300, 260}}, {80, 0, 0, {150, 145, 330, 260}},
      {80, 0, 0, {120, 150, 300, 300}}, {80, 0, 0, {60, 150, 240, 300}},
      {82, 0, 0, {160, 170, 340, 270}}, {82, 0, 0, {140, 180, 320, 280}},
      {84, 0, 0, {140, 195, 320, 300}}, {84, 0, 0, {160, 210, 300, 330}},
  };
  double sum = 0;
  for (int i = 0; i < 2; i++) {
    offset = -7 - 3 * i;
    sum += part_right(scenes, G_N_ELEMENTS(scenes)) / 2;
  }
  offset = 0;
  g_test_message("in the mean %.2f", sum);
  g_assert_cmpfloat(sum, >, .7);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/markings/go-on", go_on);
  g_test_add_func("/markings/get-wider", get_wider);
  test_add_judged("/markings/get-narrower", get_narrower);
  return g_test_run();
}
