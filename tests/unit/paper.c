/* Methods paper (repaired and literal) and kwatra through the public interface. */
#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "judged.h"
#include "recede.h"

typedef struct picture {
  recede_view view;
  guint8 *pixels;
} picture;

static picture picture_new(int width, int height, int channels) {
  picture p = {.pixels = g_new0(guint8, (gsize)width * (gsize)height * (gsize)channels)};
  p.view =
      (recede_view){p.pixels, (size_t)width * (size_t)channels, width, height, channels, RECEDE_U8};
  return p;
}
static gsize bytes_of(const picture *p) { return p->view.stride_bytes * (gsize)p->view.height; }

/* Stones that get smaller to the top, from integers only: the same on every machine. */
static picture texture_new(int width, int height) {
  picture p = picture_new(width, height, 3);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      guint32 cell = (guint32)(6 + 10 * y / height);
      guint32 h = ((guint32)x / cell * 374761393u + (guint32)y / cell * 668265263u) * 2246822519u;
      guint32 edge = (guint32)x % cell == 0 || (guint32)y % cell == 0;
      guint8 *pixel = p.pixels + ((gsize)y * (gsize)width + (gsize)x) * 3;
      for (int k = 0; k < 3; k++) pixel[k] = edge ? 40 : (guint8)(90 + (h >> (8 + 7 * k)) % 120);
    }
  return p;
}
/* A hole of the middle third. */
static picture mask_new(int width, int height) {
  picture p = picture_new(width, height, 1);
  for (int y = height / 3; y < height - height / 3; y++)
    memset(p.pixels + (gsize)y * (gsize)width + width / 3, 255, (gsize)(width - 2 * (width / 3)));
  return p;
}

typedef struct task {
  recede_host host;
  recede_params params;
  picture image, mask, result;
  recede_status status;
  recede_report report;
  char message[512];
} task;

/* settings: "key=value key=value". size 0: a fill, else a synthesis. */
static task task_new(int width, int height, int size, const char *settings) {
  task t = {.image = texture_new(width, height), .mask = mask_new(width, height)};
  t.result = size ? picture_new(size, size, 3) : picture_new(width, height, 3);
  recede_host_init(&t.host);
  t.host.threads = 1;
  recede_params_init(&t.params);
  t.params.orientation = RECEDE_ORIENTATION_ANGLES;
  t.params.slant_deg = 50;
  t.params.method = RECEDE_METHOD_PAPER;
  gchar **words = g_strsplit(settings, " ", -1);
  for (int i = 0; words[i] && *words[i]; i++) {
    gchar **pair = g_strsplit(words[i], "=", 2);
    char message[200];
    g_assert_cmpint(recede_params_set(&t.params, pair[0], pair[1], message, sizeof message), ==,
                    RECEDE_OK);
    g_strfreev(pair);
  }
  g_strfreev(words);
  return t;
}
static void task_run(task *t) {
  bool fill =
      t->result.view.width == t->image.view.width && t->result.view.height == t->image.view.height;
  recede_job *job = recede_job_new(&t->host);
  g_assert_nonnull(job);
  recede_job_set_image(job, &t->image.view);
  recede_job_set_params(job, &t->params);
  if (fill) recede_job_set_mask(job, &t->mask.view);
  t->status =
      fill ? recede_job_fill(job, &t->result.view) : recede_job_synthesize(job, &t->result.view);
  t->report = *recede_job_report(job);
  g_strlcpy(t->message, recede_job_message(job), sizeof t->message);
  recede_job_free(&job);
}
static void task_clear(task *t) {
  g_free(t->image.pixels);
  g_free(t->mask.pixels);
  g_free(t->result.pixels);
}
static recede_report report_of(int width, int height, int size, const char *settings) {
  task t = task_new(width, height, size, settings);
  task_run(&t);
  g_assert_cmpstr(t.message, ==, "");
  g_assert_cmpint(t.status, ==, RECEDE_OK);
  task_clear(&t);
  return t.report;
}

/* With r = 2 both phases lower eq. 4's energy: the search keeps the nearer match, the update is the
 * minimum (the 2 x 2 patch only nearly: it leaves out the outermost pixels of a neighbourhood). */
static void check_energy(const char *settings) {
  double before = HUGE_VAL;
  for (int iterations = 1; iterations <= 8; iterations++) {
    gchar *all = g_strdup_printf("%s paper-exponent=2 paper-levels=1 paper-histogram-gain=0 "
                                 "paper-iterations=%d",
                                 settings, iterations);
    recede_report report = report_of(64, 64, 80, all);
    g_test_message("%s: %.3f after %d", settings, report.energy, report.iterations);
    g_assert_cmpint(report.iterations, ==, iterations);
    g_assert_cmpfloat(report.energy, <, before);
    g_assert_cmpfloat(report.energy, >, 0);
    before = report.energy;
    g_free(all);
  }
}
/* One width a run: energies of two widths cannot be compared. */
static void energy_falls(void) {
  check_energy("method=paper paper-width=8 paper-width-coarse=8");
  check_energy("method=paper paper-width=16 paper-width-coarse=16");
  check_energy("method=paper paper-literal=1");
}

