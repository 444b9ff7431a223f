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

static picture floor_with(const drawn *lines, int count, float bright) {
  picture p = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, grains, 2, 30, 0);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      float value = .3f + .15f * picture_get(&p, x, y, 0);
      for (int i = 0; i < count; i++) {
        double covered = HALF_WIDTH_PX + .5 - fabs(y - height_of(&lines[i], x));
        value += (float)CLAMP(covered, 0, 1) * (bright - value);
      }
      picture_set(&p, x, y, 0, value);
    }
  return p;
}

/* In how many of the hole's columns there is at least so much light where the line should run.
 * Takes p over. */
static double part_continued_in(picture p, const drawn *line, float least, int seed,
                                const char *settings) {
  task t = task_new(p, settings);
  t.params.slant_deg = 30;
  t.params.seed = seed;
  task_hole(&t, hole);
  task_succeeds(&t);
  int bright = 0;
  for (int x = hole.x0; x < hole.x1; x++)
    bright += picture_get(&t.result, x, (int)lrint(height_of(line, x)), 0) > least;
  task_clear(&t);
  return (double)bright / (hole.x1 - hole.x0);
}

static double part_continued(const drawn *line, int seed, const char *settings) {
  return part_continued_in(floor_with(line, 1, .9f), line, .65f, seed, settings);
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

/* Beside a line, and along it, a lane's dashes, so bright and so far apart that by them the floor
 * seems to repeat. */
static void dashes_do_not_stop_it(void) {
  static const drawn lines[] = {{120, 0, 0}, {70, .3, 0}};
  double sum = 0;
  int floors = some_of(6);
  for (int n = 0; n < floors; n++) {
    const drawn *line = &lines[n % 2];
    int apart = 60 + 20 * (n / 2);
    picture p = floor_with(line, 1, .65f);
    for (int x = 10; x < WIDTH; x++) {
      int y = (int)height_of(line, x) - 70;
      if ((x - 10) % apart >= apart / 3 || y + 6 <= 0) continue;
      picture_fill(&p, (area){x, MAX(y, 0), x + 1, y + 6}, .95f);
    }
    double here = part_continued_in(p, line, .53f, n, "quality=draft");
    g_test_message("slope %.1f, %d px apart: %.2f", line->slope, apart, here);
    sum += here / floors;
  }
  g_assert_cmpfloat(sum, >, .9);
}

/* Two ends that only happen to face each other are not joined. */
static void others_do_not(void) {
  static const drawn line = {120, 0, 0};
  picture p = floor_with(&line, 1, .9f), plain = floor_with(&line, 0, 0);
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

/* A white marking along the plane, wider than what lines are known by, on asphalt. */
static double leaning;

static double marking(double u, double v, int k) {
  double across = u - leaning * v, grain = noise_at((int)floor(u * 12), (int)floor(v * 12), 24);
  return (fabs(across) < .4 ? .9 : .35) + .06 * grain + .01 * k;
}

/* What is marked right, of all that is or should be marked. */
static double part_marked_right(const picture *truth, const picture *result) {
  double right = 0, all = 0;
  for (int y = hole.y0; y < hole.y1; y++)
    for (int x = hole.x0; x < hole.x1; x++) {
      float wanted = picture_get(truth, x, y, 0);
      if (wanted > .5f && wanted < .8f) continue; /* an edge */
      bool painted = wanted > .8f, good = fabsf(picture_get(result, x, y, 0) - wanted) < .15f;
      right += painted && good, all += painted || !good;
    }
  return right / all;
}

static double marked_right(const char *settings) {
  static const double leans[] = {.4, .9, -.6};
  double sum = 0;
  for (guint i = 0; i < G_N_ELEMENTS(leans); i++) {
    leaning = leans[i];
    picture truth = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, marking, 14, 70, 0);
    for (int seed = 0; seed < 2; seed++) {
      task t = task_new(picture_copy(&truth), settings);
      t.params.slant_deg = 70, t.params.seed = seed;
      task_hole(&t, hole);
      task_succeeds(&t);
      double part = part_marked_right(&truth, &t.result);
      g_test_message("%s, leaning %.1f, seed %d: %.3f", settings, leaning, seed, part);
      sum += part;
      task_clear(&t);
    }
    picture_clear(&truth);
  }
  return sum / (2 * G_N_ELEMENTS(leans));
}

static void markings_keep_both_edges(void) {
  g_assert_cmpfloat(marked_right("surface=flat"), >, .8);
  g_assert_cmpfloat(marked_right("surface=raised"), >, .8);
}

/* Boards along u, 1 texel wide and some 9 long, each of its own shade, with grain and dark joints.
 */
static double boards(double u, double v, int k) {
  int row = (int)floor(v), end;
  double along = u / 9 + noise_at(row, 0, 20), across = v - row;
  end = (int)floor(along);
  if (across < .14 || along - end < .02) return .1;
  int at = (int)floor(u / 3);
  double part = u / 3 - at;
  double grain = (1 - part) * noise_at(at, (int)floor(v * 9), 21) +
                 part * noise_at(at + 1, (int)floor(v * 9), 21);
  return .35 + .3 * noise_at(end, row, 22) + .15 * grain + .02 * k;
}

/* The joints between them alone, dark. */
static double joints(double u, double v, int k) {
  (void)u, (void)k;
  return v - floor(v) < .14 ? 0 : 1;
}

/* Of the hole, for boards seen at a slant: the part of the joints between them that is dark, and
 * the dark pixels beside joints over those that there were, the boards' ends. */
typedef struct boards_made {
  double joints, ends;
} boards_made;

static boards_made fill_boards(pattern *draw, double slant_deg, area filled, const char *settings) {
  double kept = 0, all = 0, dark = 0, ends = 0;
  picture rows = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, joints, 16, slant_deg, 0);
  for (int seed = 0; seed < 2; seed++) {
    picture p = picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, draw, 16, slant_deg, 0);
    task t = task_new(p, settings);
    t.params.slant_deg = slant_deg, t.params.seed = seed;
    task_hole(&t, filled);
    task_succeeds(&t);
    for (int y = filled.y0; y < filled.y1; y++)
      for (int x = filled.x0; x < filled.x1; x++) {
        bool is_dark = picture_get(&t.result, x, y, 0) < .3f;
        float open = picture_get(&rows, x, y, 0);
        if (open < .1f) all++, kept += is_dark;
        if (open > .95f) dark += is_dark, ends += picture_get(&p, x, y, 0) < .3f;
      }
    task_clear(&t);
  }
  picture_clear(&rows);
  g_test_message("%s, slant %.0f: %.3f of the joints, ends %.2f of the true ones", settings,
                 slant_deg, kept / all, dark / ends);
  return (boards_made){kept / all, dark / ends};
}

