/* Two textures in one hole, with a rough edge or two of them, through the public interface. */
#include <math.h>

#include "plane_scene.h"

#define SLANT_DEG 50
/* Within so many px of an edge either texture will do. */
#define EDGE_PX 4
#define RAGGED_EDGE_PX 12
static const area middle = {85, 60, 225, 185}, bottom = {85, 130, 225, 240};

static double strays(double v, int edge) {
  return .8 * sin(1.7 * v + 3 * edge) + .5 * sin(4.1 * v);
}

/* Of about the same brightness. */
static double gravel(double u, double v, int k) {
  static const double colour[3] = {.62, .58, .6};
  return colour[k] * (.5 + .6 * noise_at((int)floor(2 * u), (int)floor(2 * v), 1));
}

static double lawn(double u, double v, int k) {
  static const double colour[3] = {.45, .75, .3};
  return colour[k] * (.5 + .6 * noise_at((int)floor(3 * u), (int)floor(v), 2));
}

static double verge(double u, double v, int k) {
  return u > .3 * v + strays(v, 0) ? gravel(u, v, k) : lawn(u, v, k);
}

/* The hole is wider than the path, so that no lawn of the hole's own sizes is left. */
static double path(double u, double v, int k) {
  bool inside = u > -4 + strays(v, 0) && u < 4 + strays(v, 1);
  return inside ? lawn(u, v, k) : bricks(u, v, k);
}

/* Its edges are ragged: to both sides of them lie patches of the other texture. */
static double ragged_path(double u, double v, int k) {
  double patches = sin(1.1 * u + .6 * v) + sin(.9 * v - .7 * u);
  return fabs(u) + 3 * patches < 6 ? gravel(u, v, k) : lawn(u, v, k);
}

/* A round bed of lawn, of which the hole hides the near end; seen at a slant it is an ellipse. */
static double bed(double u, double v, int k) {
  return hypot(u, v - 20) < 20 ? lawn(u, v, k) : gravel(u, v, k);
}

/* And a larger one to the left of the hole. */
static double large_bed(double u, double v, int k) {
  return hypot(u + 25, v - 4) < 26 ? lawn(u, v, k) : gravel(u, v, k);
}

static picture draw(pattern *floor) {
  return picture_of_plane(320, 240, 3, RECEDE_U8, floor, 6, SLANT_DEG, 0);
}

static bool is_lawn(const picture *p, int x, int y) {
  return picture_get(p, x, y, 1) > 1.3f * picture_get(p, x, y, 0);
}

static bool beside_an_edge(const picture *p, int x, int y, int edge_px) {
  for (int j = MAX(y - edge_px, 0); j <= MIN(y + edge_px, p->view.height - 1); j++)
    for (int i = MAX(x - edge_px, 0); i <= MIN(x + edge_px, p->view.width - 1); i++)
      if (is_lawn(p, i, j) != is_lawn(p, x, y)) return true;
  return false;
}

/* All but a margin to the left and above, so that what is looked at is not all of the picture. */
static picture most_of_it(void) {
  picture p = picture_new(320, 240, 1, RECEDE_U8);
  picture_fill(&p, (area){0, 0, 320, 240}, 0);
  picture_fill(&p, (area){30, 20, 320, 240}, 1);
  return p;
}

/* The part of the hole, but for what is so near to an edge, that has the other texture's colour. */
static double part_wrong(pattern *floor, area hole, int edge_px, const char *settings) {
  double wrong = 0, all = 0;
  for (int seed = 0; seed < some_of(3); seed++) {
    task t = task_new(draw(floor), settings);
    t.params.slant_deg = SLANT_DEG, t.params.seed = seed;
    task_hole(&t, hole);
    t.source = most_of_it();
    task_succeeds(&t);
    for (int y = hole.y0; y < hole.y1; y++)
      for (int x = hole.x0; x < hole.x1; x++) {
        if (beside_an_edge(&t.image, x, y, edge_px)) continue;
        wrong += is_lawn(&t.result, x, y) != is_lawn(&t.image, x, y), all++;
      }
    task_clear(&t);
  }
  g_test_message("%s: %.3f wrong", settings, wrong / all);
  return wrong / all;
}

/* Led through the hole as a band of tone, an edge mostly stays, too. */
#define NO_SIDES "engine-regions=0 engine-tracks=0"

