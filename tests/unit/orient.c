/* Orientation read from pictures that this test draws: a texture on a plane of known angles, seen
 * through the inverse map that the test computes on its own. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "orient_scene.h"

static void check(texture_kind kind, double slant, double tilt, double bound) {
  question *q = new_question();
  draw(kind, slant, tilt, .5 * SIDE, .5 * SIDE, q->gray);
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  g_test_message("kind %d slant %g tilt %g: %.2f deg off, confidence %.2f", kind, slant, tilt,
                 error_deg(&q->answer, slant, tilt), q->answer.confidence);
  g_assert_cmpfloat(error_deg(&q->answer, slant, tilt), <, bound);
  g_assert_cmpfloat(q->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_assert_true(q->answer.estimated);
  g_free(q);
}

static void known_planes_are_read(void) {
  static const double tilts[] = {-170, -95, -30, 0, 45, 120};
  for (size_t i = 0; i < G_N_ELEMENTS(tilts); i++) {
    check(BRICKS, 55, tilts[i], 4);
    check(DOTS, 45, tilts[i], 8);
  }
  check(BRICKS, 25, 60, 4);
}

/* What has no lines and is alike at many sizes is not taken for a level floor, which by chance
 * explains it nearly as well. */
static void lawns_lean_as_they_do(void) {
  for (int tilt = -90; tilt <= 90; tilt += 30) check(LAWN, 40, tilt, 6);
}

static void frontal_textures_stay_frontal(void) {
  check(BRICKS, 0, 0, 1);
  check(DOTS, 0, 0, 4);
  check(NOISE, 0, 0, 4);
}

static void assert_not_trusted(question *q) {
  recede_status status = ask(q);
  if (status == RECEDE_OK) {
    g_test_message("confidence %.2f", q->answer.confidence);
    g_assert_cmpfloat(q->answer.confidence, <, RECEDE_CONFIDENCE_LOW);
  } else {
    g_assert_cmpint(status, ==, RECEDE_NO_PLANE);
    g_assert_nonnull(strstr(q->message, "slant"));
  }
}

static void what_tells_nothing_is_not_trusted(void) {
  question *q = new_question();
  memset(q->gray, 90, sizeof q->gray);
  g_assert_cmpint(ask(q), ==, RECEDE_NO_PLANE); /* flat colour */
  for (int i = 0; i < SIDE * SIDE; i++) /* brighter towards the middle row from both sides */
    q->gray[i] = (guint8)(230 - ABS(i / SIDE - SIDE / 2));
  assert_not_trusted(q);
  g_free(q);
}

/* By chance a steep plane explains a patchwork a little better than a frontal one does. */
static void patchworks_are_seldom_trusted(void) {
  int trusted = 0, all = 0;
  question *q = new_question();
  for (int side = 4; side <= 6; side++)
    for (int n = 0; n < 8; n++, all++) {
      draw_patchwork(side, n, q->gray);
      g_assert_cmpint(ask(q), ==, RECEDE_OK);
      g_test_message("%d x %d, %d: slant %.0f tilt %.0f, confidence %.2f", side, side, n,
                     q->answer.slant_deg, q->answer.tilt_deg, q->answer.confidence);
      trusted += q->answer.confidence >= RECEDE_CONFIDENCE_LOW;
    }
  g_test_message("%d of %d are trusted", trusted, all);
  g_assert_cmpint(6 * trusted, <=, all);
  g_free(q);
}

/* The upper half recedes upwards and the lower half downwards: no one plane is both. */
static void two_planes_are_not_trusted(void) {
  question *q = new_question(), *other = new_question();
  draw(DOTS, 60, 0, .5 * SIDE, .5 * SIDE, q->gray);
  draw(DOTS, 60, 180, .5 * SIDE, .5 * SIDE, other->gray);
  memcpy(q->gray + SIDE * SIDE / 2, other->gray + SIDE * SIDE / 2, SIDE * SIDE / 2);
  assert_not_trusted(q);
  g_free(other);
  g_free(q);
}

/* A horizon inside the picture: a plain sky above it, the plane below, slant over 90 at the centre.
 */
