/* What the plane engine fills, on drawn planes, through the public interface. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

#define WIDTH 200
#define HEIGHT 150
static const area everything = {0, 0, 1 << 20, 1 << 20};
static const area middle = {80, 60, 120, 95};

static task brick_task(recede_type type, double slant, double tilt, const char *settings) {
  task t = task_new(picture_of_plane(WIDTH, HEIGHT, 3, type, bricks, 14, slant, tilt), settings);
  t.params.slant_deg = slant;
  t.params.tilt_deg = tilt;
  return t;
}
static task grain_task(double slant, const char *settings) {
  task t =
      task_new(picture_of_plane(WIDTH, HEIGHT, 3, RECEDE_FLOAT, grains, 5, slant, 0), settings);
  t.params.slant_deg = slant;
  return t;
}

static guint64 hash_of(int threads, int kernel, gint64 seed, const char *settings) {
  task t = brick_task(RECEDE_U8, 50, 20, settings);
  task_hole(&t, (area){60, 40, 140, 110});
  t.host.threads = threads;
  t.host.kernel = kernel;
  t.params.seed = seed;
  task_succeeds(&t);
  guint64 hash = t.report.output_hash;
  task_clear(&t);
  return hash;
}

static guint64 hash_with(int threads, int kernel, gint64 seed) {
  return hash_of(threads, kernel, seed, "quality=draft");
}
static guint64 raised_hash(int threads, int kernel) {
  return hash_of(threads, kernel, 7, "quality=draft surface=raised");
}

/* The bytes of one fill, on every machine and by every compiler. Whoever changes the engine on
 * purpose puts the new hash here. */
#define HELD_HASH 0x935502b00876eff9u

static void held_bytes(void) { g_assert_cmphex(hash_with(2, -1, 7), ==, HELD_HASH); }

static void same_for_threads_and_kernels(void) {
  static const int threads[] = {2, 3, 8};
  guint64 hash = hash_with(1, -1, 7);
  for (guint i = 0; i < G_N_ELEMENTS(threads); i++)
    g_assert_cmphex(hash_with(threads[i], -1, 7), ==, hash);
  g_assert_cmphex(hash_with(1, -1, 8), !=, hash);
  g_assert_cmphex(raised_hash(1, -1), ==, raised_hash(3, 0));
  g_assert_cmphex(raised_hash(1, -1), !=, hash);
  for (int kernel = 0; kernel < 4; kernel++) {
    task t = brick_task(RECEDE_U8, 50, 20, "quality=draft");
    task_hole(&t, (area){60, 40, 140, 110});
    t.host.kernel = kernel;
    t.params.seed = 7;
    task_run(&t);
    g_test_message("kernel %d: %s", kernel, t.status ? t.message : "runs");
    if (t.status == RECEDE_OK)
      g_assert_cmphex(t.report.output_hash, ==, hash);
    else
      g_assert_cmpint(t.status, ==, RECEDE_ARGUMENT); /* not on this machine; the first two are */
    g_assert_true(t.status == RECEDE_OK || kernel > 1);
    task_clear(&t);
  }
}

/* Periodic bricks are known exactly behind the hole. Filled without perspective they are not. */
static double brick_psnr(double slant, double tilt, const char *settings) {
  task t = brick_task(RECEDE_FLOAT, slant, tilt, settings);
  task_hole(&t, middle);
  picture truth = picture_copy(&t.image);
  picture_fill(&t.image, middle, 0);
  task_succeeds(&t);
  double psnr = masked_psnr(&t.result, &truth, &t.mask);
  g_test_message("slant %.0f, tilt %.0f, %s: %.1f dB", slant, tilt, settings, psnr);
  picture_clear(&truth);
  task_clear(&t);
  return psnr;
}

static void lattice_goes_on(void) {
  static const double angles[][2] = {{50, 35}, {0, 0}, {30, 0}, {50, 0}, {60, -90}, {45, 180}};
  for (int i = 0; i < some_of(G_N_ELEMENTS(angles)); i++)
    g_assert_cmpfloat(brick_psnr(angles[i][0], angles[i][1], ""), >, 20);
  g_assert_cmpfloat(brick_psnr(60, 0, ""), >, brick_psnr(60, 0, "orientation=frontal") + 3);
}

