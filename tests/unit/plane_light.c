/* What of a picture is no light, though brightness and colour drift by it. */
#include <math.h>

#include "plane_scene.h"

/* A grey floor, and a sky that gets bluer upwards, down to row 90. */
static picture floor_under_sky(void) {
  picture p = picture_new(320, 240, 3, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++)
      for (int k = 0; k < 3; k++) {
        double floor = .3 + .2 * noise_at(x, y, 7);
        double sky =
            (k == 2 ? .9 : .6) - (k == 2 ? .001 : .004) * (90 - y) + .02 * noise_at(x, y, 8);
        picture_set(&p, x, y, k, (float)(y < 90 ? sky : floor));
      }
  return p;
}

/* A horizon set too high puts the sky on the plane: the floor's light is none of its. */
static void sky_tints_no_floor(void) {
  const area hole = {0, 120, 320, 200};
  task t = task_new(floor_under_sky(), "quality=draft orientation=horizon horizon=0,-30,320,-30");
  task_hole(&t, hole);
  task_succeeds(&t);
  double red = moments_of(&t.result, &t.mask, true, hole, 0).mean;
  double blue = moments_of(&t.result, &t.mask, true, hole, 2).mean;
  g_test_message("red %.4f, blue %.4f", red, blue);
  g_assert_cmpfloat(fabs(blue - red), <, .01);
  task_clear(&t);
}

/* A pavement that becomes a road to the right, and water where it is far; or a pavement alone, in
 * light that grows to the right. */
static picture pavement(bool alone) {
  static const double greys[3] = {.62, .38, .25}; /* as of a photo without colours */
  picture p = picture_new(320, 240, 3, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) {
      double water = alone ? 0 : fmin(fmax((95 - y) / 50., 0), 1);
      double road = alone ? 0 : fmin(fmax((x + y / 2 - 210) / 80., 0), 1);
      double light = alone ? .5 + x / 320. : 1, grain = .12 * (noise_at(x / 2, y / 2, 11) - .5);
      double ground = greys[0] + road * (greys[1] - greys[0]);
      double grey = ground + water * (greys[2] - ground);
      for (int k = 0; k < 3; k++) picture_set(&p, x, y, k, (float)(light * (grey + grain)));
    }
  return p;
}

/* What differs most in any channel between what a picture is extended by and what it has beside
 * that. */
static double tint_beyond(bool alone, area filled, area beside) {
  double most = 0;
  task t = task_new(pavement(alone), "quality=draft orientation=frontal");
  task_hole(&t, (area){0, 0, 60, 240});
  picture_fill(&t.mask, (area){0, 190, 320, 240}, 1);
  task_succeeds(&t);
  for (int k = 0; k < 3; k++)
    most = fmax(most, fabs(moments_of(&t.result, &t.mask, true, filled, k).mean -
                           moments_of(&t.result, &t.mask, false, beside, k).mean));
  task_clear(&t);
  return most;
}

/* Of a picture that is extended the things it shows make no light; light does. */
static void things_tint_nothing_beyond(void) {
  static const area corner = {0, 190, 60, 240}, left = {0, 80, 60, 180},
                    bottom = {70, 192, 110, 236};
  double things = fmax(tint_beyond(false, corner, (area){60, 150, 120, 190}),
                       tint_beyond(false, left, (area){60, 80, 100, 180}));
  double light = fmax(tint_beyond(true, left, (area){60, 80, 66, 180}),
                      tint_beyond(true, bottom, (area){70, 150, 110, 190}));
  g_test_message("by things %.3f, in light that drifts %.3f", things, light);
  g_assert_cmpfloat(things, <, .01);
  g_assert_cmpfloat(light, <, .02);
}

/* Even from one lattice point, 24 px apart, to the next. */
static double blotches_at(int x, int y, int n) {
  int i = x / 24, j = y / 24;
  double s = x / 24. - i, t = y / 24. - j;
  return (1 - t) * ((1 - s) * noise_at(i, j, n) + s * noise_at(i + 1, j, n)) +
         t * ((1 - s) * noise_at(i, j + 1, n) + s * noise_at(i + 1, j + 1, n));
}

/* A lawn with patches of red flowers, ever more to the right. */
static picture lawn(int n) {
  static const double green[3] = {.3, .5, .2}, red[3] = {.7, .2, .16};
  picture p = picture_new(320, 240, 3, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) {
      double part = fmin(fmax(6 * (blotches_at(x, y, n) + .6 * x / 320 - .85) + .5, 0), 1);
      double grain = .1 * (noise_at(x / 2, y / 2, 11) - .5);
      for (int k = 0; k < 3; k++)
        picture_set(&p, x, y, k, (float)(green[k] + part * (red[k] - green[k]) + grain));
    }
  return p;
}

/* Of the lawn, masked or not, the part that is no pure green. */
static double tinted(const picture *p, const picture *mask, bool inside) {
  double tints = 0, count = 0;
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) {
      double hue = picture_get(p, x, y, 0) / fmax(picture_get(p, x, y, 1), .01);
      if ((picture_get(mask, x, y, 0) > .5f) == inside && hue < .9) count++, tints += hue > .66;
    }
  return tints / count;
}

