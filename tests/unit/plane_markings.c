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

static picture truth_of(const scene *s) {
  cosine = cos(s->direction_deg * G_PI / 180), sine = sin(s->direction_deg * G_PI / 180);
  return picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, road, TEXEL_PX, s->slant_deg, s->tilt_deg);
}

/* Of the part judged of the hole. Clears truth. */
static paint painted_in(const scene *s, picture *truth, void (*make)(task *t, area hole),
                        area judged) {
  task t = task_new(picture_copy(truth), "surface=flat quality=draft");
  t.params.slant_deg = s->slant_deg, t.params.tilt_deg = s->tilt_deg;
  make(&t, s->hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  paint p = task_paint(&t, truth, judged);
  task_clear(&t);
  picture_clear(truth);
  g_test_message("slant %.0f, tilt %.0f, direction %.0f, hole at %d,%d: %.0f of %.0f px",
                 s->slant_deg, s->tilt_deg, s->direction_deg, s->hole.x0, s->hole.y0, p.right,
                 p.all);
  return p;
}

static paint painted(const scene *s, void (*make)(task *t, area hole)) {
  picture truth = truth_of(s);
  return painted_in(s, &truth, make, s->hole);
}

static double part_right_in(const scene *scenes, int count, void (*make)(task *t, area hole)) {
  paint sum = {0, 0, 0};
  for (int i = 0; i < some_of(count); i++) {
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

/* The row of the horizon, of tilt 0. */
static double horizon_of(double slant_deg) {
  return (HEIGHT - 1) / 2. - WIDTH / 2. / tan(25 * G_PI / 180) / tan(slant_deg * G_PI / 180);
}

/* A dark hedge stands on the floor behind the hole: no other end of the marking is seen. Judged is
 * what is no narrower than a fifth of what it is at the hole's foot. */
static paint painted_before_a_hedge(const scene *s) {
  double horizon = horizon_of(s->slant_deg);
  picture truth = truth_of(s);
  area judged = s->hole;
  judged.y0 = (int)ceil(horizon + (judged.y1 - horizon) / 5);
  for (int y = 0; y < s->hole.y0; y++)
    for (int x = 0; x < WIDTH; x++)
      picture_set(&truth, x, y, 0, (float)(.1 + .15 * noise_at(x / 3, y / 3, 60)));
  return painted_in(s, &truth, task_hole, judged);
}

/* Of one that recedes to something that stands on the floor only the near end is seen, here 4 to 50
 * px wide. All of them ended there, at the hole's foot. */
static void recede_to_a_hedge(void) {
  static const struct receding {
    scene scene;
    double offset, wide;
  } all[] = {
      {{80, 0, 0, {240, 128, 400, 350}}, -1, 3},   {{80, 0, 0, {240, 128, 400, 350}}, 2, .4},
      {{82, 0, 0, {200, 150, 400, 340}}, -1.5, 5}, {{82, 0, 0, {260, 150, 420, 360}}, 3, .4},
      {{84, 0, 0, {240, 175, 420, 380}}, 2, 2},    {{84, 0, 0, {200, 175, 380, 380}}, -2, .3},
  };
  double sum = 0;
  for (guint i = 0; i < G_N_ELEMENTS(all); i++) {
    offset = all[i].offset, wide = all[i].wide;
    paint p = painted_before_a_hedge(&all[i].scene);
    sum += p.right / p.all / G_N_ELEMENTS(all);
  }
  offset = 0, wide = 1;
  g_test_message("in the mean %.2f", sum);
  g_assert_cmpfloat(sum, >, .75);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/markings/go-on", go_on);
  test_add_judged("/markings/get-wider", get_wider);
  test_add_judged("/markings/get-narrower", get_narrower);
  test_add_judged("/markings/leave-the-picture", leave_the_picture);
  test_add_judged("/markings/recede", recede_to_a_hedge);
  return g_test_run();
}
