/* Detail that coarse levels do not show by colour: which way it runs, and how strong it is. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 300
#define HEIGHT 220
#define SLANT_DEG 30

static const area hole = {105, 75, 195, 145}, everything = {0, 0, WIDTH, HEIGHT};

/* 1 for squares whose strips run along u. */
static double runs_along(double u, double v, int k) {
  (void)k;
  return fmod(floor(u) + floor(v) + 1000, 2);
}

/* Four strips in each square, of shades that say nothing of the square: every square is as bright
 * as the others, and its neighbours' strips run the other way. */
static double parquet(double u, double v, int k) {
  double across = 4 * (runs_along(u, v, k) > 0 ? v - floor(v) : u - floor(u));
  int square = (int)floor(u) * 57 + (int)floor(v) * 91, strip = (int)across;
  double joint = across - strip < .25 ? .35 : 0;
  return .5 + .2 * noise_at(square, strip, k / 3) - joint;
}

/* How much more brightness changes down than across in squares that run along u than in the others,
 * 0 where it is the same and 1 where there is nothing else. */
static double order(const picture *p, const picture *squares, const picture *mask, bool inside) {
  double down = 0, across = 0;
  for (int y = everything.y0; y + 1 < everything.y1; y++)
    for (int x = everything.x0; x + 1 < everything.x1; x++) {
      if ((picture_get(mask, x, y, 0) > 0) != inside) continue;
      double sign = 2 * picture_get(squares, x, y, 0) - 1, at = picture_get(p, x, y, 0);
      double by_y = fabs(picture_get(p, x, y + 1, 0) - at);
      double by_x = fabs(picture_get(p, x + 1, y, 0) - at);
      down += sign * (by_y - by_x), across += by_y + by_x;
    }
  return down / across;
}

/* The hole's order as a part of what is around it. */
static double order_kept(const char *settings) {
  double inside = 0, outside = 0;
  picture squares = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, runs_along, 22, SLANT_DEG, 0);
  int seeds = some_of(4);
  for (int seed = 0; seed < seeds; seed++) {
    picture p = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, parquet, 22, SLANT_DEG, 0);
    task t = task_new(p, settings);
    t.params.slant_deg = SLANT_DEG, t.params.seed = seed;
    task_hole(&t, hole);
    task_succeeds(&t);
    inside += order(&t.result, &squares, &t.mask, true);
    outside += order(&t.image, &squares, &t.mask, false);
    task_clear(&t);
  }
  g_test_message("%s: order %.3f, around the hole %.3f", settings, inside / seeds, outside / seeds);
  picture_clear(&squares);
  return inside / outside;
}

static void parquet_goes_on(void) {
  double with = order_kept(""), without = order_kept("engine-texture=0");
  g_assert_cmpfloat(with, >, .85);
  g_assert_cmpfloat(without, <, with - .15);
}

/* Round stones, each of one colour, on dark ground. */
static double stones(double u, double v, int k) {
  for (int j = -1; j <= 1; j++)
    for (int i = -1; i <= 1; i++) {
      int x = (int)floor(u) + i, y = (int)floor(v) + j;
      double dx = u - x - .2 - .6 * noise_at(x, y, 1), dy = v - y - .2 - .6 * noise_at(x, y, 2);
      if (hypot(dx, dy) < .3 + .15 * noise_at(x, y, 3)) return .45 + .5 * noise_at(x, y, 4 + k);
    }
  return .1;
}

#define STONE_PX 26.
#define LEAST_STONE_PX 7 /* of the radii */

static bool is_stone(const picture *p, int x, int y) { return picture_get(p, x, y, 0) > .3f; }

/* Whether the smallest of all stones fits in here. */
static bool fits(const picture *p, int x, int y) {
  for (int j = -LEAST_STONE_PX; j <= LEAST_STONE_PX; j++)
    for (int i = -LEAST_STONE_PX; i <= LEAST_STONE_PX; i++)
      if (i * i + j * j <= LEAST_STONE_PX * LEAST_STONE_PX && !is_stone(p, x + i, y + j))
        return false;
  return true;
}

static bool in_a_whole_stone(const picture *p, int x, int y) {
  for (int j = -LEAST_STONE_PX; j <= LEAST_STONE_PX; j++)
    for (int i = -LEAST_STONE_PX; i <= LEAST_STONE_PX; i++)
      if (i * i + j * j <= LEAST_STONE_PX * LEAST_STONE_PX && fits(p, x + i, y + j)) return true;
  return false;
}

static const area pit = {150, 105, 270, 215};

static bool same_colour(const picture *p, int x, int y, int other_x, int other_y) {
  for (int k = 0; k < 3; k++)
    if (fabsf(picture_get(p, x, y, k) - picture_get(p, other_x, other_y, k)) > 2.5f / 255)
      return false;
  return true;
}

/* Whether the hole shows the same stone elsewhere, too. */
static bool comes_again(const picture *p, int x, int y) {
  for (int j = pit.y0; j < pit.y1; j++)
    for (int i = pit.x0; i < pit.x1; i++)
      if (hypot(i - x, j - y) > STONE_PX && same_colour(p, x, y, i, j)) return true;
  return false;
}

