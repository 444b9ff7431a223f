/* What the plane engine does with bad pixels, tiny pictures, cancelling and little memory. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

static const area everything = {0, 0, 1 << 20, 1 << 20};
static const area hole = {40, 35, 75, 70};

static task small_task(int channels, recede_type type, const char *settings) {
  task t = task_new(picture_of_plane(120, 100, channels, type, grains, 5, 40, 0), settings);
  t.params.slant_deg = 40;
  task_hole(&t, hole);
  return t;
}

static picture filled_part(const task *t) {
  picture p =
      picture_new(hole.x1 - hole.x0, hole.y1 - hole.y0, t->image.view.channels, t->image.view.type);
  gsize pixel = t->image.view.stride_bytes / (gsize)t->image.view.width;
  for (int y = hole.y0; y < hole.y1; y++)
    memcpy(p.pixels + (gsize)(y - hole.y0) * p.view.stride_bytes,
           t->result.pixels + (gsize)y * t->result.view.stride_bytes + (gsize)hole.x0 * pixel,
           p.view.stride_bytes);
  return p;
}

static void assert_finite(const task *t) {
  for (int y = hole.y0; y < hole.y1; y++)
    for (int x = hole.x0; x < hole.x1; x++)
      for (int k = 0; k < t->result.view.channels; k++)
        g_assert_true(isfinite(picture_get(&t->result, x, y, k)));
}

static void assert_same(const picture *a, const picture *b) {
  g_assert_true(memcmp(a->pixels, b->pixels, picture_bytes(a)) == 0);
}

/* Transparent pixels all over, one of them beside the hole; their colour is read by nobody. */
static picture fill_over_transparency(float colour) {
  task t = small_task(4, RECEDE_FLOAT, "");
  for (int y = 0; y < 100; y++)
    for (int x = 0; x < 120; x++) {
      bool clear = x < 25 || (x == hole.x0 - 1 && y == 50) || (x > 90 && y > 80);
      for (int k = 0; k < 4 && clear; k++) picture_set(&t.image, x, y, k, k == 3 ? 0 : colour);
    }
  task_succeeds(&t);
  g_assert_cmpuint(t.report.nonfinite_pixels, ==, 0);
  assert_finite(&t);
  g_assert_cmpfloat(moments_of(&t.result, &t.mask, true, everything, 3).least, ==, 1);
  g_assert_cmpfloat(moments_of(&t.result, &t.mask, true, everything, 0).deviation, >, .05);
  picture part = filled_part(&t);
  task_clear(&t);
  return part;
}

static void transparent_is_never_read(void) {
  static const float colours[] = {50.f, -3.f, NAN, INFINITY};
  picture first = fill_over_transparency(0);
  for (guint i = 0; i < G_N_ELEMENTS(colours); i++) {
    picture other = fill_over_transparency(colours[i]);
    assert_same(&first, &other);
    picture_clear(&other);
  }
  picture_clear(&first);
}

static picture fill_beside_unusable(float value, float mask, const char *settings) {
  task t = small_task(3, RECEDE_FLOAT, settings);
  static const int spots[][2] = {{5, 5}, {39, 50}, {100, 60}, {60, 90}, {75, 35}, {110, 20}};
  for (int i = 0; i < (int)G_N_ELEMENTS(spots); i++)
    picture_set(&t.image, spots[i][0], spots[i][1], i % 3, value);
  picture_set(&t.image, 50, 50, 1, value); /* inside the hole */
  picture_fill(&t.mask, hole, mask);
  task_succeeds(&t);
  g_assert_cmpuint(t.report.nonfinite_pixels, ==, G_N_ELEMENTS(spots));
  assert_finite(&t);
  picture part = filled_part(&t);
  task_clear(&t);
  return part;
}

static void unusable_is_counted_and_never_a_source(void) {
  static const char *const settings[] = {"", "method=paper", "method=kwatra"};
  static const float values[] = {-INFINITY, 3e38f, -2e9f};
  for (guint m = 0; m < G_N_ELEMENTS(settings); m++) {
    picture first = fill_beside_unusable(NAN, 1, settings[m]);
    for (guint i = 0; i < G_N_ELEMENTS(values); i++) {
      picture other = fill_beside_unusable(values[i], 1, settings[m]);
      assert_same(&first, &other);
      picture_clear(&other);
    }
    picture_clear(&first);
  }
  picture blended = fill_beside_unusable(INFINITY, .5f, "");
  picture_clear(&blended);
}

