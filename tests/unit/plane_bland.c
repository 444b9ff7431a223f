/* What is even fits averages of anything, and must not fill holes for that, through the public
 * interface. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

static const area everything = {0, 0, 1 << 20, 1 << 20};

/* Bright flowers, 8 px across, on a tenth of a lawn. */
static picture lawn(void) {
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  GRand *chance = g_rand_new_with_seed(5);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++)
      picture_set(&p, x, y, 0, (float)g_rand_double_range(chance, .2, .4));
  for (int n = 0; n < 150; n++) {
    int x0 = g_rand_int_range(chance, -4, 320), y0 = g_rand_int_range(chance, -4, 240);
    for (int y = MAX(y0, 0); y < MIN(y0 + 8, 240); y++)
      for (int x = MAX(x0, 0); x < MIN(x0 + 8, 320); x++)
        if (hypot(x - x0 - 3.5, y - y0 - 3.5) < 4) picture_set(&p, x, y, 0, .9f);
  }
  g_rand_free(chance);
  return p;
}

/* How much less contrast holes in a lawn have than the lawn, in octaves: mean over seeds. */
static double flowers_lost(const char *settings) {
  double sum = 0;
  for (int seed = 0; seed < 8; seed++) {
    task t = task_new(lawn(), settings);
    t.params.seed = seed;
    task_hole(&t, (area){100, 70, 220, 170});
    task_succeeds(&t);
    double known = moments_of(&t.image, &t.mask, false, everything, 0).deviation;
    sum += log2(known / moments_of(&t.result, &t.mask, true, everything, 0).deviation) / 8;
    task_clear(&t);
  }
  g_test_message("%s: %.3f octaves of contrast lost", settings, sum);
  return sum;
}

/* Lawn resembles everything: often used sources cost more, and the best of some starts is kept. */
static void flowers_go_on(void) {
  double kept = flowers_lost("orientation=frontal engine-starts=8");
  double bland = flowers_lost("orientation=frontal engine-starts=1 engine-usage=0");
  g_assert_cmpfloat(fabs(kept), <, fabs(bland) - .03);
}

/* Pebbles, dark and bright, and from column 200 on an even wall as bright as they are in the mean.
 */
static picture pebbles_and_wall(void) {
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) {
      double chance = noise_at((x + y / 9 * 5) / 9, y / 9, 3);
      double pebble = chance < .5 ? .2 + .4 * chance : .4 + .4 * chance;
      picture_set(&p, x, y, 0, (float)((x < 200 ? pebble : .5) + .02 * noise_at(x, y, 4)));
    }
  return p;
}

/* The hole filled; copied only from column source_x0 on, 0: from everywhere. */
static task filled(picture image, area hole, const char *settings, int seed, int source_x0) {
  task t = task_new(image, settings);
  t.params.seed = seed;
  task_hole(&t, hole);
  if (source_x0) {
    t.source = picture_new(image.view.width, image.view.height, 1, RECEDE_U8);
    picture_fill(&t.source, (area){source_x0, 0, image.view.width, image.view.height}, 1);
  }
  task_succeeds(&t);
  return t;
}

/* One ground with paler patches, as much of it beside the hole as elsewhere. */
static picture patchy_ground(int n) {
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++)
      picture_set(
          &p, x, y, 0,
          (float)(.5 + .25 * smooth_noise(x, y, 1 / 10., n) + .3 * smooth_noise(x, y, 1, n)));
  return p;
}

/* A texture that fills the picture has places a little unlike all that is beside the hole: they are
 * copied as any others. */
static void patches_are_copied(void) {
  int alike = 0;
  for (int n = 0; n < 12; n++) {
    const area hole = {100, 70, 220, 170};
    task with = filled(patchy_ground(n), hole, "orientation=frontal quality=draft", 0, 0);
    task without =
        filled(patchy_ground(n), hole, "orientation=frontal quality=draft engine-alike=0", 0, 0);
    alike += !memcmp(with.result.pixels, without.result.pixels, picture_bytes(&with.result));
    task_clear(&with);
    task_clear(&without);
  }
  g_test_message("%d of 12 grounds keep all their sources", alike);
  g_assert_cmpint(alike, >=, 7);
}