/* The filled part is as rough as the known part, in every strip of it. */
static void assert_textured(const task *t, const char *name) {
  double known = moments_of(&t->image, &t->mask, false, everything, 0).deviation;
  moments all = moments_of(&t->result, &t->mask, true, everything, 0);
  g_test_message("%s: deviation %.3f, known %.3f; magnified %d up to %.2f. %s", name, all.deviation,
                 known, (int)t->report.magnified_pixels, t->report.largest_magnification,
                 t->report.warning);
  g_assert_cmpfloat(all.deviation, >, .5 * known);
  g_assert_cmpfloat(all.deviation, <, 1.6 * known);
  g_assert_null(strstr(t->report.warning, "found no source"));
}

static void filled_wherever_the_hole_is(void) {
  static const struct {
    const char *name;
    area hole;
    bool magnified;
  } holes[] = {
      {"left border", {0, 50, 40, 90}, false},
      {"right border", {165, 50, WIDTH, 90}, false},
      {"near left corner", {0, 115, 40, HEIGHT}, false},
      {"far right corner", {160, 0, WIDTH, 30}, false},
      {"full width", {0, 60, WIDTH, 90}, false},
      {"full height", {85, 0, 115, HEIGHT}, false},
      {"nearest the viewer", {0, 105, WIDTH, HEIGHT}, true},
      {"farthest", {0, 0, WIDTH, 30}, false},
  };
  for (guint n = 0; n < 2 * G_N_ELEMENTS(holes); n++) {
    guint i = n / 2;
    task t = grain_task(55, n & 1 ? "quality=draft surface=raised" : "quality=draft surface=flat");
    g_test_message("surface %s", n & 1 ? "raised" : "flat");
    task_hole(&t, holes[i].hole);
    task_succeeds(&t);
    g_assert_cmpuint(
        t.report.filled_pixels, ==,
        (guint64)((holes[i].hole.x1 - holes[i].hole.x0) * (holes[i].hole.y1 - holes[i].hole.y0)));
    assert_textured(&t, holes[i].name);
    if (holes[i].magnified) {
      g_assert_cmpuint(t.report.magnified_pixels, >, 0);
      g_assert_cmpfloat(t.report.largest_magnification, >, 1.25);
      g_assert_nonnull(strstr(t.report.warning, "magnified"));
    }
    task_clear(&t);
  }
}

/* The horizon of slant 78 lies 45.6 px above the middle: at y = 28.9. */
static void horizon_crosses_the_hole(void) {
  task t = grain_task(78, "quality=draft");
  const area hole = {70, 10, 130, 90};
  for (int y = 0; y < HEIGHT; y++) /* a sky */
    for (int x = 0; x < WIDTH; x++)
      if (y < 29)
        for (int k = 0; k < 3; k++) picture_set(&t.image, x, y, k, k == 2 ? 1.f : .1f);
  task_hole(&t, hole);
  task_succeeds(&t);
  g_assert_cmpuint(t.report.refused_pixels, >=, 60 * 18);
  g_assert_cmpuint(t.report.refused_pixels, <, 60 * 26);
  g_assert_cmpuint(t.report.refused_pixels + t.report.filled_pixels, ==, 60 * 80);
  g_assert_nonnull(strstr(t.report.warning, "beyond the horizon"));
  for (int y = hole.y0; y < 29; y++)
    for (int x = hole.x0; x < hole.x1; x++)
      for (int k = 0; k < 3; k++)
        g_assert_cmpfloat(picture_get(&t.result, x, y, k), ==, picture_get(&t.image, x, y, k));
  const area lower = {70, 45, 130, 90};
  g_assert_cmpfloat(moments_of(&t.result, &t.mask, true, lower, 0).deviation, >, .06);
  double red = moments_of(&t.result, &t.mask, true, lower, 0).mean;
  double blue = moments_of(&t.result, &t.mask, true, lower, 2).mean;
  g_test_message("refused %d; red %.3f, blue %.3f", (int)t.report.refused_pixels, red, blue);
  g_assert_cmpfloat(fabs(red - blue), <, .05);
  task_clear(&t);
}

/* Of who stands on a floor only the feet are below its horizon: they tell the plane's side. A
 * ceiling's lamp that hardly reaches below it does not. */