static void horizon_inside_the_picture(void) {
  question *q = new_question();
  draw(DOTS, 94, 0, .5 * SIDE, .9 * SIDE, q->gray);
  put_hole(q, 160, SIDE - 70, 60, 30);
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  g_test_message("%.2f deg off, confidence %.2f", error_deg(&q->answer, 94, 0),
                 q->answer.confidence);
  g_assert_cmpfloat(error_deg(&q->answer, 94, 0), <, 4);
  g_assert_cmpfloat(q->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_free(q);
}
/* Hundreds of joints all run one way, and only the few lines that do not tell how far the plane
 * leans. */
static void few_lines_tell_what_many_do_not(void) {
  question *q = new_question();
  draw(PIER, 84, 0, .5 * SIDE, .8 * SIDE, q->gray);
  put_hole(q, 150, SIDE - 100, 80, 60);
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  g_test_message("slant %.1f tilt %.1f, confidence %.2f", q->answer.slant_deg, q->answer.tilt_deg,
                 q->answer.confidence);
  g_assert_cmpfloat(error_deg(&q->answer, 84, 0), <, 3);
  g_assert_cmpfloat(q->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_free(q);
}

static void assert_same_answer(const question *a, const question *b) {
  g_assert_cmpmem(a->answer.plane.normal, sizeof a->answer.plane.normal, b->answer.plane.normal,
                  sizeof b->answer.plane.normal);
  g_assert_cmpfloat(a->answer.confidence, ==, b->answer.confidence);
}

/* Uprights that stand on boards meet as far off as the boards' joints do: with these they make up a
 * plane seen from the front, which nothing lies on. */
static void posts_on_boards_are_no_wall(void) {
  question *q = new_question();
  draw(PIER, 82, 0, .5 * SIDE, .8 * SIDE, q->gray);
  for (int post = 0; post < 6; post++)
    for (int y = 40; y < 330; y++) memset(q->gray + y * SIDE + 30 + post * 65, 20, 6);
  put_hole(q, 300, SIDE - 84, 45, 45);
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  g_test_message("slant %.1f tilt %.1f, confidence %.2f", q->answer.slant_deg, q->answer.tilt_deg,
                 q->answer.confidence);
  if (q->answer.confidence >= RECEDE_CONFIDENCE_LOW)
    g_assert_cmpfloat(error_deg(&q->answer, 82, 0), <, 10);
  g_free(q);
}

/* Below a wall of boards, seen from the front, a path and kerbs that run straight away. Most lines
 * are upright, or run across, and meet nowhere in the picture. */
static void a_path_before_a_wall_is_a_floor(void) {
  enum { HORIZON = 250 }; /* px */
  question *q = new_question();
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      double across = (x - .5 * SIDE) / (y - HORIZON), nearest = floor(across / .45 + .5) * .45;
      gboolean kerb = fabs(across - nearest) * (y - HORIZON) < 1.5 && fabs(nearest) < 2;
      int board = x < SIDE / 2 ? x : y; /* upright ones on the left */
      double wall = board % 12 < 2 ? 60 : 150 + 30 * chance(board / 12, x < SIDE / 2, 2);
      double ground = kerb ? 60 : 150 + 30 * chance(x, y, 1);
      q->gray[y * SIDE + x] = (guint8)(y < HORIZON + 12 ? wall : ground);
    }
  put_hole(q, 150, 300, 80, 50);
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  double slant = 90 - atan((.5 * SIDE - HORIZON) / (.5 * SIDE / tan(25 * G_PI / 180))) * 180 / G_PI;
  g_test_message("slant %.1f tilt %.1f of %.1f, confidence %.2f", q->answer.slant_deg,
                 q->answer.tilt_deg, slant, q->answer.confidence);
  g_assert_cmpfloat(error_deg(&q->answer, slant, 0), <, 4);
  g_assert_cmpfloat(q->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_free(q);
}

/* It does not say that the sky lies on the plane, too. */
static void a_source_of_everything_is_none(void) {
  question *none = new_question(), *everything = new_question();
  draw(DOTS, 94, 0, .5 * SIDE, .9 * SIDE, none->gray);
  put_hole(none, 160, SIDE - 70, 60, 30);
  *everything = *none;
  memset(everything->source, 255, sizeof everything->source);
  everything->sourced = TRUE;
  g_assert_cmpint(ask(none), ==, RECEDE_OK);
  g_assert_cmpint(ask(everything), ==, RECEDE_OK);
  assert_same_answer(none, everything);
  g_free(none);
  g_free(everything);
}

static void threads_change_nothing(void) {
  question *one = new_question(), *many = new_question();
  draw_street(one->gray);
  put_hole(one, 60, 120, 40, 50);
  *many = *one;
  one->host.threads = 1;
  g_assert_cmpint(ask(one), ==, RECEDE_OK);
  for (int threads = 2; threads <= 3; threads++) {
    many->host.threads = threads;
    g_assert_cmpint(ask(many), ==, RECEDE_OK);
    assert_same_answer(one, many);
  }
  g_free(one);
  g_free(many);
}

/* What lies inside the mask, or outside the source, is never looked at. */
static void only_the_source_is_looked_at(void) {
  question *plain = new_question(), *soiled = new_question();
  draw(BRICKS, 45, 20, .5 * SIDE, .5 * SIDE, plain->gray);
  memset(plain->source, 255, sizeof plain->source);
  put_hole(plain, 100, 120, 150, 100);
  for (int y = 0; y < 40; y++) memset(plain->source + y * SIDE, 0, SIDE);
  plain->sourced = TRUE;
  *soiled = *plain;
  for (int i = 0; i < SIDE * SIDE; i++)
    if (soiled->mask[i] || !soiled->source[i]) soiled->gray[i] = (guint8)(255 * chance(i, 0, 7));
  g_assert_cmpint(ask(plain), ==, RECEDE_OK);
  g_assert_cmpint(ask(soiled), ==, RECEDE_OK);
  assert_same_answer(plain, soiled);
  g_assert_cmpfloat(error_deg(&plain->answer, 45, 20), <, 4);
  g_free(plain);
  g_free(soiled);
}

typedef struct cancelling {
  int calls, at;
} cancelling;

static int cancel_at(void *user, const char *stage, double fraction) {
  cancelling *c = user;
  (void)stage, (void)fraction;
  return ++c->calls >= c->at;
}

static void cancel_works_at_any_poll(void) {
  question *q = new_question();
  cancelling c = {0, G_MAXINT};
  draw_street(q->gray);
  put_hole(q, 60, 120, 40, 50);
  q->host.progress = cancel_at, q->host.user = &c;
  g_assert_cmpint(ask(q), ==, RECEDE_OK);
  int polls = c.calls;
  g_assert_cmpint(polls, >, 2);
  for (int at = 1; at < polls / 2; at++) {
    c = (cancelling){0, at};
    g_assert_cmpint(ask(q), ==, RECEDE_CANCELLED);
  }
  g_free(q);
}

static void a_failing_allocation_is_told(void) {
  question *q = new_question();
  draw_street(q->gray);
  put_hole(q, 60, 120, 40, 50);
  recede_status status = RECEDE_NO_MEMORY;
  for (int n = 1; status == RECEDE_NO_MEMORY; n++) {
    q->host.fail_allocation = (uint64_t)n;
    status = ask(q);
    g_assert_true(status == RECEDE_OK || status == RECEDE_NO_MEMORY);
    g_assert_cmpint(n, <, 200);
  }
  g_free(q);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  test_add_judged("/orient/known", known_planes_are_read);
  test_add_judged("/orient/lawns", lawns_lean_as_they_do);
  g_test_add_func("/orient/frontal", frontal_textures_stay_frontal);
  g_test_add_func("/orient/nothing", what_tells_nothing_is_not_trusted);
  test_add_judged("/orient/patchworks", patchworks_are_seldom_trusted);
  g_test_add_func("/orient/two-planes", two_planes_are_not_trusted);
  g_test_add_func("/orient/horizon-inside", horizon_inside_the_picture);
  g_test_add_func("/orient/few-lines", few_lines_tell_what_many_do_not);
  g_test_add_func("/orient/posts", posts_on_boards_are_no_wall);
  g_test_add_func("/orient/path", a_path_before_a_wall_is_a_floor);
  g_test_add_func("/orient/source-all", a_source_of_everything_is_none);
  g_test_add_func("/orient/threads", threads_change_nothing);
  g_test_add_func("/orient/source-only", only_the_source_is_looked_at);
  g_test_add_func("/orient/cancel", cancel_works_at_any_poll);
  g_test_add_func("/orient/no-memory", a_failing_allocation_is_told);
  return g_test_run();
}