typedef bool shows(const picture *p, int x, int y);

/* The part of a filled hole, but for so many columns at each end, that shows something. */
static double part_of(picture (*draw)(void), area hole, int columns, const char *settings,
                      int source_x0, shows *is_it) {
  double found = 0, all = 0;
  for (int seed = 0; seed < some_of(2); seed++) {
    task t = filled(draw(), hole, settings, seed, source_x0);
    for (int y = hole.y0; y < hole.y1; y++)
      for (int x = hole.x0 + columns; x < hole.x1 - columns; x++)
        found += is_it(&t.result, x, y), all++;
    task_clear(&t);
  }
  return found / all;
}

static bool is_wall(const picture *p, int x, int y) {
  return fabs(picture_get(p, x, y, 0) - .51) < .02;
}

/* The part of a hole among the pebbles that shows the wall; from_wall: which alone is source. */
static double wall_in_hole(const char *settings, bool from_wall) {
  const area hole = {50, 70, 150, 170};
  double sum = part_of(pebbles_and_wall, hole, 0, settings, from_wall ? 200 : 0, is_wall);
  g_test_message("%s: %.3f of the hole is wall", settings, sum);
  return sum;
}

static void walls_stay_out(void) {
  g_assert_cmpfloat(wall_in_hole("orientation=frontal quality=draft", false), <, .03);
  const char *without = "orientation=frontal quality=draft engine-alike=0 engine-kin=0";
  g_assert_cmpfloat(wall_in_hole(without, false), >, .2);
  g_assert_cmpfloat(wall_in_hole("orientation=frontal quality=draft", true), >, .5);
}

/* Fine sand, and people on it, 4 px wide and 12 high. */
static picture people_on_sand(void) {
  static const int people[][2] = {{20, 30}, {32, 34}, {282, 40}, {292, 196}, {40, 200}, {250, 20}};
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++)
      picture_set(&p, x, y, 0,
                  (float)(.6 + .04 * noise_at(x / 6, y / 2, 6) + .03 * noise_at(x, y, 7)));
  for (guint i = 0; i < G_N_ELEMENTS(people); i++) {
    area at = {people[i][0], people[i][1], people[i][0] + 4, people[i][1] + 12};
    picture_fill(&p, at, .1f);
  }
  return p;
}

static bool is_person(const picture *p, int x, int y) { return picture_get(p, x, y, 0) < .3f; }

/* Whole copies of sand with a person in it fit sand as well as those without. */
static void people_stay_where_they_are(void) {
  const area hole = {90, 60, 230, 180};
  double with = part_of(people_on_sand, hole, 0, "orientation=frontal", 0, is_person);
  double without =
      part_of(people_on_sand, hole, 0, "orientation=frontal engine-spots=0", 0, is_person);
  g_test_message("%.5f of the hole is a person, without the stage %.5f", with, without);
  g_assert_cmpfloat(with, ==, 0);
  g_assert_cmpfloat(without, >, 0);
}

/* Black and white gravel, and people in red on it, so far from the middle. */
static picture people_around(int width, int height, double reach_px) {
  static const double people[][2] = {{-1, -.6}, {-.9, -.5}, {.9, -.6},
                                     {1, .5},   {-.9, .6},  {.6, -.7}};
  picture p = picture_new(width, height, 3, RECEDE_U8);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int k = 0; k < 3; k++)
        picture_set(&p, x, y, k, (float)(.1 + .8 * noise_at(x / 8, y / 6, 16)));
  for (guint i = 0; i < G_N_ELEMENTS(people); i++) {
    int x0 = (int)(width / 2 + reach_px * people[i][0]);
    int y0 = (int)(height / 2 + reach_px * people[i][1]);
    for (int y = y0; y < y0 + 14; y++)
      for (int x = x0; x < x0 + 6; x++)
        for (int k = 0; k < 3; k++) picture_set(&p, x, y, k, k ? .1f : .8f);
  }
  return p;
}
static picture people_on_gravel(void) { return people_around(320, 240, 136); }
static picture people_by_a_small_hole(void) { return people_around(640, 480, 80); }

