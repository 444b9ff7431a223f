/* Exemplars seen from the front, laid onto the plane, and what is far from them. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

enum { WIDTH = 300, HEIGHT = 200, SIDE = 120 };

/* Red grows to the right, green upwards. */
static picture slopes(void) {
  picture p = picture_new(SIDE, SIDE, 3, RECEDE_FLOAT);
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      picture_set(&p, x, y, 0, (float)x / SIDE);
      picture_set(&p, x, y, 1, (float)(SIDE - 1 - y) / SIDE);
    }
  return p;
}

typedef struct point {
  double x, y;
} point;

/* Where an exemplar's pixel must come to lie: as far up and to the right of the point where the
 * middle line along the tilt leaves the picture as the plane's own squares say. */
static point laid_at(const recede_plane *plane, point anchor, double right_px, double up_px) {
  double quad[8], slant, tilt, fov, turn;
  recede_plane_angles(plane, &slant, &tilt, &fov);
  turn = tilt * G_PI / 180;
  /* Two thin squares from the anchor: their far sides are right_px and up_px away. */
  point across = {cos(turn), sin(turn)}, at = anchor;
  double w0 = recede_plane_w(plane, anchor.x, anchor.y);
  for (int n = 0; n < 400; n++) { /* along the tilt, in steps of 1/400 of the way */
    double w = recede_plane_w(plane, at.x, at.y), step = up_px / 400 * w / w0;
    g_assert_true(recede_plane_quad(plane, at.x, at.y, step, quad));
    double dx = (quad[0] + quad[2] - quad[4] - quad[6]) / 2,
           dy = (quad[1] + quad[3] - quad[5] - quad[7]) / 2;
    double away = dx * sin(turn) - dy * cos(turn); /* in the picture, to where it recedes */
    at.x += sin(turn) * fabs(away), at.y -= cos(turn) * fabs(away);
  }
  double w = recede_plane_w(plane, at.x, at.y);
  return (point){at.x + across.x * right_px * w / w0, at.y + across.y * right_px * w / w0};
}

/* Where the line from the middle towards the viewer leaves the picture. */
static point anchor_in(double tilt_deg, int width, int height) {
  double turn = tilt_deg * G_PI / 180, dx = -sin(turn), dy = cos(turn);
  double away =
      fmin((width - 1) / 2. / fmax(fabs(dx), 1e-9), (height - 1) / 2. / fmax(fabs(dy), 1e-9));
  return (point){(width - 1) / 2. + away * dx, (height - 1) / 2. + away * dy};
}

/* Neither turned nor mirrored, 1 px across at the edge nearest to the viewer, foreshortened as the
 * plane is. */
static void lies_as_the_plane_does(void) {
  static const double tilts_deg[] = {0, 180, 90, -90, 45, -135, 20};
  for (int i = 0; i < some_of(G_N_ELEMENTS(tilts_deg)); i++) {
    task t = task_new(slopes(), "slant=50 exemplar=frontal quality=draft engine-iterations=1");
    t.params.tilt_deg = tilts_deg[i];
    task_synthesize(&t, WIDTH, HEIGHT);
    g_assert_cmpstr(t.message, ==, "");
    g_assert_cmpuint(t.report.peak_bytes, <=, t.report.estimated_bytes);
    static const double pixels[][2] = {{60, 10}, {30, 15},  {90, 15},
                                       {20, 60}, {100, 60}, {60, 100}};
    int seen = 0;
    for (guint n = 0; n < G_N_ELEMENTS(pixels); n++) {
      point at = laid_at(&t.report.orientation.plane, anchor_in(tilts_deg[i], WIDTH, HEIGHT),
                         pixels[n][0] - (SIDE - 1) / 2., pixels[n][1] + .5);
      int x = (int)lround(at.x), y = (int)lround(at.y);
      if (x < 1 || y < 1 || x >= WIDTH - 1 || y >= HEIGHT - 1) continue; /* cut off, obliquely */
      seen++;
      g_test_message("tilt %.0f, pixel %.0f %.0f at %d %d: %.1f %.1f", tilts_deg[i], pixels[n][0],
                     pixels[n][1], x, y, (double)picture_get(&t.result, x, y, 0) * SIDE,
                     (double)picture_get(&t.result, x, y, 1) * SIDE);
      g_assert_cmpfloat(fabs(picture_get(&t.result, x, y, 0) * SIDE - pixels[n][0]), <, 2);
      g_assert_cmpfloat(fabs(picture_get(&t.result, x, y, 1) * SIDE - pixels[n][1]), <, 3);
    }
    g_assert_cmpint(seen, >=, 4);
    task_clear(&t);
  }
}

