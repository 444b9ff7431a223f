/* A solid marking on plain ground goes on through the hole. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define TEXEL_PX 20.
#define PAINT .9
#define MARKING .25

/* What the marking is at right angles to, so many texels off the picture's middle; so many times as
 * wide as others. */
static double cosine, sine, offset, wide = 1;

/* Asphalt with grains and stains of all sizes. */
static double road(double u, double v, int k) {
  double color = .35 + .01 * k;
  for (int n = 0; n < 4; n++) color += .08 * smooth_noise(u, v, 12. / (1 << n), 50 + n);
  return fabs(u * cosine + v * sine - offset) < wide * MARKING / 2 ? PAINT : color;
}

typedef struct scene {
  double slant_deg, tilt_deg, direction_deg;
  area hole;
} scene;

static paint painted(const scene *s, void (*make)(task *t, area hole)) {
  double slant_deg = s->slant_deg, tilt_deg = s->tilt_deg, direction_deg = s->direction_deg;
  area hole = s->hole;
  cosine = cos(direction_deg * G_PI / 180), sine = sin(direction_deg * G_PI / 180);
  picture truth =
      picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, road, TEXEL_PX, slant_deg, tilt_deg);
  task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
  t.params.slant_deg = slant_deg, t.params.tilt_deg = tilt_deg;
  make(&t, hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  paint p = task_paint(&t, &truth, hole);
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("slant %.0f, tilt %.0f, direction %.0f, hole at %d,%d: %.0f of %.0f px", slant_deg,
                 tilt_deg, direction_deg, hole.x0, hole.y0, p.right, p.all);
  return p;
}

static double part_right_in(const scene *scenes, int count, void (*make)(task *t, area hole)) {
  paint sum = {0, 0, 0};
  for (int i = 0; i < count; i++) {
    paint p = painted(&scenes[i], make);
    sum.right += p.right, sum.all += p.all;
  }
  g_test_message("together %.2f", sum.right / sum.all);
  return sum.right / sum.all;
}

static double part_right(const scene *scenes, int count) {
  return part_right_in(scenes, count, task_round_hole);
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

/* One that leads out of the picture is seen beyond the hole only, and all of it there is narrower;
 * a strip of a few px before the picture's end shows too little. */
static void leave_the_picture(void) {
  static const scene scenes[] = {
      {70, 0, 0, {120, 330, 330, HEIGHT}},      {74, 0, 0, {100, 330, 330, HEIGHT}},
      {76, 0, 0, {150, 300, 360, HEIGHT - 4}},  {78, 0, 0, {60, 330, 320, HEIGHT}},
      {80, 0, 0, {100, 350, 330, HEIGHT - 10}}, {82, 0, 0, {120, 360, 330, HEIGHT}},
  };
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    offset = i % 2 ? -5 : -3, wide = i / 2 ? 3 : 1;
    sum += part_right_in(scenes, G_N_ELEMENTS(scenes), task_hole) / 4;
  }
  offset = 0, wide = 1;
  g_test_message("in the mean %.2f", sum);
  g_assert_cmpfloat(sum, >, .7);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/markings/go-on", go_on);
  g_test_add_func("/markings/get-wider", get_wider);
  test_add_judged("/markings/get-narrower", get_narrower);
  test_add_judged("/markings/leave-the-picture", leave_the_picture);
  return g_test_run();
}