static bool is_red(const picture *p, int x, int y) {
  return picture_get(p, x, y, 0) > picture_get(p, x, y, 1) + .3f;
}

/* They stand out no more than the stones beside the hole, but have colours of their own. */
static void strangers_stay_where_they_are(void) {
  const area hole = {90, 60, 230, 180};
  const char *settings = "orientation=frontal engine-kin=0";
  const char *off = "orientation=frontal engine-kin=0 engine-spots=0";
  double with = part_of(people_on_gravel, hole, 0, settings, 0, is_red);
  double without = part_of(people_on_gravel, hole, 0, off, 0, is_red);
  g_test_message("%.5f of the hole is a person, without the stage %.5f", with, without);
  g_assert_cmpfloat(with, ==, 0);
  g_assert_cmpfloat(without, >, 0);
}

/* A small hole's levels are large: things are looked for there, too. */
static void strangers_stay_beside_small_holes(void) {
  const area hole = {287, 207, 353, 273};
  const char *settings = "orientation=frontal engine-alike=0 engine-kin=0";
  const char *off = "orientation=frontal engine-alike=0 engine-kin=0 engine-spots=0";
  double with = part_of(people_by_a_small_hole, hole, 0, settings, 0, is_red);
  double without = part_of(people_by_a_small_hole, hole, 0, off, 0, is_red);
  g_test_message("%.5f of the hole is a person, without the stage %.5f", with, without);
  g_assert_cmpfloat(with, ==, 0);
  g_assert_cmpfloat(without, >, 0);
}

/* A green road from row 114 on, a plain strip between it and a hole as wide as the picture, and
 * sky. */
static picture road_far_off(void) {
  picture p = picture_new(400, 300, 3, RECEDE_U8);
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 400; x++)
      for (int k = 0; k < 3; k++) {
        double sky = (k == 2 ? .9 : .7) + .01 * noise_at(x, y, 1);
        double strip = .5 + .05 * noise_at(x, y, 2);
        double road = (k == 0 ? .15 : .25) + (k == 1 ? .5 * noise_at(x / 3, y / 3, 3) : 0);
        picture_set(&p, x, y, k, (float)(y < 100 ? sky : y < 114 ? strip : road));
      }
  return p;
}

/* Near the horizon nothing of the hole's own scales has room for a patch: what there is stays. */
static void something_stays(void) {
  const area hole = {0, 100, 400, 108};
  task t = task_new(road_far_off(), "quality=draft orientation=horizon horizon=0,88,400,88");
  task_hole(&t, hole);
  task_succeeds(&t);
  g_assert_cmpfloat(moments_of(&t.result, &t.mask, true, hole, 1).deviation, >, .03);
  task_clear(&t);
}

/* The same pebbles all over the picture; from column 200 on with a grain that the tone of none
 * betrays. */
static picture near_and_far(void) {
  picture p = picture_new(640, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 640; x++) {
      double pebble = .3 + .4 * noise_at((x + y / 9 * 5) / 9, y / 9, 3);
      double grain = x < 200 ? 0 : (x + y) % 2 ? .05 : -.05;
      picture_set(&p, x, y, 0, (float)(pebble + grain));
    }
  return p;
}

static bool is_grainy(const picture *p, int x, int y) {
  float beside = picture_get(p, x - 1, y, 0) + picture_get(p, x + 1, y, 0);
  return fabsf(picture_get(p, x, y, 0) - beside / 2) > .05f;
}

/* The part of a hole near the left side that is grainy: .13 of pebbles without grain (their edges),
 * .64 of those with it. */