/* Values from -1 to 3 are filled with values from -1 to 3, and the range of bytes is no limit. */
static void wide_values_survive(void) {
  task t = small_task(3, RECEDE_FLOAT, "");
  for (int y = 0; y < 100; y++)
    for (int x = 0; x < 120; x++)
      for (int k = 0; k < 3; k++)
        picture_set(&t.image, x, y, k, 6 * picture_get(&t.image, x, y, k) - 2);
  task_succeeds(&t);
  moments known = moments_of(&t.image, &t.mask, false, everything, 0);
  moments made = moments_of(&t.result, &t.mask, true, everything, 0);
  g_test_message("known %.2f..%.2f, made %.2f..%.2f", known.least, known.most, made.least,
                 made.most);
  g_assert_cmpfloat(made.least, <, 0);
  g_assert_cmpfloat(made.most, >, 1.5);
  g_assert_cmpfloat(made.least, >, known.least - .5 * (known.most - known.least));
  g_assert_cmpfloat(made.most, <, known.most + .5 * (known.most - known.least));
  task_clear(&t);
}

/* Deep integers and halves: task_succeeds compares what lies outside bit for bit. Halves of 1/8 to
 * just below 1 are filled with such, give or take the join's and the spline's overshoot. */
static void deep_types(void) {
  static const recede_type types[] = {RECEDE_U16, RECEDE_HALF};
  for (guint i = 0; i < G_N_ELEMENTS(types); i++)
    for (int channels = 1; channels <= 3; channels += 2) {
      picture image = picture_new(120, 100, channels, types[i]);
      for (gsize n = 0; n < picture_bytes(&image) / 2; n++) {
        guint16 value = (guint16)(0x3000 + 0xbff * noise_at((int)(n / 8), 0, 0));
        memcpy(image.pixels + 2 * n, &value, 2);
      }
      task t = task_new(image, "slant=30 quality=draft");
      task_hole(&t, hole);
      task_succeeds(&t);
      picture part = filled_part(&t);
      for (gsize n = 0; n < picture_bytes(&part) / 2; n++) {
        guint16 value;
        memcpy(&value, part.pixels + 2 * n, 2);
        if (types[i] == RECEDE_HALF) g_assert_cmpint(value & 0x7fff, <, 0x4000);
        if (types[i] == RECEDE_U16) g_assert_cmpint(value, >, 0x2000);
        if (types[i] == RECEDE_U16) g_assert_cmpint(value, <, 0x4c00);
      }
      picture_clear(&part);
      task_clear(&t);
    }
}

/* Half a mask blends half of the same fill. */
static void gray_mask_blends(void) {
  task whole = small_task(3, RECEDE_FLOAT, ""), half = small_task(3, RECEDE_FLOAT, "");
  picture_fill(&half.mask, hole, .4f); /* 102 / 255 */
  task_succeeds(&whole);
  task_succeeds(&half);
  for (int y = hole.y0; y < hole.y1; y++)
    for (int x = hole.x0; x < hole.x1; x++) {
      float expected =
          .4f * picture_get(&whole.result, x, y, 1) + .6f * picture_get(&half.image, x, y, 1);
      g_assert_cmpfloat_with_epsilon(picture_get(&half.result, x, y, 1), expected, 1e-4);
    }
  task_clear(&whole);
  task_clear(&half);
}