static void boards_run(void) {
  boards_made flat = fill_boards(boards, 40, hole, "quality=draft surface=flat");
  boards_made raised = fill_boards(boards, 40, hole, "quality=draft surface=raised");
  g_assert_cmpfloat(flat.joints, >, .85);
  g_assert_cmpfloat(raised.joints, >, .85);
  boards_made free =
      fill_boards(boards, 40, hole, "quality=draft surface=flat engine-rails=0 engine-regular=0");
  g_assert_cmpfloat(flat.joints, >, free.joints + .1);
}

/* A pier: boards between two rails, in water. */
static double pier(double u, double v, int k) {
  double side = fabs(u);
  if (side > 8) return .5 + .02 * noise_at((int)floor(u), (int)floor(4 * v), 28);
  return side > 7 ? .9 : boards(u, v, k);
}

/* Rails and water beside boards do not hide that these run. */
static void boards_of_a_pier_run(void) {
  g_assert_cmpfloat(fill_boards(pier, 0, hole, "quality=draft").joints, >, .93);
  g_assert_cmpfloat(fill_boards(pier, 20, hole, "quality=draft").joints, >, .93);
}

/* Where all have one width: light and dark ones meet at ends, and none is bent to suit the others.
 */
static void boards_are_filled_one_by_one(void) {
  for (int slant_deg = 0; slant_deg <= 20; slant_deg += 20) {
    boards_made one_by_one = fill_boards(boards, slant_deg, hole, "quality=draft");
    g_assert_cmpfloat(one_by_one.joints, >, .95);
    g_assert_cmpfloat(one_by_one.ends, >, .7);
    g_assert_cmpfloat(one_by_one.ends, <, 3);
    boards_made together = fill_boards(boards, slant_deg, hole, "quality=draft engine-gauge=0");
    g_assert_cmpfloat(one_by_one.joints, >, together.joints + .07);
  }
}

/* Boards that end with the picture: no line crosses the hole. */
static void boards_run_out_of_the_picture(void) {
  area right = {200, 80, WIDTH, 160};
  for (int slant_deg = 30; slant_deg <= 40; slant_deg += 10) {
    boards_made on_rails = fill_boards(boards, slant_deg, right, "quality=draft");
    const char *off = "quality=draft engine-rails=0 engine-cuts=0 engine-regular=0";
    boards_made free = fill_boards(boards, slant_deg, right, off);
    g_assert_cmpfloat(on_rails.joints, >, .95);
    g_assert_cmpfloat(on_rails.joints, >, free.joints + .15);
    /* Of a coarsest level so large that only one start is worth its time, too. */
    on_rails = fill_boards(boards, slant_deg, right, "quality=draft engine-starts=1");
    g_assert_cmpfloat(on_rails.joints, >, .95);
  }
}

/* Tiles, each of its own shade. */
static double tiles(double u, double v, int k) {
  if (u - floor(u) < .08 || v - floor(v) < .08) return .2;
  return .45 + .4 * noise_at((int)floor(u), (int)floor(v), 23) + .02 * k;
}

