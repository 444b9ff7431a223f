/* Orientation read from pictures that this test draws: a texture on a plane of known angles, seen
 * through the inverse map that the test computes on its own. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "recede.h"

#define SIDE 384
#define RADIAN (G_PI / 180)
#define FOV 50

typedef enum { BRICKS, DOTS, NOISE, PIER } texture_kind;

/* A repeatable number in 0..1 for a place: not the library's generator. */
static double chance(int x, int y, int n) {
  uint32_t v = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)n * 83492791u;
  v = (v ^ 61) ^ v >> 16;
  v *= 9;
  v ^= v >> 4;
  v *= 0x27d4eb2d;
  v ^= v >> 15;
  return (double)v / 4294967296.;
}

static double bricks(double u, double v) {
  int row = (int)floor(v / 18);
  double along = u / 36 + (row % 2 ? .5 : 0);
  double x = (along - floor(along)) * 36, y = v - row * 18.;
  return x < 3 || y < 3 ? .85 : .25 + .35 * chance((int)floor(along), row, 1);
}

static double dots(double u, double v) {
  int cx = (int)floor(u / 16), cy = (int)floor(v / 16);
  double value = .3;
  for (int y = cy - 1; y <= cy + 1; y++)
    for (int x = cx - 1; x <= cx + 1; x++) {
      double dx = u - 16 * (x + chance(x, y, 2)), dy = v - 16 * (y + chance(x, y, 3));
      if (hypot(dx, dy) < 3 + 4 * chance(x, y, 4)) value = .2 + .7 * chance(x, y, 5);
    }
  return value;
}

/* Boards across, between two rails of two beams each, in water. */
static double pier(double u, double v) {
  double board = v / 14 - floor(v / 14);
  if (fabs(u) > 90) return .55 + .02 * chance((int)floor(u / 6), (int)floor(v / 2), 8);
  if (fabs(u) > 80) return fabs(u) > 84 && fabs(u) < 86 ? .4 : .75;
  return board < .12 ? .1 : .3 + .06 * chance((int)floor(u / 40), (int)floor(v), 9);
}

static double texture(texture_kind kind, double u, double v) {
  switch (kind) {
    case BRICKS: return bricks(u, v);
    case DOTS: return dots(u, v);
    case PIER: return pier(u, v);
    default: return chance((int)floor(u / 2), (int)floor(v / 2), 6);
  }
}

/* One texel is 1 px at (on_x, on_y); 4 x 4 samples a pixel; beyond the horizon a plain sky. */
static void draw(texture_kind kind, double slant, double tilt, double on_x, double on_y,
                 guint8 *gray) {
  double s = slant * RADIAN, t = tilt * RADIAN, f = .5 * SIDE / tan(FOV * RADIAN / 2),
         c = .5 * (SIDE - 1);
  double n[3] = {-sin(s) * sin(t), sin(s) * cos(t), cos(s)};
  double w0 = (n[0] * (on_x - c) + n[1] * (on_y - c)) / f + n[2];
  /* Two axes in the plane, at right angles to n and to one another. */
  double a[3] = {cos(t), sin(t), 0};
  double b[3] = {n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]};
  for (int y = 0; y < SIDE; y++)
    for (int x = 0; x < SIDE; x++) {
      double sum = 0;
      for (int k = 0; k < 16; k++) {
        double r[3] = {(x + (k % 4 - 1.5) / 4 - c) / f, (y + (k / 4 - 1.5) / 4 - c) / f, 1};
        double w = (n[0] * r[0] + n[1] * r[1] + n[2]) / w0;
        if (w < .02) {
          sum += .8;
          continue;
        }
        double u = (a[0] * r[0] + a[1] * r[1] + a[2]) * f / w,
               v = (b[0] * r[0] + b[1] * r[1] + b[2]) * f / w;
        sum += texture(kind, u, v);
      }
      gray[y * SIDE + x] = (guint8)(sum / 16 * 255 + .5);
    }
}