static void a_verge_stays_where_it_is(void) {
  double with = part_wrong(verge, middle, EDGE_PX, ""),
         without = part_wrong(verge, middle, EDGE_PX, NO_SIDES);
  g_assert_cmpfloat(with, <, .006);
  g_assert_cmpfloat(without, >, with + .1);
}

static void a_path_goes_on(void) {
  double with = part_wrong(path, middle, EDGE_PX, "");
  g_assert_cmpfloat(with, <, .02);
  g_assert_cmpfloat(part_wrong(path, middle, EDGE_PX, NO_SIDES), >, with + .1);
}

static void a_ragged_path_goes_on(void) {
  double with = part_wrong(ragged_path, middle, RAGGED_EDGE_PX, "");
  double without = part_wrong(ragged_path, middle, RAGGED_EDGE_PX, NO_SIDES);
  g_assert_cmpfloat(with, <, .03);
  g_assert_cmpfloat(without, >, with + .1);
}

static void what_is_round_goes_round(void) {
  double with = part_wrong(bed, middle, EDGE_PX, "");
  g_assert_cmpfloat(with, <, .08); /* .35 along a straight chord */
  g_assert_cmpfloat(part_wrong(bed, middle, EDGE_PX, NO_SIDES), >, with + .1);
  g_assert_cmpfloat(part_wrong(large_bed, middle, EDGE_PX, ""), <, .1); /* .21 */
}

static void a_path_leaves_the_picture(void) {
  double with = part_wrong(path, bottom, EDGE_PX, "");
  g_assert_cmpfloat(with, <, .025); /* .03 where both sides share their sources */
  g_assert_cmpfloat(part_wrong(path, bottom, EDGE_PX, NO_SIDES), >, with + .1);
}

/* What the source leaves out is not copied, and bricks fill its place. */
static void a_path_that_is_no_source(void) {
  task t = task_new(draw(path), "");
  double green = 0;
  t.params.slant_deg = SLANT_DEG;
  task_hole(&t, middle);
  t.source = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) picture_set(&t.source, x, y, 0, abs(x - 160) > 50 ? 1.f : 0.f);
  task_succeeds(&t);
  for (int y = middle.y0 + 2 * EDGE_PX; y < middle.y1 - 2 * EDGE_PX; y++)
    for (int x = middle.x0; x < middle.x1; x++) green += is_lawn(&t.result, x, y);
  g_test_message("%.0f px of lawn", green);
  g_assert_cmpfloat(green, <, 2);
  task_clear(&t);
}

static void assert_no_regions(pattern *floor, area hole) {
  guint64 hash[2];
  for (int regions = 0; regions < 2; regions++) {
    task t = task_new(draw(floor), regions ? "" : "engine-regions=0");
    t.params.slant_deg = SLANT_DEG;
    task_hole(&t, hole);
    task_succeeds(&t);
    hash[regions] = t.report.output_hash;
    task_clear(&t);
  }
  g_assert_cmphex(hash[0], ==, hash[1]);
}

/* Joints and shades of one texture make no two. */
static void one_texture_has_none(void) {
  static pattern *const floors[] = {lawn, bricks, grains};
  for (int i = 0; i < some_of(G_N_ELEMENTS(floors)); i++) assert_no_regions(floors[i], middle);
}

static void same_for_threads(void) {
  guint64 hash = 0;
  for (int threads = 1; threads <= 3; threads++) {
    task t = task_new(draw(path), "quality=draft");
    t.params.slant_deg = SLANT_DEG;
    t.host.threads = threads, t.host.kernel = threads - 1;
    task_hole(&t, middle);
    task_succeeds(&t);
    if (threads == 1) hash = t.report.output_hash;
    g_assert_cmphex(t.report.output_hash, ==, hash);
    task_clear(&t);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/regions/verge", a_verge_stays_where_it_is);
  g_test_add_func("/regions/path", a_path_goes_on);
  test_add_judged("/regions/ragged", a_ragged_path_goes_on);
  test_add_judged("/regions/round", what_is_round_goes_round);
  test_add_judged("/regions/picture-end", a_path_leaves_the_picture);
  g_test_add_func("/regions/source", a_path_that_is_no_source);
  g_test_add_func("/regions/one", one_texture_has_none);
  g_test_add_func("/regions/same-bytes", same_for_threads);
  return g_test_run();
}
