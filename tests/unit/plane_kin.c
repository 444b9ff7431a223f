/* Of several things, in several lights or out of focus, what lies beside the hole there goes on,
 * through the public interface. */
#include <math.h>

#include "plane_scene.h"

static task filled(picture image, area hole, const char *settings, int seed) {
  task t = task_new(image, settings);
  t.params.seed = seed;
  task_hole(&t, hole);
  task_succeeds(&t);
  return t;
}

/* Heaps all over the ground but around a hole, which one heap reaches into from the left. */
static bool is_heap(int x, int y, int apart) {
  const area bare = {70, 40, 290, 200};
  int across = (x + 32) % apart - 26, down = (y + 14) % 52 - 26;
  if (x >= bare.x0 && x < bare.x1 && y >= bare.y0 && y < bare.y1)
    return abs(x - 75) < 22 && abs(y - 120) < 22;
  return across * across + down * down < 22 * 22;
}

/* Of red leaves on a lawn. */
static picture leaves_on_a_lawn(void) {
  picture p = picture_new(520, 240, 3, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 520; x++) {
      bool here = is_heap(x, y, 52);
      double red = here ? .6 : .25, green = here ? .2 : .5, grain = .15 * noise_at(x / 2, y / 2, 8);
      picture_set(&p, x, y, 0, (float)(red + grain));
      picture_set(&p, x, y, 1, (float)(green + grain));
      picture_set(&p, x, y, 2, (float)(.1 + grain));
    }
  return p;
}

/* Of straw that lies one way, as bright as the gravel under it and of no other contrast. */
static picture straw_on_gravel(void) {
  picture p = picture_new(520, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 520; x++) {
      double grain = noise_at(x / 3, y / 3, 8), straw = noise_at(x / 60, y / 3, 9);
      picture_set(&p, x, y, 0, (float)(.2 + .6 * (is_heap(x, y, 64) ? straw : grain)));
    }
  return p;
}

static bool is_red(const picture *p, int x, int y) {
  return picture_get(p, x, y, 0) > picture_get(p, x, y, 1) + .3f;
}

static bool is_straw(const picture *p, int x, int y) {
  for (int i = 1; i < 9; i++)
    if (fabsf(picture_get(p, x + i, y, 0) - picture_get(p, x, y, 0)) > .03f) return false;
  return true;
}

/* The part of the hole's end away from the heap that it shows. */
static double heap_far_off(picture draw(void), const char *settings,
                           bool belongs(const picture *p, int x, int y)) {
  const area hole = {90, 60, 240, 180};
  double found = 0;
  for (int seed = 0; seed < 4; seed++) {
    task t = filled(draw(), hole, settings, seed);
    for (int y = hole.y0; y < hole.y1; y++)
      for (int x = hole.x1 - 60; x < hole.x1; x++) found += belongs(&t.result, x, y);
    task_clear(&t);
  }
  g_test_message("%s: %.4f of the far end shows what lies at the other", settings,
                 found / (4 * 60 * 120));
  return found / (4 * 60 * 120);
}

/* A heap that lies beside the hole is no stranger; but where it does not lie none is wanted. Of
 * straw, which differs in nothing but its grain, a little comes. */
static void things_stay_on_their_side(void) {
  const char *with = "orientation=frontal", *without = "orientation=frontal engine-kin=0";
  double leaves = heap_far_off(leaves_on_a_lawn, without, is_red);
  double straw = heap_far_off(straw_on_gravel, without, is_straw);
  g_assert_cmpfloat(leaves, >, .1);
  g_assert_cmpfloat(straw, >, .1);
  g_assert_cmpfloat(heap_far_off(leaves_on_a_lawn, with, is_red), <, .005);
  g_assert_cmpfloat(heap_far_off(straw_on_gravel, with, is_straw), <, .25 * straw);
}

/* A dark wood of all sorts of things behind an even road, on which somebody in dark clothes stands
 * to the left of the hole and of nothing else. */
static picture a_walker_before_a_wood(void) {
  picture p = picture_new(480, 420, 3, RECEDE_U8);
  for (int y = 0; y < 420; y++)
    for (int x = 0; x < 480; x++) {
      bool walker = x >= 60 && x < 120 && y >= 130 && y < 360;
      double fine = noise_at(x / 2, y / 2, 8), wood = noise_at(x / 20, y / 20, 9);
      for (int k = 0; k < 3; k++) {
        double tree = .6 * wood * noise_at(x / 6, y / 6, 10 + k), road = .6 + .06 * fine;
        double cloth = (y < 200 ? .25 : .15) + .1 * noise_at(x / 4, y / 4, 15);
        picture_set(&p, x, y, k, (float)(walker ? cloth : y < 170 ? tree : road));
      }
    }
  return p;
}

/* What lies beside the hole above differs so much in itself that clothes look no odder; beside the
 * road below they do. */
