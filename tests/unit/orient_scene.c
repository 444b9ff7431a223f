#include "orient_scene.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#define RADIAN (G_PI / 180)
#define FOV 50

/* A repeatable number in 0..1 for a place: not the library's generator. */
double chance(int x, int y, int n) {
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

/* Smooth between places side texels apart. */
static double smooth(double u, double v, double side, int n) {
  double x = u / side, y = v / side, a = x - floor(x), b = y - floor(y);
  int i = (int)floor(x), j = (int)floor(y);
  a = a * a * (3 - 2 * a), b = b * b * (3 - 2 * b);
  double upper = (1 - a) * chance(i, j, n) + a * chance(i + 1, j, n);
  double lower = (1 - a) * chance(i, j + 1, n) + a * chance(i + 1, j + 1, n);
  return (1 - b) * upper + b * lower;
}

/* Tufts, and blades in them. */
static double lawn(double u, double v) {
  double sum = .5;
  for (int k = 0; k < 5; k++) sum += .4 * (smooth(u, v, 24. / (1 << k), 30 + k) - .5);
  return fmin(fmax(sum, 0), 1);
}

static double texture(texture_kind kind, double u, double v) {
  switch (kind) {
    case BRICKS: return bricks(u, v);
    case DOTS: return dots(u, v);
    case PIER: return pier(u, v);
    case LAWN: return lawn(u, v);
    default: return chance((int)floor(u / 2), (int)floor(v / 2), 6);
  }
}

/* One texel is 1 px at (on_x, on_y); 4 x 4 samples a pixel; beyond the horizon a plain sky. */
void draw(texture_kind kind, double slant, double tilt, double on_x, double on_y, guint8 *gray) {
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

/* side x side lawns seen from above, of sizes, contrasts and brightnesses by chance: no plane. */
void draw_patchwork(int side, int n, guint8 *gray) {
  for (int i = 0; i < SIDE * SIDE; i++) {
    int column = i % SIDE * side / SIDE, row = i / SIDE * side / SIDE;
    double texels = exp2(2 * chance(column, row, 4 * n + 40) - 1);
    double u = (i % SIDE + 1000 * chance(column, row, 4 * n + 41)) * texels;
    double v = (i / SIDE + 1000 * column) * texels;
    double contrast = .5 + .5 * chance(column, row, 4 * n + 42);
    double brightness = .3 + .4 * chance(column, row, 4 * n + 43);
    double value = brightness + contrast * (lawn(u, v) - .5);
    gray[i] = (guint8)(255 * fmin(fmax(value, 0), 1) + .5);
  }
}

void draw_clouds(int n, guint8 *gray) {
  for (int i = 0; i < SIDE * SIDE; i++) {
    double x = i % SIDE, y = i / SIDE;
    double u = x + 90 * smooth(x, y, 110, 8 * n + 200), v = y + 90 * smooth(x, y, 110, 8 * n + 201);
    double contrast = 1.4 * smooth(x, y, 70, 8 * n + 202);
    double value = .5 + contrast * (lawn(u + 1000 * n, v) - .5);
    gray[i] = (guint8)(255 * fmin(fmax(value, 0), 1) + .5);
  }
}

/* n . r: what is nearer faces more of it, for its distance. */
static double facing(double slant, double tilt, int x, int y) {
  double s = slant * RADIAN, t = tilt * RADIAN, f = .5 * SIDE / tan(FOV * RADIAN / 2),
         c = .5 * (SIDE - 1);
  return (-sin(s) * sin(t) * (x - c) + sin(s) * cos(t) * (y - c)) / f + cos(s);
}

/* A floor, and a wall of the same on its left that recedes to the right, twice as far off. */
void draw_street(guint8 *gray) {
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
void draw_blades(double slant, guint8 *gray) {
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

question *new_question(void) {
  question *q = g_new0(question, 1);
  recede_host_init(&q->host);
  q->host.threads = 2;
  return q;
}

void put_hole(question *q, int x, int y, int width, int height) {
  for (int row = y; row < y + height; row++) memset(q->mask + row * SIDE + x, 255, (gsize)width);
  q->masked = TRUE;
}

recede_status ask(question *q) {
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

double error_deg(const recede_orientation *answer, double slant, double tilt) {
  double s = slant * RADIAN, t = tilt * RADIAN;
  const double *n = answer->plane.normal;
  double dot = -n[0] * sin(s) * sin(t) + n[1] * sin(s) * cos(t) + n[2] * cos(s);
  return acos(CLAMP(dot, -1, 1)) / RADIAN;
}