/* n . r: what is nearer faces more of it, for its distance. */
static double facing(double slant, double tilt, int x, int y) {
  double s = slant * RADIAN, t = tilt * RADIAN, f = .5 * SIDE / tan(FOV * RADIAN / 2),
         c = .5 * (SIDE - 1);
  return (-sin(s) * sin(t) * (x - c) + sin(s) * cos(t) * (y - c)) / f + cos(s);
}

#define FLOOR_SLANT 80
#define WALL_SLANT 65

/* A floor, and a wall of the same on its left that recedes to the right, twice as far off. */
static void draw_street(guint8 *gray) {
  guint8 *wall = g_new(guint8, SIDE * SIDE);
  draw(DOTS, FLOOR_SLANT, 0, .5 * SIDE, .9 * SIDE, gray);
  draw(DOTS, WALL_SLANT, 90, .2 * SIDE, .4 * SIDE, wall);
  for (int i = 0; i < SIDE * SIDE; i++)
    if (facing(WALL_SLANT, 90, i % SIDE, i / SIDE) > 2 * facing(FLOOR_SLANT, 0, i % SIDE, i / SIDE))
      gray[i] = wall[i];
  g_free(wall);
}

#define FINER 3

/* Blades that stand up from a floor, far ones first, drawn finer and averaged. */
static void draw_blades(double slant, guint8 *gray) {
  int side = FINER * SIDE;
  double most = facing(slant, 0, 0, SIDE - 1);
  guint8 *fine = g_new(guint8, side * side);
  memset(fine, 90, (gsize)(side * side));
  for (int y = 0; y < side + 50 * FINER; y++) {
    double w = facing(slant, 0, 0, y / FINER) / most;
    if (w < .04) continue;
    /* As many on each part of the plane, 1 / w^3 of them in one of the picture. */
    int count = (int)(SIDE * fmin(3, .004 / (w * w * w)) / FINER + chance(0, y, 10));
    for (int i = 0; i < count; i++) {
      double x = side * chance(i, y, 11), lean = .3 * (chance(i, y, 12) - .5);
      guint8 shade = (guint8)(20 + 220 * chance(i, y, 13));
      for (int up = 0; up < (int)(FINER * 50 * w); up++) {
        int from = (int)(x + lean * up), to = (int)(x + lean * up + FINER * 5 * w);
        for (int px = MAX(from, 0); px < MIN(to, side) && y >= up && y - up < side; px++)
          fine[(y - up) * side + px] = shade;
      }
    }
  }
  for (int i = 0; i < SIDE * SIDE; i++) {
    int sum = 0;
    for (int k = 0; k < FINER * FINER; k++)
      sum += fine[(i / SIDE * FINER + k / FINER) * side + i % SIDE * FINER + k % FINER];
    gray[i] = (guint8)(sum / (FINER * FINER));
  }
  g_free(fine);
}

typedef struct question {
  guint8 gray[SIDE * SIDE], mask[SIDE * SIDE], source[SIDE * SIDE];
  gboolean masked, sourced;
  recede_host host;
  recede_orientation answer;
  char message[512];
} question;

static question *new_question(void) {
  question *q = g_new0(question, 1);
  recede_host_init(&q->host);
  q->host.threads = 2;
  return q;
}

static void put_hole(question *q, int x, int y, int width, int height) {
  for (int row = y; row < y + height; row++) memset(q->mask + row * SIDE + x, 255, (gsize)width);
  q->masked = TRUE;
}

static recede_status ask(question *q) {
  recede_job *job = recede_job_new(&q->host);
  recede_params params;
  recede_view image = {q->gray, SIDE, SIDE, SIDE, 1, RECEDE_U8};
  recede_view mask = {q->mask, SIDE, SIDE, SIDE, 1, RECEDE_U8};
  recede_view source = {q->source, SIDE, SIDE, SIDE, 1, RECEDE_U8};
  recede_params_init(&params);
  params.fov_deg = FOV;
  recede_job_set_params(job, &params);
  recede_job_set_image(job, &image);
  if (q->masked) recede_job_set_mask(job, &mask);
  if (q->sourced) recede_job_set_source(job, &source);
  recede_status status = recede_job_orient(job, &q->answer);
  g_strlcpy(q->message, recede_job_message(job), sizeof q->message);
  recede_job_free(&job);
  return status;
}