/* The result may be the image's own memory, and rows may have room behind them. */
static void in_place_with_padding(void) {
  task t = small_task(3, RECEDE_U8, "quality=draft");
  task_succeeds(&t);
  gsize row = t.image.view.stride_bytes, stride = row + 13;
  guint8 *padded = g_malloc(stride * 100);
  memset(padded, 0x5a, stride * 100);
  for (gsize y = 0; y < 100; y++) memcpy(padded + y * stride, t.image.pixels + y * row, row);
  recede_view view = {padded, stride, 120, 100, 3, RECEDE_U8};
  recede_job *job = recede_job_new(&t.host);
  recede_job_set_image(job, &view);
  recede_job_set_mask(job, &t.mask.view);
  recede_job_set_params(job, &t.params);
  g_assert_cmpint(recede_job_fill(job, &view), ==, RECEDE_OK);
  g_assert_cmphex(recede_job_report(job)->output_hash, ==, t.report.output_hash);
  for (gsize y = 0; y < 100; y++) {
    g_assert_true(memcmp(padded + y * stride, t.result.pixels + y * row, row) == 0);
    for (gsize i = row; i < stride; i++) g_assert_cmpint(padded[y * stride + i], ==, 0x5a);
  }
  recede_job_free(&job);
  g_free(padded);
  task_clear(&t);
}

static recede_status status_of(int width, int height, int channels, area masked) {
  task t = task_new(picture_of_plane(width, height, channels, RECEDE_FLOAT, grains, 3, 30, 0), "");
  t.params.slant_deg = 30;
  task_hole(&t, masked);
  task_run(&t);
  g_test_message("%d x %d: %s%s", width, height, t.message, t.report.warning);
  if (t.status == RECEDE_OK) {
    task_assert_outside(&t);
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) g_assert_true(isfinite(picture_get(&t.result, x, y, 0)));
  } else {
    g_assert_cmpstr(t.message, !=, "");
    g_assert_true(task_result_untouched(&t));
  }
  task_clear(&t);
  return t.status;
}

static void tiny_and_degenerate(void) {
  g_assert_cmpint(status_of(60, 50, 3, (area){0, 0, 0, 0}), ==, RECEDE_EMPTY_TARGET);
  g_assert_cmpint(status_of(60, 50, 3, (area){0, 0, 60, 50}), ==, RECEDE_EMPTY_SOURCE);
  g_assert_cmpint(status_of(1, 1, 1, (area){0, 0, 0, 0}), ==, RECEDE_EMPTY_TARGET);
  g_assert_cmpint(status_of(1, 1, 3, (area){0, 0, 1, 1}), ==, RECEDE_EMPTY_SOURCE);
  g_assert_cmpint(status_of(2, 3, 3, (area){0, 0, 1, 1}), ==, RECEDE_EMPTY_SOURCE);
  for (int edge = 2; edge < 40; edge += edge < 14 ? 1 : 6)
    for (int channels = 1; channels <= 4; channels++) {
      recede_status status = status_of(edge, edge + channels % 2, channels,
                                       (area){edge / 2, edge / 2, edge / 2 + 1, edge / 2 + 1});
      g_assert_true(status == RECEDE_OK || status == RECEDE_EMPTY_SOURCE);
    }
  g_assert_cmpint(status_of(200, 1, 3, (area){90, 0, 100, 1}), ==, RECEDE_OK);
  g_assert_cmpint(status_of(1, 200, 3, (area){0, 90, 1, 100}), ==, RECEDE_OK);
  g_assert_cmpint(status_of(9, 300, 3, (area){0, 120, 9, 160}), ==, RECEDE_OK);
}

/* A hole of which each part lies apart: single pixels over the whole picture. */
static void scattered_mask(void) {
  task t = small_task(3, RECEDE_U8, "quality=draft");
  picture_fill(&t.mask, hole, 0);
  for (int y = 4; y < 100; y += 16)
    for (int x = 3; x < 120; x += 16) picture_fill(&t.mask, (area){x, y, x + 1, y + 2}, 1);
  task_succeeds(&t);
  g_assert_cmpuint(t.report.filled_pixels, ==, 2 * 6 * 8);
  task_clear(&t);
}

static int calls_left;
static int cancel_at(void *user, const char *stage, double fraction) {
  double *last = user;
  g_assert_cmpstr(stage, !=, "");
  g_assert_cmpfloat(fraction, >=, *last);
  g_assert_cmpfloat(fraction, <=, 1);
  *last = fraction;
  return --calls_left == 0;
}