/* Which part of what is stone, away from the hole's border, is chips and tails, and which comes
 * more than once. */
static void judge_stones(const char *settings, double *chips, double *repeated) {
  const area inner = {162, 117, 258, 203};
  double stone = 0;
  *chips = *repeated = 0;
  for (int seed = 0; seed < 6; seed++) {
    picture p = picture_new(420, 320, 3, RECEDE_U8);
    for (int y = 0; y < 320; y++)
      for (int x = 0; x < 420; x++)
        for (int k = 0; k < 3; k++)
          picture_set(&p, x, y, k, (float)stones(x / STONE_PX + 40 * seed, y / STONE_PX, k));
    task t = task_new(p, settings);
    task_set(&t, "orientation=frontal");
    task_hole(&t, pit);
    task_succeeds(&t);
    for (int y = inner.y0; y < inner.y1; y++)
      for (int x = inner.x0; x < inner.x1; x++) {
        if (!is_stone(&t.result, x, y)) continue;
        stone++, *chips += !in_a_whole_stone(&t.result, x, y);
        *repeated += comes_again(&t.result, x, y);
      }
    task_clear(&t);
  }
  *chips /= stone, *repeated /= stone;
  g_test_message("%s: %.3f of the stones are chips, %.3f come again", settings, *chips, *repeated);
}

static void stones_stay_whole(void) {
  double chips, repeated, chips_without, repeated_without, chips_best, repeated_best;
  judge_stones("", &chips, &repeated);
  judge_stones("engine-cuts=0", &chips_without, &repeated_without);
  judge_stones("quality=best", &chips_best, &repeated_best);
  g_assert_cmpfloat(chips, <, .6 * chips_without);
  g_assert_cmpfloat(repeated, <, .5 * repeated_without);
  g_assert_cmpfloat(chips_best, <, .9 * chips);
  g_assert_cmpfloat(repeated_best, <, .03);
}

/* Stripes as regular as any grid of samples, which must not see one of their two shades alone. */
static void stripes_go_on(void) {
  const area middle = {270, 270, 338, 338};
  picture p = picture_new(600, 600, 1, RECEDE_U8);
  for (int y = 0; y < 600; y++)
    for (int x = 0; x < 600; x++) picture_set(&p, x, y, 0, x / 2 % 2 ? .7f : .3f);
  task t = task_new(p, "orientation=frontal surface=flat");
  picture truth = picture_copy(&t.image);
  task_hole(&t, middle);
  picture_fill(&t.image, middle, 0);
  task_succeeds(&t);
  double psnr = masked_psnr(&t.result, &truth, &t.mask);
  g_test_message("stripes: %.1f dB", psnr);
  g_assert_cmpfloat(psnr, >, 40);
  picture_clear(&truth);
  task_clear(&t);
}

#define TILE_PX 26.

/* Tiles of shades of their own, laid in arcs: in no direction does a row go on straight, and no
 * copy of more than two tiles fits elsewhere. *joint: how deep in one, 0 .. 1. */
static double tile_at(int x, int y, double *joint) {
  double u = (x - 256) / TILE_PX, v = (y - 256) / (.8 * TILE_PX);
  double across = u + .8 * v * v / 64, along = v + .64 * u * u / 64;
  double du = .5 - fabs(across - floor(across) - .5), dv = .5 - fabs(along - floor(along) - .5);
  *joint = exp(-pow(fmin(du / .07, dv / .085), 2));
  return .55 + .12 * noise_at((int)floor(across), (int)floor(along), 51) - .4 * *joint;
}

/* The part of the hole's joints that is dark. */
static double joints_kept(const char *settings) {
  const area middle = {186, 201, 326, 311};
  double kept = 0, all = 0, joint;
  for (int seed = 0; seed < 3; seed++) {
    picture p = picture_new(512, 512, 1, RECEDE_U8);
    for (int y = 0; y < 512; y++)
      for (int x = 0; x < 512; x++)
        picture_set(&p, x, y, 0, (float)(tile_at(x, y, &joint) + .05 * noise_at(x, y, 52)));
    task t = task_new(p, settings);
    task_set(&t, "orientation=frontal");
    t.params.seed = seed;
    task_hole(&t, middle);
    task_succeeds(&t);
    for (int y = middle.y0; y < middle.y1; y++)
      for (int x = middle.x0; x < middle.x1; x++) {
        tile_at(x, y, &joint);
        if (joint > .6) all++, kept += picture_get(&t.result, x, y, 0) < .4f;
      }
    task_clear(&t);
  }
  g_test_message("%s: %.3f of the joints", settings, kept / all);
  return kept / all;
}

static void arcs_go_on(void) {
  double with = joints_kept(""), without = joints_kept("engine-lattice=0");
  g_assert_cmpfloat(with, >, .68);
  g_assert_cmpfloat(with, >, without + .1);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/texture/parquet", parquet_goes_on);
  test_add_judged("/texture/stones", stones_stay_whole);
  g_test_add_func("/texture/stripes", stripes_go_on);
  test_add_judged("/texture/arcs", arcs_go_on);
  return g_test_run();
}
