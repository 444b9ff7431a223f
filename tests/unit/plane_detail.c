/* A fill has the detail of what lies around, or of what it is copied from where that is something
 * else, through the public interface. */
#include <math.h>

#include "plane_scene.h"

/* The middle of the hole. */
static const area inner = {124, 94, 196, 146};

typedef double brightness(int x, int y);

static double grit(int x, int y, double contrast) {
  return contrast * (noise_at(x / 2, y / 2, 3) - .5);
}

static picture scene_of(brightness *at) {
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) picture_set(&p, x, y, 0, (float)at(x, y));
  return p;
}

/* The contrast in part of the hole, of what that part has without one; mean of some seeds. */
static double contrast_kept(picture scene, area part, const char *settings) {
  double sum = 0;
  int seeds = some_of(4);
  for (int seed = 0; seed < seeds; seed++) {
    task t = task_new(picture_copy(&scene), settings);
    t.params.seed = seed;
    task_hole(&t, (area){120, 90, 200, 150});
    task_succeeds(&t);
    double there = moments_of(&t.result, &t.mask, true, part, 0).deviation;
    sum += there / moments_of(&scene, &t.mask, true, part, 0).deviation / seeds;
    task_clear(&t);
  }
  picture_clear(&scene);
  g_test_message("%s: %.3f of the contrast", settings, sum);
  return sum;
}

static double ground_among_gravel(int x, int y) {
  bool is_ground = x >= 100 && x < 220 && y >= 70 && y < 170;
  return .5 + grit(x, y, is_ground ? .06 : .6);
}

/* Even ground among gravel, which is most of what lies around, stays even. */
static void even_ground_stays_even(void) {
  double kept = contrast_kept(scene_of(ground_among_gravel), inner, "orientation=frontal");
  g_assert_cmpfloat(fabs(log2(kept)), <, .2);
}

static double crack_in_ground(int x, int y) {
  return y / 2 == 60 ? .25 + grit(x, y, .4) : .5 + grit(x, y, .06);
}

/* A crack that crosses the hole is not weakened because there is little else like it around. */
static void cracks_keep_their_contrast(void) {
  const area crack = {124, 120, 196, 122};
  const char *settings = "orientation=frontal", *without = "orientation=frontal engine-detail=0";
  picture scene = scene_of(crack_in_ground);
  double bare = contrast_kept(picture_copy(&scene), crack, without);
  g_assert_cmpfloat(contrast_kept(scene, crack, settings), >, .97 * bare);
}

/* Sampling between pixels and joining copies takes detail away, which is made up for. */
static void blur_is_made_up_for(void) {
  const char *settings = "slant=50 tilt=0", *without = "slant=50 tilt=0 engine-detail=0";
  picture floor = picture_of_plane(320, 240, 1, RECEDE_U8, grains, 2.5, 50, 0);
  double bare = contrast_kept(picture_copy(&floor), inner, without);
  double kept = contrast_kept(floor, inner, settings);
  g_assert_cmpfloat(bare, <, .95);
  g_assert_cmpfloat(fabs(log2(kept)), <, fabs(log2(bare)) / 2);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/detail/even", even_ground_stays_even);
  test_add_judged("/detail/crack", cracks_keep_their_contrast);
  test_add_judged("/detail/blur", blur_is_made_up_for);
  return g_test_run();
}