static const char *const methods[] = {"method=paper", "method=paper paper-literal=1",
                                      "method=kwatra"};

static void same_for_any_threads(void) {
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++)
    for (int size = 0; size <= 70; size += 70) {
      guint64 hash = 0;
      for (int threads = 1; threads <= 3; threads++) {
        task t = task_new(64, 60, size, methods[m]);
        t.host.threads = threads;
        task_run(&t);
        g_assert_cmpint(t.status, ==, RECEDE_OK);
        if (threads == 1) hash = t.report.output_hash;
        g_assert_cmphex(t.report.output_hash, ==, hash);
        task_clear(&t);
      }
    }
}

/* Differences, and ranges of histograms, that overflow to infinity. (Found by fuzzing.) */
static void huge_floats(void) {
  enum { SIDE = 24 };
  static float pixels[SIDE * SIDE];
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++) {
    task t = task_new(SIDE, SIDE, 0, methods[m]);
    for (int i = 0; i < SIDE * SIDE; i++) pixels[i] = (float)(i * 7 % 5 - 2) * 1.6e38f;
    recede_view view = {pixels, SIDE * sizeof *pixels, SIDE, SIDE, 1, RECEDE_FLOAT};
    recede_job *job = recede_job_new(&t.host);
    recede_job_set_image(job, &view);
    recede_job_set_mask(job, &t.mask.view);
    recede_job_set_params(job, &t.params);
    g_assert_cmpint(recede_job_fill(job, &view), ==, RECEDE_OK);
    for (int i = 0; i < SIDE * SIDE; i++) g_assert_true(isfinite(pixels[i]));
    recede_job_free(&job);
    task_clear(&t);
  }
}

/* The bytes of today, so that no change of them goes unnoticed. */
static void held_bytes(void) {
  static const struct {
    const char *settings;
    int size;
    guint64 hash;
  } held[] = {
      {"method=paper seed=1", 0, 0x3fe976c5e21b7ceb},
      {"method=paper seed=1", 80, 0xd2ee018e5f0541ac},
      {"method=paper paper-literal=1 seed=1", 0, 0xf5fc77006a886772},
      {"method=paper paper-literal=1 seed=1", 80, 0xddf64609a5a3cb12},
      {"method=kwatra seed=1", 0, 0xc034adad73a1ccaa},
      {"method=kwatra seed=1", 80, 0x39a475398938f0cc},
  };
  for (guint i = 0; i < G_N_ELEMENTS(held); i++) {
    guint64 hash = report_of(64, 64, held[i].size, held[i].settings).output_hash;
    g_test_message("%s, size %d: 0x%016" G_GINT64_MODIFIER "x", held[i].settings, held[i].size,
                   hash);
    if (hash != held[i].hash) g_test_fail();
  }
  g_assert_cmphex(report_of(64, 64, 80, "method=paper seed=1").output_hash, !=,
                  report_of(64, 64, 80, "method=paper seed=2").output_hash);
}

/* What a pixel may be: each channel within the exemplar's range, as means of its pixels are. */
static void filled_within_range(void) {
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++) {
    task t = task_new(64, 64, 0, methods[m]);
    for (int y = 0; y < 64; y++) /* what lies under the mask must not be read */
      for (int x = 0; x < 64; x++)
        if (t.mask.pixels[y * 64 + x]) memset(t.image.pixels + (y * 64 + x) * 3, 255, 3);
    task_run(&t);
    g_assert_cmpint(t.status, ==, RECEDE_OK);
    for (int i = 0; i < 64 * 64 * 3; i++) {
      if (t.mask.pixels[i / 3])
        g_assert_true(t.result.pixels[i] >= 40 && t.result.pixels[i] < 210);
      else
        g_assert_cmpint(t.result.pixels[i], ==, t.image.pixels[i]);
    }
    task_clear(&t);
  }
}

/* ---------------------------------------------------------------------------------- faults -- */

typedef struct countdown {
  int left, calls;
} countdown;
static int cancel_later(void *user, const char *stage, double fraction) {
  countdown *c = user;
  g_assert_nonnull(stage);
  g_assert_true(fraction >= 0 && fraction <= 1);
  c->calls++;
  return c->left-- <= 0;
}