static double far_in_hole(const char *settings, bool from_far) {
  const area hole = {60, 90, 110, 140};
  double sum = part_of(near_and_far, hole, 1, settings, from_far ? 400 : 0, is_grainy);
  g_test_message("%s: %.3f of the hole is grainy", settings, sum);
  return sum;
}

/* What is near goes on as the hole does, unless somebody says otherwise. Each stage sees to that by
 * itself: one does not look far, the other tells the grain from none. */
static void near_goes_on(void) {
  const char *neither = "orientation=frontal engine-near=0 engine-texture=0";
  g_assert_cmpfloat(far_in_hole(neither, false), >, .4);
  g_assert_cmpfloat(far_in_hole("orientation=frontal engine-texture=0", false), <, .2);
  g_assert_cmpfloat(far_in_hole("orientation=frontal engine-near=0", false), <, .2);
  g_assert_cmpfloat(far_in_hole("orientation=frontal", false), <, .2);
  g_assert_cmpfloat(far_in_hole("orientation=frontal", true), >, .55);
}

/* Whatever may be copied lies 120 px away all around: the window holds room for patches. */
static void moat_is_crossed(void) {
  picture p = picture_new(640, 480, 1, RECEDE_U8);
  for (int y = 0; y < 480; y++)
    for (int x = 0; x < 640; x++) picture_set(&p, x, y, 0, (float)noise_at(x / 9, y / 9, 3));
  task t = task_new(p, "orientation=frontal quality=draft");
  task_hole(&t, (area){290, 210, 350, 270});
  t.source = picture_new(640, 480, 1, RECEDE_U8);
  picture_fill(&t.source, (area){0, 0, 640, 480}, 1);
  picture_fill(&t.source, (area){170, 90, 470, 390}, 0);
  task_succeeds(&t);
  double known = moments_of(&t.image, &t.mask, false, everything, 0).deviation;
  g_assert_cmpfloat(moments_of(&t.result, &t.mask, true, everything, 0).deviation, >, .7 * known);
  task_clear(&t);
}

/* A table of light wood, a sheet of paper on it, and a striped carpet below. */
static picture table_and_carpet(void) {
  picture p = picture_new(400, 320, 1, RECEDE_U8);
  for (int y = 0; y < 320; y++)
    for (int x = 0; x < 400; x++) {
      double wood = .68 + .05 * smooth_noise(x / 12., y, 1 / 3., 21) + .01 * noise_at(x, y, 22);
      bool paper = x >= 250 && x < 370 && y >= 20 && y < 140;
      double carpet = (x % 48 < 24 ? .05 : .95) + .02 * noise_at(x, y, 23);
      picture_set(&p, x, y, 0, (float)(y >= 160 ? carpet : paper ? .9 : wood));
    }
  return p;
}

static bool is_paper(const picture *p, int x, int y) { return picture_get(p, x, y, 0) > .8f; }

/* That the carpet repeats says nothing of a hole in the table: what is plain is like itself any
 * period off. */
static void carpets_do_not_stripe_tables(void) {
  const area hole = {50, 30, 190, 130};
  double paper = part_of(table_and_carpet, hole, 0, "orientation=frontal", 0, is_paper);
  g_test_message("%.3f of the hole is paper", paper);
  g_assert_cmpfloat(paper, <, .02);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/bland/flowers", flowers_go_on);
  test_add_judged("/bland/near", near_goes_on);
  g_test_add_func("/bland/moat", moat_is_crossed);
  test_add_judged("/bland/patches", patches_are_copied);
  g_test_add_func("/bland/walls", walls_stay_out);
  g_test_add_func("/bland/carpet", carpets_do_not_stripe_tables);
  g_test_add_func("/bland/people", people_stay_where_they_are);
  g_test_add_func("/bland/strangers", strangers_stay_where_they_are);
  test_add_judged("/bland/small-hole", strangers_stay_beside_small_holes);
  g_test_add_func("/bland/far", something_stays);
  return g_test_run();
}
