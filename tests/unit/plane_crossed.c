/* A joint that crosses the hole, and others that cross it right beside the hole, on drawn ground.
 */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 320
#define HEIGHT 240
#define HALF_WIDTH_PX 1.2
static const area hole = {130, 90, 200, 150};

static double height_of(double slope, double x) { return 120 + slope * (x - 160); }

/* The joint, and one at a right angle to the rows so far from either side of the hole. */
static picture ground(double slope, int beside_px) {
  picture p = picture_new(WIDTH, HEIGHT, 1, RECEDE_U8);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      double value = .3 + .15 * noise_at(x / 2, y / 2, 3);
      double covered = HALF_WIDTH_PX + .5 - fabs(y - height_of(slope, x));
      value += CLAMP(covered, 0, 1) * (.9 - value);
      picture_set(&p, x, y, 0, (float)value);
    }
  picture_fill(&p, (area){hole.x0 - beside_px - 2, 0, hole.x0 - beside_px, HEIGHT}, .9f);
  picture_fill(&p, (area){hole.x1 + beside_px, 0, hole.x1 + beside_px + 2, HEIGHT}, .9f);
  return p;
}

/* In how many of the hole's columns it is broken, or has a piece of another beside it. */
static int columns_wrong(double slope, int beside_px, int seed) {
  task t = task_new(ground(slope, beside_px), "quality=draft orientation=frontal");
  int wrong = 0;
  t.params.seed = seed;
  task_hole(&t, hole);
  task_succeeds(&t);
  for (int x = hole.x0; x < hole.x1; x++) {
    int y = (int)lrint(height_of(slope, x));
    bool above = picture_get(&t.result, x, y - 5, 0) > .6f;
    bool below = picture_get(&t.result, x, y + 5, 0) > .6f;
    wrong += above || below || picture_get(&t.result, x, y, 0) < .65f;
  }
  task_clear(&t);
  return wrong;
}

static void others_stay_where_they_are(void) {
  static const int beside_px[] = {5, 8, 11, 17, 20};
  int wrong = 0, holes = 2 * (int)G_N_ELEMENTS(beside_px);
  for (int n = 0; n < holes; n++) {
    double slope = n % 2 ? .15 : .05;
    int here = columns_wrong(slope, beside_px[n / 2], n);
    g_test_message("slope %.2f, %d px beside the hole: %d", slope, beside_px[n / 2], here);
    wrong += here;
  }
  g_test_message("%d columns of %d holes", wrong, holes);
  g_assert_cmpint(wrong, <=, 3 * holes);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/crossed/joints", others_stay_where_they_are);
  return g_test_run();
}