static void nobody_is_copied_onto_a_road(void) {
  const area hole = {200, 90, 340, 330};
  double dark = 0;
  int seeds = some_of(4);
  for (int seed = 0; seed < seeds; seed++) {
    task t = filled(a_walker_before_a_wood(), hole, "orientation=frontal", seed);
    for (int y = 200; y < hole.y1; y++)
      for (int x = hole.x0; x < hole.x1; x++) dark += picture_get(&t.result, x, y, 1) < .4f;
    task_clear(&t);
  }
  dark /= seeds * 130 * 140;
  g_test_message("%.4f of the road is dark", dark);
  g_assert_cmpfloat(dark, <, .01);
}

/* Rough ground in focus from row 150 to 250, and more and more out of it above and below. */
static picture ground_in_focus_between(void) {
  picture sharp = picture_new(480, 400, 1, RECEDE_U8), p = picture_new(480, 400, 1, RECEDE_U8);
  for (int y = 0; y < 400; y++)
    for (int x = 0; x < 480; x++) {
      double v = 0;
      for (int px = 2; px <= 32; px *= 2) v += noise_at(x / px, y / px, px) / 5;
      picture_set(&sharp, x, y, 0, (float)v);
    }
  for (int y = 0; y < 400; y++)
    for (int x = 0; x < 480; x++) {
      int reach = MIN(MAX(MAX(150 - y, y - 250), 0) / 6, 8), count = 0;
      double sum = 0;
      for (int j = MAX(y - reach, 0); j <= MIN(y + reach, 399); j++)
        for (int i = MAX(x - reach, 0); i <= MIN(x + reach, 479); i++)
          sum += picture_get(&sharp, i, j, 0), count++;
      picture_set(&p, x, y, 0, (float)(sum / count));
    }
  picture_clear(&sharp);
  return p;
}

/* Mean of the steps from pixel to pixel. */
static double step_in(const picture *p, area a) {
  double sum = 0;
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x + 1 < a.x1; x++)
      sum += fabs(picture_get(p, x + 1, y, 0) - picture_get(p, x, y, 0));
  return sum / ((a.y1 - a.y0) * (a.x1 - a.x0 - 1));
}

/* How sharp the hole's content is, in units of what was there: mean over seeds. */
static double sharpness(const char *settings) {
  const area hole = {190, 150, 290, 250};
  double sum = 0;
  for (int seed = 0; seed < 3; seed++) {
    picture truth = ground_in_focus_between();
    task t = filled(picture_copy(&truth), hole, settings, seed);
    sum += step_in(&t.result, hole) / step_in(&truth, hole) / 3;
    picture_clear(&truth);
    task_clear(&t);
  }
  g_test_message("%s: %.2f as sharp as what was there", settings, sum);
  return sum;
}

/* What is out of focus looks like another thing, too. */
static void what_is_in_focus_stays_so(void) {
  double with = sharpness("orientation=frontal engine-kin=0");
  g_assert_cmpfloat(sharpness("orientation=frontal"), >, .72);
  g_assert_cmpfloat(with, >, .72);
  g_assert_cmpfloat(sharpness("orientation=frontal engine-focus=0 engine-kin=0"), <, with - .1);
}

/* Ground that gets darker downwards, and lighter again, and a dark post beside the hole. */
static double ground_at(int x, int y) {
  return x >= 100 && x < 130 && y >= 40 && y < 260 ? .3 : .5 + .2 * sin(y / 40.);
}

static picture layered_ground(void) {
  picture p = picture_new(420, 300, 1, RECEDE_U8);
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 420; x++) {
      double grain = smooth_noise(x, y, .15, 7) + .5 * (noise_at(x, y, 8) - .5);
      picture_set(&p, x, y, 0, (float)(ground_at(x, y) + .6 * grain));
    }
  return p;
}

/* How far, in the mean of squares, squares of 30 px of a hole beside the post are from what the
 * ground is as high as they lie. */
static double off_layers(const char *settings, int seed) {
  const area hole = {130, 60, 310, 240};
  double sum = 0;
  task t = filled(layered_ground(), hole, settings, seed);
  for (int y = hole.y0; y < hole.y1; y += 30)
    for (int x = hole.x0; x < hole.x1; x += 30) {
      double mean = moments_of(&t.result, &t.mask, true, (area){x, y, x + 30, y + 30}, 0).mean;
      sum += pow(mean - ground_at(x + 15, y + 15), 2) / 36;
    }
  task_clear(&t);
  g_test_message("%s, seed %d: %.3f", settings, seed, sqrt(sum));
  return sqrt(sum);
}

static void layers_stay_as_high_as_they_lie(void) {
  double with = 0, without = 0;
  for (int seed = 0; seed < 4; seed++) {
    with += off_layers("quality=draft orientation=frontal", seed) / 4;
    without += off_layers("quality=draft orientation=frontal engine-layers=0", seed) / 4;
  }
  g_assert_cmpfloat(with, <, .05);
  g_assert_cmpfloat(without, >, .06);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/kin/things", things_stay_on_their_side);
  test_add_judged("/kin/layers", layers_stay_as_high_as_they_lie);
  g_test_add_func("/kin/walker", nobody_is_copied_onto_a_road);
  test_add_judged("/kin/focus", what_is_in_focus_stays_so);
  return g_test_run();
}
