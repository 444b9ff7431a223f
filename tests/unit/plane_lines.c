/* Lines through the hole, on drawn floors, through the public interface. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 320
#define HEIGHT 240
#define HALF_WIDTH_PX 1.2
static const area hole = {100, 80, 220, 160};

/* A fine-grained floor with bright lines across it, each y = at + slope x + bend x^2. */
typedef struct drawn {
  double at, slope, bend;
} drawn;

static double height_of(const drawn *line, double x) {
  return line->at + line->slope * x + line->bend * x * x;
}

static picture floor_with(const drawn *lines, int count) {
  picture p = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, grains, 2, 30, 0);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      float value = .3f + .15f * picture_get(&p, x, y, 0);
      for (int i = 0; i < count; i++) {
        double covered = HALF_WIDTH_PX + .5 - fabs(y - height_of(&lines[i], x));
        value += (float)CLAMP(covered, 0, 1) * (.9f - value);
      }
      picture_set(&p, x, y, 0, value);
    }
  return p;
}

/* In how many of the hole's columns the line is bright where it should run. */
static double part_continued(const drawn *line, int seed, const char *settings) {
  task t = task_new(floor_with(line, 1), settings);
  t.params.slant_deg = 30;
  t.params.seed = seed;
  task_hole(&t, hole);
  task_succeeds(&t);
  int bright = 0;
  for (int x = hole.x0; x < hole.x1; x++)
    bright += picture_get(&t.result, x, (int)lrint(height_of(line, x)), 0) > .65f;
  task_clear(&t);
  return (double)bright / (hole.x1 - hole.x0);
}

static double mean_continued(const char *settings) {
  static const drawn lines[] = {
      {120, 0, 0}, {70, .3, 0}, {170, -.3, 0}, {60, .4, 0}, {110, 0, .0001}};
  double sum = 0;
  for (guint i = 0; i < G_N_ELEMENTS(lines); i++) {
    double here = 0;
    for (int seed = 0; seed < 3; seed++) here += part_continued(&lines[i], seed, settings) / 3;
    g_test_message("%s: at %.0f, slope %.1f, bend %.4f: %.2f", settings, lines[i].at,
                   lines[i].slope, lines[i].bend, here);
    sum += here / G_N_ELEMENTS(lines);
  }
  return sum;
}

static void lines_go_on(void) {
  double with = mean_continued("quality=draft"),
         without = mean_continued("quality=draft engine-lines=0");
  g_assert_cmpfloat(with, >, without + .1);
  g_assert_cmpfloat(with, >, .9);
}

/* Two ends that only happen to face each other are not joined. */
static void others_do_not(void) {
  static const drawn line = {120, 0, 0};
  picture p = floor_with(&line, 1), plain = floor_with(&line, 0);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 160; x < WIDTH; x++) picture_set(&p, x, y, 0, picture_get(&plain, x, y, 0));
  picture_clear(&plain);
  task t = task_new(p, "quality=draft surface=flat");
  t.params.slant_deg = 30;
  task_hole(&t, hole);
  task_succeeds(&t);
  for (int x = hole.x1 - 10; x < hole.x1; x++)
    g_assert_cmpfloat(picture_get(&t.result, x, 120, 0), <, .65);
  task_clear(&t);
}

static void same_for_threads(void) {
  static const drawn lines[] = {{95, 0, 0}, {120, .02, 0}, {150, 0, 0}};
  guint64 hash = 0;
  for (int threads = 1; threads <= 3; threads++) {
    /* Of four starts two are with lines, one of these from whole copies. */
    task t = task_new(floor_with(lines, 3), "quality=draft surface=flat engine-starts=4");
    t.params.slant_deg = 30;
    t.host.threads = threads;
    t.host.kernel = threads - 1;
    task_hole(&t, hole);
    task_succeeds(&t);
    if (threads == 1) hash = t.report.output_hash;
    g_assert_cmphex(t.report.output_hash, ==, hash);
    task_clear(&t);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/lines/go-on", lines_go_on);
  g_test_add_func("/lines/others", others_do_not);
  g_test_add_func("/lines/same-bytes", same_for_threads);
  return g_test_run();
}
