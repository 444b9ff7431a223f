/* A road's dashes come again in the hole where they are due, and nowhere else. And its lines. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define SLANT_DEG 74.
#define TEXEL_PX 20.
#define LANE 4.5  /* texels from one row to the next */
#define PERIOD 6. /* and from one dash to the next */
#define DASH 2.
#define PAINT .9

/* Beyond this there is no dash. */
static double end;
/* Paint gets so much fainter with each texel. */
static double haze;

/* Asphalt, three rows of dashes and, far to the right, a solid line. */
static double road(double u, double v, int k) {
  double grain = noise_at((int)floor(u * 12), (int)floor(v * 12), 40), color = .35 + .08 * grain;
  double along = v + 1 - PERIOD * floor((v + 1) / PERIOD);
  bool in_row = fabs(u) < .15 || fabs(fabs(u) - LANE) < .15;
  if ((in_row && along < DASH && v < end) || fabs(u - 2 * LANE) < .12)
    color = color + (PAINT - color) * exp(-haze * (v + 12));
  return color + .01 * k;
}

/* The same road with so few dashes that none of its rows is told: all else is asphalt. */
static double few_dashes(double u, double v, int k) {
  static const double dashes[][2] = {{0, -16}, {-LANE, -9}, {LANE, -6}, {-LANE, 3}};
  double color = .35 + .08 * noise_at((int)floor(u * 12), (int)floor(v * 12), 40);
  for (int i = 0; i < (int)G_N_ELEMENTS(dashes); i++)
    if (fabs(u - dashes[i][0]) < .15 && fabs(v - dashes[i][1]) < DASH / 2) color = PAINT;
  return color + .01 * k;
}

static picture draw_road(double tilt_deg) {
  return picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, road, TEXEL_PX, SLANT_DEG, tilt_deg);
}

/* In a round hole. */
static paint painted_right(double tilt_deg, double said_deg, area box, const char *settings) {
  picture truth = draw_road(tilt_deg);
  task t = task_new(picture_copy(&truth), settings);
  t.params.slant_deg = said_deg, t.params.tilt_deg = tilt_deg;
  task_round_hole(&t, box);
  task_succeeds(&t);
  task_assert_outside(&t);
  paint p = task_paint(&t, &truth, box);
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("%s, tilt %.0f, said %.1f, hole at %d,%d: %.0f of %.0f px", settings, tilt_deg,
                 said_deg, box.x0, box.y0, p.right, p.all);
  return p;
}

static const area holes[] = {
    {250, 130, 390, 260}, {130, 150, 300, 280}, {200, 140, 440, 250}, {250, 200, 400, 350}};

static double part_right(double tilt_deg, double said_deg, const char *settings) {
  paint sum = {0, 0, 0};
  for (int i = 0; i < some_of(G_N_ELEMENTS(holes)); i++) {
    paint p = painted_right(tilt_deg, said_deg, holes[i], settings);
    sum.right += p.right, sum.all += p.all;
  }
  return sum.right / sum.all;
}

static void come_again(void) {
  static const double tilts_deg[] = {0, 30, 90, -160};
  end = INFINITY;
  for (int i = 0; i < (int)G_N_ELEMENTS(tilts_deg); i++)
    g_assert_cmpfloat(part_right(tilts_deg[i], SLANT_DEG, "surface=flat quality=draft"), >, .7);
  g_assert_cmpfloat(part_right(0, SLANT_DEG, "surface=raised"), >, .7);
  g_assert_cmpfloat(part_right(0, SLANT_DEG, "engine-dashes=0"), <, .3);
}

/* They tell better than the given horizon where they vanish. */
static void correct_the_horizon(void) {
  end = INFINITY;
  g_assert_cmpfloat(part_right(0, SLANT_DEG - 1.5, "surface=flat quality=draft"), >, .5);
  g_assert_cmpfloat(part_right(0, SLANT_DEG + 1.5, "surface=flat quality=draft"), >, .5);
}

/* Where a row is seen to have ended it does not go on in the hole. */
static void end_where_they_end(void) {
  static const area hole = {250, 170, 390, 260};
  for (end = -11; end <= 7; end += PERIOD) /* behind a dash */
    g_assert_cmpfloat(painted_right(0, SLANT_DEG, hole, "quality=draft").wrong, <, 20);
}

/* A row goes on at the viewer's feet, where its dashes are too large to be looked at: none of them
 * is missing. */
static void near_ones_are_not_missed(void) {
  end = INFINITY;
  paint p = painted_right(0, SLANT_DEG, (area){290, 90, 350, 130}, "surface=flat quality=draft");
  g_assert_cmpfloat(p.right / p.all, >, .9);
}

/* A dash that is marked with little around it does not come back. */
static void may_be_taken_away(void) {
  end = INFINITY;
  for (int wide = 0; wide < some_of(3); wide++) {
    picture truth = draw_road(0);
    task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
    double wrong = 0, inside = 0;
    int reach = 3 + 2 * wide;
    area dash = {310, 262, 329, 297};
    t.params.slant_deg = SLANT_DEG;
    for (int y = dash.y0; y < dash.y1; y++)
      for (int x = dash.x0; x < dash.x1; x++) inside += picture_get(&truth, x, y, 0) > .8f;
    task_hole(&t, (area){dash.x0 - reach, dash.y0 - reach, dash.x1 + reach, dash.y1 + reach});
    task_succeeds(&t);
    for (int y = dash.y0 - reach; y < dash.y1 + reach; y++)
      for (int x = dash.x0 - reach; x < dash.x1 + reach; x++)
        wrong += picture_get(&t.result, x, y, 0) > .6f;
    g_test_message("%d px around a dash of %.0f px: %.0f px of paint", reach, inside, wrong);
    g_assert_cmpfloat(inside, >, 80);
    g_assert_cmpfloat(wrong, <, 20);
    task_clear(&t);
    picture_clear(&truth);
  }
}