static void feet_tell_the_side(void) {
  static const struct {
    area hole;
    double tilt_deg;
  } holes[] = {{{90, 5, 110, 85}, 0}, {{90, 5, 110, 72}, 0}, {{90, 5, 110, 66}, 180}};
  for (guint i = 0; i < G_N_ELEMENTS(holes); i++) {
    task t = task_new(picture_of_plane(WIDTH, HEIGHT, 3, RECEDE_FLOAT, grains, 5, 30, 0),
                      "quality=draft orientation=horizon horizon=0,60,200,60");
    task_hole(&t, holes[i].hole);
    task_succeeds(&t);
    g_assert_cmpfloat(fabs(t.report.orientation.tilt_deg), ==, holes[i].tilt_deg);
    task_clear(&t);
  }
}

static void all_beyond_the_horizon(void) {
  task t = grain_task(78, "");
  task_hole(&t, (area){70, 2, 130, 24});
  task_run(&t);
  g_assert_cmpint(t.status, ==, RECEDE_EMPTY_TARGET);
  g_assert_nonnull(strstr(t.message, "horizon"));
  g_assert_true(task_result_untouched(&t));
  task_clear(&t);
}

/* The right half is of another colour, and no source: the bricks of the left half go on. */
static void source_is_respected(void) {
  static const float poisons[] = {1.f, 40.f};
  for (guint i = 0; i < G_N_ELEMENTS(poisons); i++) {
    task t = brick_task(RECEDE_FLOAT, 40, 0, "");
    const area hole = {35, 55, 65, 90};
    picture truth = picture_copy(&t.image);
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 120; x < WIDTH; x++)
        for (int k = 0; k < 3; k++)
          picture_set(&t.image, x, y, k, k == 1 ? 0 : poisons[i] * (float)noise_at(x, y, 9));
    t.source = picture_new(WIDTH, HEIGHT, 1, RECEDE_U8);
    picture_fill(&t.source, (area){0, 0, 115, HEIGHT}, 1);
    task_hole(&t, hole);
    task_succeeds(&t);
    double psnr = masked_psnr(&t.result, &truth, &t.mask);
    g_test_message("right half up to %.0f: %.1f dB", poisons[i], psnr);
    g_assert_cmpfloat(psnr, >, 24);
    picture_clear(&truth);
    task_clear(&t);
  }
}

static void synthesis_keeps_the_exemplar(void) {
  for (int channels = 1; channels <= 4; channels++) {
    task t = task_new(picture_of_plane(96, 72, channels, RECEDE_U8, grains, 5, 35, 0),
                      "slant=35 quality=draft");
    task_synthesize(&t, 161, 120);
    g_assert_cmpstr(t.message, ==, "");
    g_assert_cmpuint(t.report.peak_bytes, <=, t.report.estimated_bytes);
    for (int y = 0; y < 72; y++)
      g_assert_cmpint(memcmp(t.result.pixels + ((24 + y) * 161 + 32) * channels,
                             t.image.pixels + y * 96 * channels, 96u * (gsize)channels),
                      ==, 0);
    picture canvas = picture_new(161, 120, 1, RECEDE_U8);
    picture_fill(&canvas, (area){32, 24, 32 + 96, 24 + 72}, 1);
    double made = moments_of(&t.result, &canvas, false, everything, 0).deviation;
    double known = moments_of(&t.result, &canvas, true, everything, 0).deviation;
    g_test_message("%d channels: deviation %.3f, exemplar %.3f", channels, made, known);
    g_assert_cmpfloat(made, >, .5 * known);
    if (channels == 2 || channels == 4)
      g_assert_cmpfloat(moments_of(&t.result, &canvas, false, everything, channels - 1).least, ==,
                        1);
    picture_clear(&canvas);
    task_clear(&t);
  }
}

/* All of a result smaller than the exemplar is the exemplar's. */
static void synthesis_may_cut(void) {
  task t = task_new(picture_of_plane(96, 72, 3, RECEDE_U8, grains, 5, 0, 0), "orientation=frontal");
  task_synthesize(&t, 60, 50);
  g_assert_cmpstr(t.message, ==, "");
  task_clear(&t);
}

/* Near the horizon no whole patch of the exemplar is small enough: the texture goes on all the
 * same.
 */