/* Courses of tiles are no lines to be moved by themselves: that breaks the joints between. */
static void tiles_do_not(void) {
  guint64 hash[2];
  for (int lines = 0; lines < 2; lines++) {
    task t = task_new(picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, tiles, 16, 20, 0),
                      lines ? "" : "engine-lines=0");
    t.params.slant_deg = 20;
    task_hole(&t, (area){100, 0, 220, 80});
    task_succeeds(&t);
    hash[lines] = t.report.output_hash;
    task_clear(&t);
  }
  g_assert_cmphex(hash[0], ==, hash[1]);
}

/* Red gravel above this line, green below; of about the same brightness. */
static double verge_at(double x) { return 88 + .2 * x; }

static picture verge(void) {
  static const double parts[2][3] = {{.85, .6, .4}, {.65, .7, .35}};
  picture p = picture_new(WIDTH, HEIGHT, 3, RECEDE_U8);
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++) {
      int below = y > verge_at(x);
      double grain = .15 + .6 * noise_at(x / 7, y / 5, 24) + .2 * noise_at(x, y, 25);
      for (int k = 0; k < 3; k++) picture_set(&p, x, y, k, (float)(grain * parts[below][k]));
    }
  return p;
}

/* The part of the hole that has the other side's colour, but for 3 px along the line. */
static double part_on_wrong_side(const char *settings) {
  double wrong = 0, all = 0;
  for (int seed = 0; seed < some_of(3); seed++) {
    task t = task_new(verge(), settings);
    t.params.slant_deg = 30, t.params.seed = seed;
    task_hole(&t, hole);
    task_succeeds(&t);
    for (int y = hole.y0; y < hole.y1; y++)
      for (int x = hole.x0; x < hole.x1; x++) {
        if (fabs(y - verge_at(x)) < 3) continue;
        bool green = picture_get(&t.result, x, y, 1) > picture_get(&t.result, x, y, 0);
        wrong += green != (y > verge_at(x)), all++;
      }
    task_clear(&t);
  }
  g_test_message("%s: %.4f on the wrong side", settings, wrong / all);
  return wrong / all;
}

static void textures_keep_to_their_sides(void) {
  double with = part_on_wrong_side(""),
         without = part_on_wrong_side("engine-boundary=0 engine-regions=0");
  g_assert_cmpfloat(with, <, .01);
  g_assert_cmpfloat(without, >, with + .02);
}

static void assert_same_for_threads(picture (*draw)(void), const char *settings) {
  guint64 hash = 0;
  for (int threads = 1; threads <= 3; threads++) {
    task t = task_new(draw(), settings);
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

static picture lines_drawn(void) {
  static const drawn lines[] = {{95, 0, 0}, {120, .02, 0}, {150, 0, 0}};
  return floor_with(lines, 3, .9f);
}

static picture boards_drawn(void) {
  return picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, boards, 16, 30, 0);
}

static void same_for_threads(void) {
  /* Of four starts two are with lines, one of these from whole copies. */
  assert_same_for_threads(lines_drawn, "quality=draft surface=flat engine-starts=4");
  assert_same_for_threads(boards_drawn, "quality=draft surface=raised");
  assert_same_for_threads(boards_drawn, "quality=draft"); /* one by one */
  assert_same_for_threads(verge, "quality=draft");
}

static double edge(double y, double at) { return CLAMP((y - at) / 6 + .5, 0, 1); }

/* Bands that converge, as a barrier and the ground behind it, neither repeat nor are they rails:
 * moved along any one direction the edges of the others break. */
static void converging_edges_stay(void) {
  picture p = picture_new(480, 360, 1, RECEDE_U8);
  for (int y = 0; y < 360; y++)
    for (int x = 0; x < 480; x++) {
      double far = 120 + .012 * (x - 240), near = 225 - .012 * (x - 240);
      double value = .7 - .55 * edge(y, far) + .7 * edge(y, near) - .55 * edge(y, near + 24);
      picture_set(&p, x, y, 0, (float)(value + .02 * noise_at(x, y, 31)));
    }
  picture truth = picture_copy(&p);
  task t = task_new(p, "orientation=frontal");
  task_hole(&t, (area){120, 75, 360, 285});
  task_succeeds(&t);
  double psnr = masked_psnr(&t.result, &truth, &t.mask);
  g_test_message("PSNR %.1f dB", psnr);
  g_assert_cmpfloat(psnr, >, 30);
  task_clear(&t);
  picture_clear(&truth);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/lines/go-on", lines_go_on);
  g_test_add_func("/lines/dashes", dashes_do_not_stop_it);
  g_test_add_func("/lines/others", others_do_not);
  test_add_judged("/lines/markings", markings_keep_both_edges);
  g_test_add_func("/lines/boards", boards_run);
  g_test_add_func("/lines/out-of-the-picture", boards_run_out_of_the_picture);
  g_test_add_func("/lines/one-by-one", boards_are_filled_one_by_one);
  g_test_add_func("/lines/converging", converging_edges_stay);
  g_test_add_func("/lines/pier", boards_of_a_pier_run);
  g_test_add_func("/lines/tiles", tiles_do_not);
  g_test_add_func("/lines/sides", textures_keep_to_their_sides);
  g_test_add_func("/lines/same-bytes", same_for_threads);
  return g_test_run();
}
