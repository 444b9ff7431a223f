/* What crosses the hole among others that look like it: a joint beside others, slats beside slats,
 * boards between water. Drawn ground. */
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
  int wrong = 0, holes = some_of(2 * G_N_ELEMENTS(beside_px));
  for (int n = 0; n < holes; n++) {
    double slope = n % 2 ? .15 : .05;
    int here = columns_wrong(slope, beside_px[n / 2], n);
    g_test_message("slope %.2f, %d px beside the hole: %d", slope, beside_px[n / 2], here);
    wrong += here;
  }
  g_test_message("%d columns of %d holes", wrong, holes);
  g_assert_cmpint(wrong, <=, 3 * holes);
}

/* Upright slats, period px wide, each of its own brightness and contrast, in light that changes
 * along the wall. */
static picture slats(double period, int seed) {
  picture p = picture_new(WIDTH, HEIGHT, 1, RECEDE_U8);
  for (int x = 0; x < WIDTH; x++) {
    double at = x / period;
    int n = (int)floor(at);
    double edge = CLAMP((.5 - fabs(at - n - .5)) * period - 1, 0, 1);
    double own = .25 + .55 * noise_at(n, seed, 40), gap = .1 + .1 * noise_at(n, seed, 41);
    for (int y = 0; y < HEIGHT; y++) {
      double light = .6 + .4 * x / WIDTH + .2 * y / HEIGHT;
      double value = light * (gap + edge * (own - gap)) + .02 * noise_at(x, y, 42);
      picture_set(&p, x, y, 0, (float)value);
    }
  }
  return p;
}

/* Of the fill with the truth. */
static double correlation(const task *t, const picture *truth, area a) {
  double n = 0, sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x < a.x1; x++) {
      double p = picture_get(&t->result, x, y, 0), q = picture_get(truth, x, y, 0);
      n++, sx += p, sy += q, xx += p * p, yy += q * q, xy += p * q;
    }
  return (xy - sx * sy / n) / sqrt((xx - sx * sx / n) * (yy - sy * sy / n));
}

/* Some slats at the hole's top were taken for their neighbours at its foot, and leaned: the fill
 * was like the truth by .42 to .76, now by .86 to .91. */
static void slats_stay_upright(void) {
  static const struct wall {
    double period;
    int kind;
  } walls[] = {{5.6, 48}, {5.8, 19}, {6, 1}, {6.1, 3}, {6.1, 21}, {6.2, 4}, {6.2, 28}, {6.4, 53}};
  const area filled = {100, 50, 210, 190};
  double sum = 0;
  for (guint n = 0; n < G_N_ELEMENTS(walls); n++) {
    picture truth = slats(walls[n].period, walls[n].kind);
    task t = task_new(picture_copy(&truth), "quality=draft orientation=frontal");
    task_hole(&t, filled);
    task_succeeds(&t);
    double alike = correlation(&t, &truth, filled);
    g_test_message("%.1f px apart, %d: %.3f", walls[n].period, walls[n].kind, alike);
    sum += alike / G_N_ELEMENTS(walls);
    task_clear(&t);
    picture_clear(&truth);
  }
  g_test_message("in the mean %.3f", sum);
  g_assert_cmpfloat(sum, >, .83);
}

#define WATER_AND_JOINTS .34

/* So many boards to each side of the middle, each of its own shade, lead away over dark water. */
static int boards;

static double deck(double u, double v, int k) {
  int row = (int)floor(u);
  double across = u - row, along = v / 9 + noise_at(row, 0, 20);
  (void)k;
  if (fabs(u) > boards)
    return .25 + .08 * smooth_noise(u, v, .3, 50) + .04 * smooth_noise(u, v, 2, 51);
  if (across < .1 || along - floor(along) < .03) return .1;
  return .45 + .2 * noise_at((int)floor(along), row, 22) + .15 * smooth_noise(u * 9, v, .6, 21);
}

/* Of what boards there were in the hole. */
static double part_of_boards(const task *t, const picture *truth, area a) {
  double kept = 0, all = 0;
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x < a.x1; x++) {
      if (picture_get(truth, x, y, 0) < WATER_AND_JOINTS) continue;
      kept += picture_get(&t->result, x, y, 0) > WATER_AND_JOINTS, all++;
    }
  return kept / all;
}

typedef struct seen {
  double slant_deg, board_px;
  int boards, top;
} seen;

/* In holes that reach down so far. */
static double mean_part_of_boards(const seen *all, int count, int foot) {
  double sum = 0;
  for (int i = 0; i < count; i++) {
    const seen *s = &all[i];
    area filled = {110, s->top, 210, foot};
    boards = s->boards;
    picture truth =
        picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, deck, s->board_px, s->slant_deg, 0);
    task t = task_new(picture_copy(&truth), "quality=draft");
    t.params.slant_deg = s->slant_deg;
    task_hole(&t, filled);
    task_succeeds(&t);
    double part = part_of_boards(&t, &truth, filled);
    g_test_message("slant %.0f, %d boards of %.0f px: %.3f", s->slant_deg, 2 * boards, s->board_px,
                   part);
    sum += part / count;
    task_clear(&t);
    picture_clear(&truth);
  }
  g_test_message("in the mean %.3f", sum);
  return sum;
}

/* Up to the picture's end: along the boards there are only such as are farther away, and smaller.
 * Water came there, .45 of the boards were left, now .96. */
static void boards_come_from_far_along(void) {
  static const seen all[] = {{78, 14, 2, 180}, {78, 18, 2, 150}, {78, 10, 3, 180},
                             {80, 10, 2, 180}, {80, 14, 2, 180}, {82, 10, 2, 180}};
  g_assert_cmpfloat(mean_part_of_boards(all, G_N_ELEMENTS(all), HEIGHT), >, .8);
}

/* Before the picture's end by 12 px, and longer: none of those along them is large enough. */
static void boards_near_the_end_are_no_water(void) {
  static const seen all[] = {{80, 14, 2, 150}, {80, 10, 3, 150}, {82, 14, 2, 150},
                             {82, 10, 3, 150}, {78, 14, 3, 120}, {78, 10, 4, 120}};
  g_assert_cmpfloat(mean_part_of_boards(all, G_N_ELEMENTS(all), HEIGHT - 12), >, .8);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/crossed/joints", others_stay_where_they_are);
  test_add_judged("/lines/slats", slats_stay_upright);
  test_add_judged("/lines/boards-far-along", boards_come_from_far_along);
  test_add_judged("/lines/boards-near-the-end", boards_near_the_end_are_no_water);
  return g_test_run();
}