/* Of the red deviation near the viewer, what a strip at a third of the nearest scale has. */
static double far_contrast(const picture *p) {
  picture none = picture_new(2 * WIDTH, 2 * HEIGHT, 1, RECEDE_U8);
  double near = moments_of(p, &none, false, (area){260, 340, 340, 400}, 0).deviation;
  double far = moments_of(p, &none, false, (area){50, 140, 550, 165}, 0).deviation;
  picture_clear(&none);
  return far / near;
}

typedef struct outcome {
  double contrast, rest; /* rest: px that only go on what is beside them, of all */
} outcome;

static outcome fill_far(const char *settings) {
  static const char said[] = " px are too small";
  task t = task_new(picture_of_plane(SIDE, SIDE, 3, RECEDE_U8, grains, 6, 0, 0),
                    "slant=76 exemplar=frontal quality=draft");
  task_set(&t, settings);
  task_synthesize(&t, 2 * WIDTH, 2 * HEIGHT);
  g_assert_cmpstr(t.message, ==, "");
  const char *number = strstr(t.report.warning, said);
  while (number && number > t.report.warning && g_ascii_isdigit(number[-1])) number--;
  outcome o = {far_contrast(&t.result),
               number ? g_ascii_strtod(number, NULL) / (double)t.report.filled_pixels : 0};
  g_test_message("%s: %.2f of the contrast, rest %.2f", settings, o.contrast, o.rest);
  task_clear(&t);
  return o;
}

/* As far as grains can be told apart they are there, not streaks; copied at once they are not. */
static void texture_goes_on_far_away(void) {
  double texel_px = 6 * .2419 / .5437; /* in the middle: w there and at the anchor */
  picture truth = picture_of_plane(2 * WIDTH, 2 * HEIGHT, 3, RECEDE_U8, grains, texel_px, 76, 0);
  double wanted = far_contrast(&truth);
  outcome stepwise = fill_far("engine-steps=1"), at_once = fill_far("engine-steps=0");
  g_test_message("the plane itself: %.2f", wanted);
  g_assert_cmpfloat(fabs(log(stepwise.contrast / wanted)), <, .45);
  g_assert_cmpfloat(stepwise.rest, <, .1);
  g_assert_cmpfloat(at_once.rest, >, .3);
  picture_clear(&truth);
}

enum { BOARD = 16 };

/* Boards that run up, each of its own shade, with dark joints at their left. */
static picture boards(int count) {
  picture p = picture_new(BOARD * count, BOARD * count, 3, RECEDE_U8);
  for (int y = 0; y < BOARD * count; y++)
    for (int x = 0; x < BOARD * count; x++) {
      int board = x / BOARD, end = (int)floor(y / 90. + noise_at(board, 0, 20));
      double grain = noise_at(x / 2, y / 20, 21);
      for (int k = 0; k < 3; k++)
        picture_set(&p, x, y, k,
                    x % BOARD < 2 ? .1f
                                  : (float)(.45 + .25 * noise_at(board, end, 22) + .1 * grain));
    }
  return p;
}