static void cancel_at_every_poll(void) {
  recede_status status = RECEDE_CANCELLED;
  int call = 0;
  while (status == RECEDE_CANCELLED) {
    task t = small_task(3, RECEDE_U8, "quality=draft engine-iterations=2");
    double last = 0;
    calls_left = ++call;
    t.host.progress = cancel_at;
    t.host.user = &last;
    t.host.threads = 1 + call % 2;
    task_run(&t);
    status = t.status;
    g_assert_true(status == RECEDE_CANCELLED ? task_result_untouched(&t) : status == RECEDE_OK);
    task_clear(&t);
  }
  g_test_message("%d polls", call - 1);
  g_assert_cmpint(call, >, 5);
}

static gpointer cancel_later(gpointer user) {
  g_usleep(3000);
  recede_job_cancel(user);
  return NULL;
}

/* From another thread; the job can be used again. */
static void cancel_from_a_thread(void) {
  task t = small_task(3, RECEDE_U8, "quality=best engine-iterations=100");
  recede_job *job = recede_job_new(&t.host);
  t.result = picture_copy(&t.image);
  memset(t.result.pixels, 0xa5, picture_bytes(&t.result));
  recede_job_set_image(job, &t.image.view);
  recede_job_set_mask(job, &t.mask.view);
  recede_job_set_params(job, &t.params);
  GThread *thread = g_thread_new("cancel", cancel_later, job);
  g_assert_cmpint(recede_job_fill(job, &t.result.view), ==, RECEDE_CANCELLED);
  g_thread_join(thread);
  g_assert_true(task_result_untouched(&t));
  task_set(&t, "quality=draft engine-iterations=1");
  recede_job_set_params(job, &t.params);
  g_assert_cmpint(recede_job_fill(job, &t.result.view), ==, RECEDE_OK);
  task_assert_outside(&t);
  recede_job_free(&job);
  task_clear(&t);
}

static void every_allocation_fails(void) {
  recede_status status = RECEDE_NO_MEMORY;
  guint64 n = 0;
  while (status == RECEDE_NO_MEMORY) {
    task t = task_new(picture_of_plane(100, 100, 3, RECEDE_U8, bricks, 9, 40, 0),
                      "slant=40 surface=auto quality=draft engine-iterations=1");
    task_hole(&t, (area){30, 25, 75, 70});
    t.host.fail_allocation = ++n;
    task_run(&t);
    status = t.status;
    if (status != RECEDE_OK) {
      g_assert_cmpint(status, ==, RECEDE_NO_MEMORY);
      g_assert_cmpstr(t.message, !=, "");
      g_assert_true(task_result_untouched(&t));
    }
    task_clear(&t);
  }
  g_test_message("%d allocations", (int)n - 1);
  g_assert_cmpuint(n, >, 20);
}

/* The estimate before the run is the run's own, and bounds its peak. */
static void check_memory(int width, int height, area masked, int channels, const char *settings,
                         int threads) {
  picture image = picture_new(width, height, channels, RECEDE_U8);
  for (gsize i = 0; i < picture_bytes(&image); i++)
    image.pixels[i] = (guint8)(255 * noise_at((int)i / 9, 0, 1));
  task t = task_new(image, "slant=40 surface=auto engine-iterations=1");
  guint64 bytes;
  double seconds;
  task_set(&t, settings);
  t.host.threads = threads;
  task_hole(&t, masked);
  recede_job *job = recede_job_new(&t.host);
  recede_job_set_image(job, &t.image.view);
  recede_job_set_mask(job, &t.mask.view);
  recede_job_set_params(job, &t.params);
  g_assert_cmpint(recede_job_estimate_fill(job, &bytes, &seconds), ==, RECEDE_OK);
  recede_job_free(&job);
  task_succeeds(&t); /* peak <= estimate */
  g_test_message("%d x %d x %d, hole %d x %d, %s: %.1f of %.1f MB", width, height, channels,
                 masked.x1 - masked.x0, masked.y1 - masked.y0, settings,
                 (double)t.report.peak_bytes / 1e6, (double)bytes / 1e6);
  g_assert_cmpuint(t.report.estimated_bytes, ==, bytes);
  task_clear(&t);
}