static void texture_reaches_the_horizon(void) {
  enum { SEEDS = 4 };
  double far = 0, known = 0;
  for (int seed = 0; seed < SEEDS; seed++) {
    task t = task_new(picture_of_plane(96, 72, 1, RECEDE_U8, grains, 5, 64, 0),
                      "slant=64 quality=draft");
    t.params.seed = seed;
    task_synthesize(&t, 240, 240);
    picture canvas = picture_new(240, 240, 1, RECEDE_U8);
    far += moments_of(&t.result, &canvas, false, (area){0, 5, 240, 15}, 0).deviation / SEEDS;
    known += moments_of(&t.image, &canvas, false, (area){0, 0, 96, 20}, 0).deviation / SEEDS;
    g_test_message("%s", t.report.warning);
    g_assert_nonnull(strstr(t.report.warning, "continue what is beside them"));
    g_assert_null(strstr(t.report.warning, "smooth tone alone"));
    picture_clear(&canvas);
    task_clear(&t);
  }
  g_test_message("deviation %.4f, exemplar's far end %.4f", far, known);
  g_assert_cmpfloat(far, >, .2 * known);
}

/* Over before they could ask; and the next call is not cancelled by what was meant for them. */
static void short_calls_can_be_cancelled(void) {
  task t = task_new(picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, grains, 6, 40, 0), "slant=40");
  recede_job *job = recede_job_new(NULL);
  recede_orientation found = {.slant_deg = -1};
  uint64_t bytes;
  double seconds;
  task_hole(&t, (area){40, 40, 70, 60});
  recede_job_set_image(job, &t.image.view);
  recede_job_set_mask(job, &t.mask.view);
  recede_job_set_params(job, &t.params);
  recede_job_cancel(job);
  g_assert_cmpint(recede_job_estimate_fill(job, &bytes, &seconds), ==, RECEDE_CANCELLED);
  g_assert_cmpint(recede_job_estimate_fill(job, &bytes, &seconds), ==, RECEDE_OK);
  recede_job_cancel(job);
  g_assert_cmpint(recede_job_orient(job, &found), ==, RECEDE_CANCELLED);
  g_assert_cmpfloat(found.slant_deg, ==, -1);
  g_assert_cmpint(recede_job_orient(job, &found), ==, RECEDE_OK);
  g_assert_cmpfloat(fabs(found.slant_deg - 40), <, 1e-6);
  recede_job_free(&job);
  task_clear(&t);
}

/* Also while starts are tried side by side. */
static int goes_on(void *user, const char *stage, double fraction) {
  double *last = user;
  g_assert_nonnull(stage);
  g_assert_cmpfloat(fraction, >=, *last);
  *last = fraction;
  return 0;
}

static void progress_only_grows(void) {
  for (int threads = 1; threads <= 3; threads++) {
    task t = task_new(picture_of_plane(480, 360, 3, RECEDE_U8, grains, 6, 40, 0), "slant=40");
    double last = 0;
    t.host.threads = threads, t.host.progress = goes_on, t.host.user = &last;
    task_hole(&t, (area){160, 120, 320, 280});
    task_succeeds(&t);
    g_assert_cmpfloat(last, >, .9);
    task_clear(&t);
  }
}

static recede_surface surface_of(picture image, double slant) {
  task t = task_new(image, "surface=auto quality=draft engine-iterations=1");
  t.params.slant_deg = slant;
  task_hole(&t, (area){200, 160, 260, 200});
  task_succeeds(&t);
  task_clear(&t);
  return t.report.surface;
}

static void surface_is_told(void) {
  g_assert_cmpint(surface_of(picture_of_plane(480, 360, 1, RECEDE_U8, bricks, 16, 50, 0), 50), ==,
                  RECEDE_SURFACE_FLAT);
  g_assert_cmpint(surface_of(picture_of_discs(480, 360, 14, 50), 50), ==, RECEDE_SURFACE_RAISED);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/plane/same-bytes", same_for_threads_and_kernels);
  g_test_add_func("/plane/held", held_bytes);
  g_test_add_func("/plane/lattice", lattice_goes_on);
  g_test_add_func("/plane/feet", feet_tell_the_side);
  test_add_judged("/plane/places", filled_wherever_the_hole_is);
  g_test_add_func("/plane/horizon", horizon_crosses_the_hole);
  g_test_add_func("/plane/beyond", all_beyond_the_horizon);
  g_test_add_func("/plane/source", source_is_respected);
  g_test_add_func("/plane/synthesis", synthesis_keeps_the_exemplar);
  g_test_add_func("/plane/cut", synthesis_may_cut);
  test_add_judged("/plane/far", texture_reaches_the_horizon);
  g_test_add_func("/plane/cancel", short_calls_can_be_cancelled);
  g_test_add_func("/plane/progress", progress_only_grows);
  g_test_add_func("/plane/surface", surface_is_told);
  return g_test_run();
}