static float darkest_near(const picture *p, double x, double y) {
  float least = 1;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      int at_x = (int)lround(x) + dx, at_y = (int)lround(y) + dy;
      bool within = at_x >= 0 && at_y >= 0 && at_x < 2 * WIDTH && at_y < 2 * HEIGHT;
      if (within) least = fminf(least, picture_get(p, at_x, at_y, 0));
    }
  return least;
}

/* Of the joints where boards of the plane are so many px wide, those that go on for .3 of the way
 * to the horizon. */
static double joints_that_go_on(const task *t, double least_px, double most_px) {
  const recede_plane *plane = &t->report.orientation.plane;
  double turn = t->params.tilt_deg * G_PI / 180, joints = 0, whole = 0;
  double away = plane->focal_px / tan(t->params.slant_deg * G_PI / 180);
  point anchor = anchor_in(t->params.tilt_deg, 2 * WIDTH, 2 * HEIGHT);
  point end = {WIDTH - .5 + away * sin(turn), HEIGHT - .5 - away * cos(turn)};
  double w0 = recede_plane_w(plane, anchor.x, anchor.y);
  for (int y = 0; y < 2 * HEIGHT; y++)
    for (int x = 0; x < 2 * WIDTH; x++) {
      double board_px = BOARD * recede_plane_w(plane, x, y) / w0;
      if (!(board_px > least_px && board_px < most_px)) continue;
      if (picture_get(&t->result, x, y, 0) > .25f) continue;
      int dark = 0;
      for (int n = 1; n <= 3; n++)
        dark += darkest_near(&t->result, x + .1 * n * (end.x - x), y + .1 * n * (end.y - y)) < .4f;
      joints++, whole += dark == 3;
    }
  return whole / joints;
}

/* Boards go on to the horizon, and to the sides, however many there are to copy. */
static void boards_go_on(void) {
  static const struct {
    double tilt_deg;
    int count;
    double least_far; /* of four boards joints get faint */
  } cases[] = {{0, 8, .75}, {30, 8, .75}, {90, 8, .75}, {0, 4, .4}, {0, 16, .75}};
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    task t =
        task_new(boards(cases[i].count), "slant=70 exemplar=frontal quality=draft surface=flat");
    t.params.tilt_deg = cases[i].tilt_deg;
    task_synthesize(&t, 2 * WIDTH, 2 * HEIGHT);
    g_assert_cmpstr(t.message, ==, "");
    g_assert_cmpuint(t.report.peak_bytes, <=, t.report.estimated_bytes);
    double near = joints_that_go_on(&t, 11, 16), far = joints_that_go_on(&t, 7, 11);
    g_test_message("%d boards, tilt %.0f: %.2f near, %.2f far", cases[i].count, cases[i].tilt_deg,
                   near, far);
    g_assert_cmpfloat(near, >, .75);
    g_assert_cmpfloat(far, >, cases[i].least_far);
    task_clear(&t);
  }
}

static void what_tells_no_plane_is_refused(void) {
  static const struct {
    const char *settings, *word;
  } cases[] = {{"orientation=auto", "slant"},
               {"slant=40 method=paper", "method plane"},
               {"slant=150", "beyond the horizon"}};
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    task t = task_new(slopes(), "exemplar=frontal");
    task_set(&t, cases[i].settings);
    task_synthesize(&t, WIDTH, HEIGHT);
    g_assert_cmpint(t.status, !=, RECEDE_OK);
    g_assert_nonnull(strstr(t.message, cases[i].word));
    g_assert_true(task_result_untouched(&t));
    task_clear(&t);
  }
}