static void peak_within_the_estimate(void) {
  static const char *const qualities[] = {"quality=draft", "quality=normal", "quality=best"};
  for (int i = 0, channels = 1; i < 6; i++, channels = 4 - channels) {
    check_memory(64, 64, (area){20, 20, 44, 44}, channels, qualities[i / 2], 1);
    check_memory(64, 64, (area){2, 2, 62, 58}, channels, qualities[i / 2], 1);
    check_memory(300, 200, (area){100, 80, 130, 120}, channels, qualities[i / 2], 64);
  }
  check_memory(300, 200, (area){10, 20, 290, 180}, 3, qualities[1], 1);
  check_memory(300, 200, (area){10, 20, 290, 180}, 3, qualities[2], 1);
  check_memory(1400, 120, (area){50, 40, 1350, 82}, 3, qualities[2], 1);
  check_memory(1000, 700, (area){500, 400, 540, 430}, 3, qualities[0], 1);
  check_memory(1000, 700, (area){50, 300, 950, 330}, 1, qualities[0], 1);
  check_memory(1000, 700, (area){300, 200, 700, 500}, 3, qualities[0], 1);
  /* What the orientation is read from is larger than what a small hole is filled from. */
  check_memory(1000, 1000, (area){985, 985, 995, 995}, 3, "quality=draft orientation=auto", 1);
  check_memory(3000, 900, (area){2985, 885, 2995, 895}, 3, "quality=draft orientation=auto", 64);
}

static void peak_within_the_estimate_of_strips(void) {
  check_memory(60000, 1, (area){300, 0, 59700, 1}, 3, "quality=draft", 1);
  check_memory(1, 60000, (area){0, 300, 1, 59700}, 3, "quality=draft", 1);
  check_memory(60000, 3, (area){300, 1, 59700, 2}, 3, "quality=draft", 64);
}

/* One mebibyte less than the estimate is refused, and both numbers are said. */
static void too_large_is_refused(void) {
  task t = small_task(3, RECEDE_U8, "quality=draft engine-iterations=1");
  guint64 bytes;
  double seconds;
  task_succeeds(&t);
  guint64 estimate = t.report.estimated_bytes;
  for (int n = 0; n < 2; n++) {
    t.host.memory_bytes = n ? estimate : estimate - (1 << 20);
    recede_job *job = recede_job_new(&t.host);
    recede_job_set_image(job, &t.image.view);
    recede_job_set_mask(job, &t.mask.view);
    recede_job_set_params(job, &t.params);
    g_assert_cmpint(recede_job_estimate_fill(job, &bytes, &seconds), ==,
                    n ? RECEDE_OK : RECEDE_TOO_LARGE);
    g_assert_cmpuint(bytes, ==, estimate);
    recede_job_free(&job);
    task_run(&t);
    g_assert_cmpint(t.status, ==, n ? RECEDE_OK : RECEDE_TOO_LARGE);
    g_assert_true(n || task_result_untouched(&t));
    g_assert_true(n || strstr(t.message, "MiB"));
  }
  task_clear(&t);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/plane/transparent", transparent_is_never_read);
  g_test_add_func("/plane/unusable-values", unusable_is_counted_and_never_a_source);
  g_test_add_func("/plane/wide", wide_values_survive);
  g_test_add_func("/plane/deep", deep_types);
  g_test_add_func("/plane/blend", gray_mask_blends);
  g_test_add_func("/plane/in-place", in_place_with_padding);
  g_test_add_func("/plane/tiny", tiny_and_degenerate);
  g_test_add_func("/plane/scattered", scattered_mask);
  g_test_add_func("/plane/cancel", cancel_at_every_poll);
  g_test_add_func("/plane/cancel-thread", cancel_from_a_thread);
  g_test_add_func("/plane/allocations", every_allocation_fails);
  test_add_judged("/plane/memory", peak_within_the_estimate);
  g_test_add_func("/plane/memory-of-strips", peak_within_the_estimate_of_strips);
  g_test_add_func("/plane/limit", too_large_is_refused);
  return g_test_run();
}
