/* What comes again both ways, and is larger than a patch, comes again in the hole. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define TEXEL_PX 16.
/* A pixel is right that is so near to the truth: a square is .5 brighter than the next, a window .4
 * darker than its wall. */
#define NEAR_TRUTH .2

static double stains(double u, double v, double per_texel, int n) {
  return .1 * smooth_noise(u, v, per_texel, n);
}

/* Of a chess board, turned; 6.5 texels wide. */
static double squares(double u, double v, int k) {
  double across = (.94 * u - .34 * v) / 6.5, along = (.34 * u + .94 * v) / 6.5;
  bool white = ((int)floor(across) + (int)floor(along)) & 1;
  return (white ? .75 : .25) + .02 * k + stains(u, v, 1, 7) + stains(u, v, 4, 8);
}

/* In a rough wall: 3 texels wide of 7, 4 high of 9, each pane of its own shade. */
static double windows(double u, double v, int k) {
  double storey = floor(u / 9), column = floor(v / 7), up = u - 9 * storey, right = v - 7 * column;
  double wall = .6 + .03 * k + 1.5 * stains(u, v, 2, 9) + stains(u, v, .7, 10);
  if (up > 4 || right > 3) return wall;
  if (up < .3 || up > 3.7 || right < .3 || right > 2.7) return .9;
  return .15 + .08 * noise_at((int)storey, (int)column, 11) + .02 * k;
}

/* Slabs of all shades, stained, in rows of which every other is half one off; 6 texels by 4. */
static double slabs(double u, double v, int k) {
  double row = floor(u / 4), along = v / 6 + .5 * fmod(fabs(row), 2);
  double in_u = u - 4 * row, in_v = 6 * (along - floor(along));
  if (in_u < .3 || in_v < .3) return .12;
  return .32 + .45 * noise_at((int)row, (int)floor(along), 12) + .02 * k + stains(u, v, .5, 13) +
         2 * stains(u, v, 1.5, 14);
}

/* Dark bars around panes, each of its own shade, stained; a plate lies somewhere on each. */
static double barred(double u, double v, double side, int k) {
  double row = floor(v / side), column = floor(u / side);
  double in_u = u - side * column, in_v = v - side * row, bar = .18 * side;
  double pane = .55 + .25 * noise_at((int)row, (int)column, 15) + .02 * k;
  double plate_u = bar + .5 * side * noise_at((int)row, (int)column, 16);
  double plate_v = bar + .5 * side * noise_at((int)row, (int)column, 17);
  if (in_u < bar || in_v < bar) return .12 + stains(u, v, .7, 18);
  if (in_u > plate_u && in_u < plate_u + .2 * side && in_v > plate_v && in_v < plate_v + .15 * side)
    return pane - .2;
  return pane + stains(u, v, 2, 19);
}
static double bars(double u, double v, int k) { return barred(u + 2, v + 1, 7.5, k); }
/* Of these the picture shows two or three each way. */
static double large_bars(double u, double v, int k) { return barred(u + 2, v + 1, 11.5, k); }

/* Bright stripes of a crossing, 2.4 texels of 4.8, up to where they end; on asphalt. */
static double stripes(double u, double v, int k) {
  double across = u / 4.8 - floor(u / 4.8);
  if (across < .5 && v < 1.5 && v > -9) return .85 + stains(u, v, 3, 20);
  return .25 + .02 * k + stains(u, v, 3, 21) + stains(u, v, .8, 22);
}

typedef struct scene {
  pattern *draw;
  double slant_deg, tilt_deg;
  area hole;
} scene;