/* Some pixels are enough; of one none of the result's would be covered. */
static void small_ones_are_laid(void) {
  static const int sizes[][2] = {{5, 5}, {40, 4}, {4, 60}, {1, 1}};
  for (guint i = 0; i < G_N_ELEMENTS(sizes); i++) {
    picture p = picture_new(sizes[i][0], sizes[i][1], 1, RECEDE_FLOAT);
    picture_fill(&p, (area){0, 0, sizes[i][0], sizes[i][1]}, .5f);
    task t = task_new(p, "slant=30 exemplar=frontal quality=draft");
    task_synthesize(&t, 40, 30);
    g_test_message("%d x %d: %s %s", sizes[i][0], sizes[i][1], t.message, t.report.warning);
    if (sizes[i][0] == 1) {
      g_assert_cmpint(t.status, ==, RECEDE_EMPTY_SOURCE);
      g_assert_nonnull(strstr(t.message, "the exemplar is too small"));
    } else {
      g_assert_cmpstr(t.message, ==, "");
      picture none = picture_new(40, 30, 1, RECEDE_U8);
      g_assert_cmpfloat(
          fabs(moments_of(&t.result, &none, false, (area){0, 0, 40, 30}, 0).mean - .5), <, .01);
      picture_clear(&none);
    }
    task_clear(&t);
  }
}

/* Where it is transparent it is filled like the rest, and its colour there is read by nobody. */
static void transparent_is_filled(void) {
  picture results[2];
  for (int i = 0; i < 2; i++) {
    picture p = picture_of_plane(SIDE, SIDE, 4, RECEDE_U8, grains, 6, 0, 0);
    for (int y = 70; y < 110; y++)
      for (int x = 40; x < 80; x++)
        for (int k = 0; k < 4; k++) picture_set(&p, x, y, k, k == 3 ? 0 : (float)i);
    task t = task_new(p, "slant=50 exemplar=frontal quality=draft");
    t.host.threads = 1 + 2 * i;
    task_synthesize(&t, WIDTH, HEIGHT);
    g_assert_cmpstr(t.message, ==, "");
    picture none = picture_new(WIDTH, HEIGHT, 1, RECEDE_U8);
    g_assert_cmpfloat(moments_of(&t.result, &none, false, (area){0, 0, WIDTH, HEIGHT}, 3).least, ==,
                      1);
    picture_clear(&none);
    results[i] = picture_copy(&t.result);
    task_clear(&t);
  }
  g_assert_true(memcmp(results[0].pixels, results[1].pixels, picture_bytes(&results[0])) == 0);
  for (int i = 0; i < 2; i++) picture_clear(&results[i]);
}

/* What is cut out leaves no bright edge, neither near nor far. */
static void cut_out_has_no_fringe(void) {
  enum { LONG = 4 * SIDE };
  picture p = picture_new(SIDE, LONG, 4, RECEDE_U8),
          none = picture_new(WIDTH, HEIGHT, 1, RECEDE_U8);
  for (int y = 0; y < LONG; y++)
    for (int x = 0; x < SIDE; x++)
      for (int k = 0; k < 4; k++)
        picture_set(&p, x, y, k, k < 3 ? .4f : (float)(hypot(x - 60, y % 30 - 15) > 11));
  task t = task_new(p, "slant=75 exemplar=frontal quality=draft");
  task_synthesize(&t, WIDTH, HEIGHT);
  g_assert_cmpstr(t.message, ==, "");
  /* The horizon is in row 13. */
  moments all = moments_of(&t.result, &none, false, (area){0, 20, WIDTH, HEIGHT}, 0);
  g_test_message("of .4: %.3f to %.3f", all.least, all.most);
  g_assert_cmpfloat(all.least, >, .39);
  g_assert_cmpfloat(all.most, <, .41);
  task_clear(&t);
  picture_clear(&none);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/laid/geometry", lies_as_the_plane_does);
  test_add_judged("/laid/far", texture_goes_on_far_away);
  test_add_judged("/laid/boards", boards_go_on);
  g_test_add_func("/laid/refused", what_tells_no_plane_is_refused);
  g_test_add_func("/laid/small", small_ones_are_laid);
  g_test_add_func("/laid/transparent", transparent_is_filled);
  g_test_add_func("/laid/cut-out", cut_out_has_no_fringe);
  return g_test_run();
}