static void cancel_at_every_call(void) {
  for (int size = 0; size <= 48; size += 48)
    for (int at = 0;; at++) {
      countdown c = {at, 0};
      task t = task_new(48, 40, size, "method=paper");
      t.host.progress = cancel_later;
      t.host.user = &c;
      memset(t.result.pixels, 77, bytes_of(&t.result));
      task_run(&t);
      bool done = t.status == RECEDE_OK;
      if (!done) {
        g_assert_cmpint(t.status, ==, RECEDE_CANCELLED);
        for (gsize i = 0; i < bytes_of(&t.result); i++) g_assert_cmpint(t.result.pixels[i], ==, 77);
      }
      task_clear(&t);
      if (done) {
        g_assert_cmpint(at, >, 20);
        break;
      }
    }
}

static void every_allocation_fails(void) {
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++)
    for (int size = 0; size <= 60; size += 60)
      for (guint64 n = 1;; n++) {
        task t = task_new(48, 48, size, methods[m]);
        t.params.paper_iterations = 1; /* more of either allocate the same again */
        t.params.paper_levels = 2;
        t.host.fail_allocation = n;
        task_run(&t);
        bool done = t.status == RECEDE_OK;
        if (!done) {
          g_assert_cmpint(t.status, ==, RECEDE_NO_MEMORY);
          g_assert_cmpint(strlen(t.message), >, 20);
          for (gsize i = 0; i < bytes_of(&t.result); i++)
            g_assert_cmpint(t.result.pixels[i], ==, 0);
        }
        task_clear(&t);
        if (done) {
          g_assert_cmpuint(n, >, 30);
          break;
        }
      }
}

static void tiny_pictures(void) {
  static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 9}, {3, 3}, {7, 5}, {8, 8}, {17, 4}, {31, 9}};
  static const int results[] = {1, 2, 5, 8, 15};
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++)
    for (guint i = 0; i < G_N_ELEMENTS(sizes); i++) {
      for (guint r = 0; r < G_N_ELEMENTS(results); r++) {
        task t = task_new(sizes[i][0], sizes[i][1], results[r] + 40 * (r == 4), methods[m]);
        if (t.image.view.width != t.result.view.width) {
          task_run(&t);
          g_assert_cmpstr(t.message, ==, "");
          for (gsize k = 0; k < bytes_of(&t.result); k++)
            g_assert_true(t.result.pixels[k] >= 40 && t.result.pixels[k] < 210);
        }
        task_clear(&t);
      }
      task t = task_new(sizes[i][0], sizes[i][1], 0, methods[m]);
      task_run(&t);
      /* The ring round the mask is no source: the smallest have none left, and say so. */
      if (t.status != RECEDE_OK) {
        g_assert_cmpint(t.status, ==, RECEDE_EMPTY_SOURCE);
        g_assert_cmpint(MIN(sizes[i][0], sizes[i][1]), <, 9);
        g_assert_cmpint(strlen(t.message), >, 20);
      }
      task_clear(&t);
    }
}

static void slants_from_90_are_refused(void) {
  for (int size = 0; size <= 40; size += 40) {
    task t = task_new(64, 64, size, "slant=95 tilt=180");
    task_run(&t);
    g_assert_cmpint(t.status, ==, RECEDE_ARGUMENT);
    g_assert_nonnull(strstr(t.message, "95"));
    task_clear(&t);
  }
}

static void memory_within_the_estimate(void) {
  for (guint m = 0; m < G_N_ELEMENTS(methods); m++)
    for (int edge = 24; edge <= 240; edge *= 3)
      for (int size = 0; size <= 150; size += 150) {
        gchar *settings = g_strconcat(methods[m], " paper-iterations=1", NULL);
        recede_report report = report_of(edge, edge + 1, size, settings);
        g_test_message("%s %d -> %d: %.1f of %.1f MB", methods[m], edge, size,
                       (double)report.peak_bytes / 1e6, (double)report.estimated_bytes / 1e6);
        g_assert_cmpuint(report.peak_bytes, <=, report.estimated_bytes);
        g_free(settings);
      }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/paper/energy", energy_falls);
  g_test_add_func("/paper/threads", same_for_any_threads);
  g_test_add_func("/paper/held", held_bytes);
  g_test_add_func("/paper/range", filled_within_range);
  g_test_add_func("/paper/cancel", cancel_at_every_call);
  g_test_add_func("/paper/allocations", every_allocation_fails);
  g_test_add_func("/paper/tiny", tiny_pictures);
  g_test_add_func("/paper/slant", slants_from_90_are_refused);
  g_test_add_func("/paper/huge-floats", huge_floats);
  test_add_judged("/paper/memory", memory_within_the_estimate);
  return g_test_run();
}