/* Red flowers do not make the lawn beside them reddish: that is no light. */
static void colours_are_no_light(void) {
  double most = 0;
  for (int n = 0; n < some_of(4); n++) {
    task t = task_new(lawn(20 + n), "quality=draft orientation=frontal");
    task_hole(&t, (area){90, 60, 200, 180});
    task_succeeds(&t);
    double got = tinted(&t.result, &t.mask, true), known = tinted(&t.result, &t.mask, false);
    g_test_message("%d: tinted %.3f of the hole, %.3f beside it", n, got, known);
    most = fmax(most, got - known);
    task_clear(&t);
  }
  g_assert_cmpfloat(most, <, .15);
}

/* Leads to the middle of the horizon, in such a row, and is so many px wide to each side and so
 * many boards long, as seen, at the picture's lower end. */
typedef struct pier {
  int horizon;
  double half_px, boards;
} pier;

/* A board's brightness, dark at its joint; negative beside the pier. */
static double board_at(const pier *p, double x, double y) {
  double near = fmax(y - p->horizon, .01) / (300 - p->horizon), board = p->boards / near;
  if (fabs(x - 200) > near * p->half_px) return -1;
  return .12 * (.8 + .4 * noise_at((int)board, 0, 5)) * (board - floor(board) < .12 ? .4 : 1);
}

/* A dark pier in water whose light drifts, under the sky. */
static picture pier_in_water(const pier *p) {
  picture drawn = picture_new(400, 300, 1, RECEDE_U8);
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 400; x++) {
      double water = .6 - .001 * y + .03 * (noise_at(x / 4, y, 7) - .5), sum = 0;
      for (int i = 0; i < 4; i++) {
        double board = board_at(p, x, y + i / 4. - .375);
        sum += board < 0 ? water : board + .03 * (noise_at(x / 3, y, 6) - .5);
      }
      picture_set(&drawn, x, y, 0, (float)(y < p->horizon ? .8 : sum / 4));
    }
  return drawn;
}

static task hole_at_pier(const pier *p, area hole) {
  gchar *settings = g_strdup_printf("quality=draft orientation=horizon horizon=0,%d,400,%d",
                                    p->horizon, p->horizon);
  task t = task_new(pier_in_water(p), settings);
  task_round_hole(&t, hole);
  task_succeeds(&t);
  g_free(settings);
  return t;
}

/* By how much a block of 8 x 8 px is too light or too dark at most. */
static double most_off(const task *t, area hole) {
  double most = 0;
  for (int y = hole.y0; y < hole.y1; y += 8)
    for (int x = hole.x0; x < hole.x1; x += 8) {
      const area block = {x, y, x + 8, y + 8};
      if (!(picture_get(&t->mask, MIN(x + 4, 399), MIN(y + 4, 299), 0) > 0)) continue;
      most = fmax(most, fabs(moments_of(&t->result, &t->mask, true, block, 0).mean -
                             moments_of(&t->image, &t->mask, true, block, 0).mean));
    }
  return most;
}

/* The step to the dark pier bends no trend of the water: a hole beside it gets no dark smudge. */
static void water_beside_a_pier(void) {
  static const area holes[] = {{20, 180, 110, 230},
                               {10, 160, 100, 220},
                               {290, 180, 380, 230},
                               {300, 190, 380, 250},
                               {0, 190, 80, 260}};
  static const pier wide = {60, 120, 6};
  double most = 0;
  for (gsize i = 0; i < G_N_ELEMENTS(holes); i++) {
    task t = hole_at_pier(&wide, holes[i]);
    double off = most_off(&t, holes[i]);
    g_test_message("hole at %d,%d: off by %.3f", holes[i].x0, holes[i].y0, off);
    most = fmax(most, off);
    task_clear(&t);
  }
  g_assert_cmpfloat(most, <, .05);
}

/* Of a hole in the boards, the part that is brighter than any board. */
static double part_water(const task *t) {
  double water = 0, count = 0;
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 400; x++)
      if (picture_get(&t->mask, x, y, 0) > 0)
        count++, water += picture_get(&t->result, x, y, 0) > .2f;
  return water / count;
}

/* The water's trend is not the boards': taken as theirs, it puts water among them. */
static void boards_of_a_pier(void) {
  static const struct {
    pier pier;
    area hole;
  } scenes[] = {
      {{100, 80, 6}, {185, 136, 214, 214}},  {{100, 80, 10}, {184, 152, 216, 212}},
      {{100, 80, 10}, {181, 152, 218, 223}}, {{100, 80, 6}, {182, 160, 219, 231}},
      {{100, 80, 6}, {184, 157, 216, 217}},
  };
  double most = 0, off = 0;
  for (gsize i = 0; i < G_N_ELEMENTS(scenes); i++) {
    task t = hole_at_pier(&scenes[i].pier, scenes[i].hole);
    double water = part_water(&t), tint = most_off(&t, scenes[i].hole);
    g_test_message("scene %d: %.3f water, off by %.3f", (int)i, water, tint);
    most = fmax(most, water), off = fmax(off, tint);
    task_clear(&t);
  }
  g_assert_cmpfloat(most, <, .02);
  g_assert_cmpfloat(off, <, .05);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/light/sky", sky_tints_no_floor);
  g_test_add_func("/light/beyond", things_tint_nothing_beyond);
  g_test_add_func("/light/colours", colours_are_no_light);
  g_test_add_func("/light/pier-water", water_beside_a_pier);
  g_test_add_func("/light/pier-boards", boards_of_a_pier);
  return g_test_run();
}