static task filled(const scene *s, picture *truth) {
  *truth =
      picture_of_plane(WIDTH, HEIGHT, 3, RECEDE_U8, s->draw, TEXEL_PX, s->slant_deg, s->tilt_deg);
  task t = task_new(picture_copy(truth), "quality=draft");
  t.params.slant_deg = s->slant_deg, t.params.tilt_deg = s->tilt_deg;
  task_round_hole(&t, s->hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  return t;
}

/* The part of the hole. */
static double right_of(const scene *s) {
  double right = 0, all = 0;
  picture truth;
  task t = filled(s, &truth);
  for (int y = s->hole.y0; y < s->hole.y1; y++)
    for (int x = s->hole.x0; x < s->hole.x1; x++) {
      if (!(picture_get(&t.mask, x, y, 0) > .5f)) continue;
      float off = picture_get(&t.result, x, y, 1) - picture_get(&truth, x, y, 1);
      all++, right += fabsf(off) < (float)NEAR_TRUTH;
    }
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("slant %.0f, tilt %.0f, hole at %d,%d: %.3f right", s->slant_deg, s->tilt_deg,
                 s->hole.x0, s->hole.y0, right / all);
  return right / all;
}

/* Of the hole's joints the part that is dark, less that of the rest. */
static double joints_of(const scene *s) {
  double dark[2] = {0, 0}, all[2] = {0, 0};
  picture truth;
  task t = filled(s, &truth);
  for (int y = s->hole.y0; y < s->hole.y1; y++)
    for (int x = s->hole.x0; x < s->hole.x1; x++) {
      if (!(picture_get(&t.mask, x, y, 0) > .5f)) continue;
      int in_joint = picture_get(&truth, x, y, 1) < .16f;
      all[in_joint]++, dark[in_joint] += picture_get(&t.result, x, y, 1) < .2f;
    }
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("slant %.0f, tilt %.0f, hole at %d,%d: %.3f of joints dark, %.3f of the rest",
                 s->slant_deg, s->tilt_deg, s->hole.x0, s->hole.y0, dark[1] / all[1],
                 dark[0] / all[0]);
  return dark[1] / all[1] - dark[0] / all[0];
}

/* Where one square goes on as the next, or a window ends in the wall, .3 to .8 are right. */
static void go_on(const scene *scenes, int count) {
  for (int i = 0; i < some_of(count); i++) g_assert_cmpfloat(right_of(&scenes[i]), >, .95);
}

static double mean_of(const scene *scenes, guint count, double (*of)(const scene *s)) {
  double sum = 0;
  for (guint i = 0; i < count; i++) sum += of(&scenes[i]) / count;
  g_test_message("together %.3f", sum);
  return sum;
}

static void squares_go_on(void) {
  static const scene scenes[] = {
      {squares, 60, -8, {280, 240, 450, 360}},
      {squares, 40, 90, {240, 180, 380, 320}},
      {squares, 55, -20, {260, 210, 420, 330}},
      {squares, 50, -15, {200, 240, 370, 360}},
  };
  go_on(scenes, G_N_ELEMENTS(scenes));
}

static void windows_go_on(void) {
  static const scene scenes[] = {
      {windows, 40, -95, {200, 180, 330, 300}},
      {windows, 0, 0, {250, 160, 390, 280}},
      {windows, 30, -80, {240, 160, 400, 300}},
      {windows, 50, -90, {260, 180, 420, 340}},
  };
  go_on(scenes, G_N_ELEMENTS(scenes));
}

static void slabs_go_on(void) {
  static const scene scenes[] = {
      {slabs, 0, 0, {250, 160, 390, 280}},     {slabs, 40, 90, {240, 180, 380, 320}},
      {slabs, 55, -20, {260, 210, 420, 330}},  {slabs, 50, -15, {200, 240, 370, 360}},
      {slabs, 30, -100, {240, 160, 400, 300}}, {slabs, 60, 30, {280, 220, 430, 340}},
  };
  g_assert_cmpfloat(mean_of(scenes, G_N_ELEMENTS(scenes), joints_of), >, .81);
}

static void bars_go_on(void) {
  static const scene scenes[] = {
      {bars, 0, 0, {250, 160, 390, 280}},          {bars, 40, 90, {240, 180, 380, 320}},
      {bars, 50, -15, {200, 200, 370, 330}},       {bars, 55, 40, {240, 200, 400, 330}},
      {large_bars, 0, 0, {230, 160, 390, 300}},    {large_bars, 30, 20, {220, 160, 390, 310}},
      {large_bars, 40, -60, {240, 150, 400, 300}},
  };
  /* .92 where a bar ends or a pane has one too many. */
  g_assert_cmpfloat(mean_of(scenes, G_N_ELEMENTS(scenes), right_of), >, .955);
}

static void stripes_go_on(void) {
  static const scene scenes[] = {
      {stripes, 40, 0, {280, 150, 420, 260}},
      {stripes, 55, 10, {330, 180, 640, 280}},
      {stripes, 50, -20, {480, 150, 640, 270}},
      {stripes, 60, 0, {500, 180, 640, 300}},
  };
  /* .96 where they end early. */
  g_assert_cmpfloat(mean_of(scenes, G_N_ELEMENTS(scenes), right_of), >, .98);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/regular/squares", squares_go_on);
  g_test_add_func("/regular/windows", windows_go_on);
  test_add_judged("/regular/slabs", slabs_go_on);
  test_add_judged("/regular/bars", bars_go_on);
  g_test_add_func("/regular/stripes", stripes_go_on);
  return g_test_run();
}