/* A dash that the hole cuts is made whole of what is left of it, where all others are far and
 * faint.
 */
static void cut_ones_are_made_whole(void) {
  static const struct {
    area hole, dash;
  } cut[] = {{{250, 300, 390, 435}, {300, 410, 340, 470}},  /* its far end */
             {{250, 440, 390, 480}, {300, 410, 340, 470}},  /* its near one */
             {{90, 300, 230, 440}, {110, 410, 160, 470}},   /* and of one that leans */
             {{250, 430, 390, 450}, {300, 410, 340, 470}}}; /* its middle */
  end = INFINITY, haze = .08;
  for (int i = 0; i < some_of(G_N_ELEMENTS(cut)); i++) {
    picture truth = draw_road(0);
    task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
    t.params.slant_deg = SLANT_DEG;
    task_hole(&t, cut[i].hole);
    task_succeeds(&t);
    task_assert_outside(&t);
    paint p = task_paint(&t, &truth, cut[i].dash);
    g_test_message("hole at %d,%d: %.0f of %.0f px", cut[i].hole.x0, cut[i].hole.y0, p.right,
                   p.all);
    task_clear(&t);
    picture_clear(&truth);
    g_assert_cmpfloat(p.all, >, 100);
    g_assert_cmpfloat(p.right, >, .85 * p.all);
  }
  haze = 0;
}

/* One that lies in no row, too: as long as the others are. But not where the hole takes it away. */
static void lone_ones_are_made_whole(void) {
  static const struct {
    area hole;
    bool taken;
  } cases[] = {{{250, 320, 390, 406}, false}, /* its far end */
               {{250, 396, 390, 460}, false}, /* its near one */
               {{250, 394, 390, 408}, false}, /* its middle */
               {{309, 375, 332, 428}, true}};
  picture truth = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, few_dashes, TEXEL_PX, SLANT_DEG, 0);
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
    t.params.slant_deg = SLANT_DEG;
    task_hole(&t, cases[i].hole);
    task_succeeds(&t);
    task_assert_outside(&t);
    paint p = task_paint(&t, &truth, cases[i].hole);
    g_test_message("hole at %d,%d: %.0f of %.0f px", cases[i].hole.x0, cases[i].hole.y0, p.right,
                   p.all);
    task_clear(&t);
    g_assert_cmpfloat(p.all, >, 100);
    if (cases[i].taken)
      g_assert_cmpfloat(p.right, <, 20);
    else
      g_assert_cmpfloat(p.right, >, .8 * p.all);
  }
  picture_clear(&truth);
}

/* A line that ends as far beyond the hole as a dash would is none. */
static double line_and_dashes(double u, double v, int k) {
  return fabs(u - 2 * LANE) < .15 && v > -14.6 ? PAINT : few_dashes(u, v, k);
}

static void ends_of_lines_are_none(void) {
  static const area hole = {490, 260, 630, 352};
  picture truth =
      picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, line_and_dashes, TEXEL_PX, SLANT_DEG, 0);
  task t = task_new(picture_copy(&truth), "surface=flat quality=draft");
  t.params.slant_deg = SLANT_DEG;
  task_hole(&t, hole);
  task_succeeds(&t);
  paint p = task_paint(&t, &truth, hole);
  g_test_message("%.0f of %.0f px", p.right, p.all);
  g_assert_cmpfloat(p.all, >, 400);
  g_assert_cmpfloat(p.right, >, .9 * p.all);
  task_clear(&t);
  picture_clear(&truth);
}

/* A line that cuts a corner off a hole leaves it at flat angles. */
static void lines_cut_corners(void) {
  static const area hole = {420, 180, 560, 300};
  end = INFINITY;
  paint p = painted_right(0, SLANT_DEG, hole, "surface=flat");
  g_assert_cmpfloat(p.all, >, 60);
  g_assert_cmpfloat(p.right, >, .7 * p.all);
}

/* A wall's joints come again, too, but they are not all that stands out. */
static void walls_have_none(void) {
  static const double slants_deg[] = {30, 60}, tilts_deg[] = {0, 45};
  for (int i = 0; i < some_of(4); i++) {
    double slant_deg = slants_deg[i / 2], tilt_deg = tilts_deg[i % 2];
    picture truth = picture_of_plane(400, 300, 1, RECEDE_U8, bricks, 20, slant_deg, tilt_deg);
    task with = task_new(picture_copy(&truth), "quality=draft");
    task without = task_new(truth, "quality=draft engine-dashes=0");
    for (task *t = &with; t; t = t == &with ? &without : NULL) {
      t->params.slant_deg = slant_deg, t->params.tilt_deg = tilt_deg;
      task_hole(t, (area){150, 100, 260, 190});
      task_succeeds(t);
    }
    g_assert_true(memcmp(with.result.pixels, without.result.pixels, picture_bytes(&with.result)) ==
                  0);
    task_clear(&with);
    task_clear(&without);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/dashes/come-again", come_again);
  g_test_add_func("/dashes/horizon", correct_the_horizon);
  g_test_add_func("/dashes/end", end_where_they_end);
  g_test_add_func("/dashes/near", near_ones_are_not_missed);
  g_test_add_func("/dashes/away", may_be_taken_away);
  g_test_add_func("/dashes/cut", cut_ones_are_made_whole);
  g_test_add_func("/dashes/lone", lone_ones_are_made_whole);
  g_test_add_func("/dashes/line", ends_of_lines_are_none);
  g_test_add_func("/dashes/corner", lines_cut_corners);
  g_test_add_func("/dashes/walls", walls_have_none);
  return g_test_run();
}