static double error_deg(const recede_orientation *answer, double slant, double tilt) {
  double s = slant * RADIAN, t = tilt * RADIAN;
  const double *n = answer->plane.normal;
  double dot = -n[0] * sin(s) * sin(t) + n[1] * sin(s) * cos(t) + n[2] * cos(s);
  return acos(CLAMP(dot, -1, 1)) / RADIAN;
}

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

/* The hole's plane is meant, whatever fills more of the picture. */
static void a_wall_is_not_read_as_the_floor(void) {
  question *on_floor = new_question(), *on_wall = new_question();
  draw_street(on_floor->gray);
  memcpy(on_wall->gray, on_floor->gray, sizeof on_wall->gray);
  put_hole(on_floor, 230, SIDE - 90, 50, 30);
  put_hole(on_wall, 60, 120, 40, 50);
  g_assert_cmpint(ask(on_floor), ==, RECEDE_OK);
  g_assert_cmpint(ask(on_wall), ==, RECEDE_OK);
  g_test_message("floor %.1f deg off, %.2f; wall %.1f, %.2f",
                 error_deg(&on_floor->answer, FLOOR_SLANT, 0), on_floor->answer.confidence,
                 error_deg(&on_wall->answer, WALL_SLANT, 90), on_wall->answer.confidence);
  g_assert_cmpfloat(error_deg(&on_floor->answer, FLOOR_SLANT, 0), <, 10);
  g_assert_cmpfloat(error_deg(&on_wall->answer, WALL_SLANT, 90), <, 10);
  g_assert_cmpfloat(on_floor->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_assert_cmpfloat(on_wall->answer.confidence, >, RECEDE_CONFIDENCE_LOW);
  g_free(on_floor);
  g_free(on_wall);
}

/* It does not say that the sky lies on the plane, too. */
/* Blades beside the hole look like no flat texture of this plane, and are none. */
static void a_meadow_is_no_wall(void) {
  for (int slant = 60; slant <= 70; slant += 10) {
    question *q = new_question();
    draw_blades(slant, q->gray);
    put_hole(q, 220, 240, 60, 45);
    g_assert_cmpint(ask(q), ==, RECEDE_OK);
    g_test_message("slant %d: %.1f deg off, %.2f", slant, error_deg(&q->answer, slant, 0),
                   q->answer.confidence);
    g_assert_cmpfloat(error_deg(&q->answer, slant, 0), <, 13);
    g_free(q);
  }
}

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
  g_test_add_func("/orient/known", known_planes_are_read);
  g_test_add_func("/orient/frontal", frontal_textures_stay_frontal);
  g_test_add_func("/orient/nothing", what_tells_nothing_is_not_trusted);
  g_test_add_func("/orient/two-planes", two_planes_are_not_trusted);
  g_test_add_func("/orient/horizon-inside", horizon_inside_the_picture);
  g_test_add_func("/orient/few-lines", few_lines_tell_what_many_do_not);
  g_test_add_func("/orient/posts", posts_on_boards_are_no_wall);
  g_test_add_func("/orient/wall", a_wall_is_not_read_as_the_floor);
  g_test_add_func("/orient/meadow", a_meadow_is_no_wall);
  g_test_add_func("/orient/source-all", a_source_of_everything_is_none);
  g_test_add_func("/orient/threads", threads_change_nothing);
  g_test_add_func("/orient/source-only", only_the_source_is_looked_at);
  g_test_add_func("/orient/cancel", cancel_works_at_any_poll);
  g_test_add_func("/orient/no-memory", a_failing_allocation_is_told);
  return g_test_run();
}
