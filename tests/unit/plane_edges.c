/* Straight edges between things that lie side by side go on through the hole: both of a kerb, those
 * of a rail across its sleepers and of a post in front of a blind, a corner of paint, the crossing
 * of four squares. What is bright is looked at. */
#include <math.h>

#include "plane_scene.h"

#define WIDTH 640
#define HEIGHT 480
#define TEXEL_PX 20.
#define BRIGHT .9

/* How the edges lie: u and v are turned by this, and moved. */
static double cosine, sine, moved_u, moved_v;

static double grain(double u, double v, int n) {
  return .06 * smooth_noise(u, v, 6, n) + .06 * smooth_noise(u, v, 12, n + 1);
}

/* Of slabs or setts in rows, every other of which is half one off: 1 at a joint. */
static bool at_joint(double u, double v, double length, double width, double joint, double *shade) {
  double column = floor(u / length), along = v / width + .5 * fmod(fabs(column), 2);
  double in_u = u - column * length, in_v = (along - floor(along)) * width;
  *shade = noise_at((int)column, (int)floor(along), 7);
  return in_u < joint || in_v < joint;
}

static double pavement(double u, double v) {
  double shade;
  return at_joint(u, v, 6, 4, .15, &shade) ? .2 : .38 + .08 * shade + grain(u, v, 20);
}

static double setts(double u, double v) {
  double shade;
  return at_joint(u, v, 1.2, 1.6, .25, &shade) ? .08 : .2 + .2 * shade + grain(u, v, 30);
}

static double asphalt(double u, double v) { return .2 + 2 * grain(u, v, 40); }

static double street(double u, double v) {
  if (u < 0) return pavement(u, v);
  return u < 2 ? BRIGHT + .3 * grain(u, v, 50) : setts(u, v);
}

/* Among setts of all shades a dark kerb hardly stands out, and both sides are the same. */
#define KERB .25
static double alley(double u, double v) {
  double shade;
  if (fabs(u) < .3) return KERB + .5 * grain(u, v, 130);
  if (at_joint(v, u, .5, .7, .1, &shade)) return .15;
  return .3 + .5 * shade + grain(u, v, 140);
}

static double kerb_of_alley(double u, double v) {
  (void)v;
  return fabs(u) < .3 ? 1 : 0;
}

/* Large slabs, no two rows of which end alike: 1 in their joints. */
static double joint_of_slabs(double u, double v) {
  static const double ends[] = {-1e9, -13, 0, 17, 1e9}, across[] = {5, 0, -7, 11};
  int row = 0;
  while (u >= ends[row + 1]) row++;
  double to_next = fmin(u - ends[row], ends[row + 1] - u), along = v - across[row];
  double to_end = fabs(along - 26 * round(along / 26));
  return fmin(to_next, to_end) < .25 ? 1 : 0;
}

#define JOINT .1
static double slabs(double u, double v) {
  return joint_of_slabs(u, v) > 0 ? JOINT + .3 * grain(u, v, 150) : .45 + 2 * grain(u, v, 160);
}

static double railway(double u, double v) {
  double along = v / 5 - floor(v / 5);
  if (fabs(u) < .35) return BRIGHT;
  if (fabs(u) < .7) return .15;
  return along < .4 ? .4 + .5 * grain(u, 6 * v, 60) : .25 + 3 * grain(u, v, 70);
}

static double crossing(double u, double v) {
  double bar = u / 14 - floor(u / 14);
  return bar < .5 && v > 0 ? BRIGHT + .3 * grain(u, v, 80) : asphalt(u, v);
}

static double squares(double u, double v) {
  bool bright = ((int)floor(u / 14) + (int)floor(v / 14)) % 2 == 0;
  return bright ? BRIGHT + .3 * grain(u, v, 90) : .25 + grain(u, v, 100);
}

static double window(double u, double v) {
  double slat = u / .7 - floor(u / .7);
  return fabs(v) < .85 ? BRIGHT + .1 * grain(u, v, 110) : slat < .3 ? .3 : .15 + grain(u, v, 120);
}

static double (*ground)(double u, double v);
static double draw(double u, double v, int k) {
  (void)k;
  return ground(cosine * u - sine * v + moved_u, sine * u + cosine * v + moved_v);
}

typedef struct scene {
  double (*ground)(double u, double v);
  double slant_deg, tilt_deg, direction_deg, u, v; /* what is in the picture's middle */
  area hole;
} scene;

static picture picture_of(const scene *s, double (*what)(double u, double v)) {
  ground = what, moved_u = s->u, moved_v = s->v;
  cosine = cos(s->direction_deg * G_PI / 180), sine = sin(s->direction_deg * G_PI / 180);
  return picture_of_plane(WIDTH, HEIGHT, 1, RECEDE_U8, draw, TEXEL_PX, s->slant_deg, s->tilt_deg);
}

static task filled(const scene *s, bool round) {
  task t = task_new(picture_of(s, s->ground), "quality=draft");
  t.params.slant_deg = s->slant_deg, t.params.tilt_deg = s->tilt_deg;
  if (round)
    task_round_hole(&t, s->hole);
  else
    task_hole(&t, s->hole);
  task_succeeds(&t);
  task_assert_outside(&t);
  return t;
}

static double right_of(const scene *s, bool round) {
  picture truth = picture_of(s, s->ground);
  task t = filled(s, round);
  paint p = task_paint(&t, &truth, s->hole);
  task_clear(&t);
  picture_clear(&truth);
  g_test_message("slant %.0f, tilt %.0f, direction %.0f, %s hole at %d,%d: %.0f of %.0f px, %.2f",
                 s->slant_deg, s->tilt_deg, s->direction_deg, round ? "round" : "square",
                 s->hole.x0, s->hole.y0, p.right, p.all, p.right / p.all);
  return p.right / p.all;
}

static void go_on(const scene *scenes, int count, double least) {
  double sum = 0;
  int fills = some_of(2 * count);
  for (int i = 0; i < fills; i++) sum += right_of(&scenes[i / 2], i % 2) / fills;
  g_test_message("together %.3f", sum);
  g_assert_cmpfloat(sum, >, least);
}

#define MIDDLE \
  { 240, 180, 400, 300 }

static void kerbs(void) {
  static const scene scenes[] = {
      {street, 55, -5, 10, 1.5, 0, MIDDLE},
      {street, 60, 0, -20, 1, 0, MIDDLE},
  };
  go_on(scenes, G_N_ELEMENTS(scenes), .92);
}

/* Of the pixels that lie well within what is 1 the part that is of that brightness. */
static double part_of(const scene *s, bool round, double (*what)(double u, double v),
                      double brightness) {
  picture inside_of = picture_of(s, what);
  task t = filled(s, round);
  double right = 0, all = 0;
  for (int y = s->hole.y0; y < s->hole.y1; y++)
    for (int x = s->hole.x0; x < s->hole.x1; x++) {
      bool inside = picture_get(&t.mask, x, y, 0) > 0;
      for (int k = 0; k < 9 && inside; k++)
        inside = picture_get(&inside_of, x - 1 + k % 3, y - 1 + k / 3, 0) > .9;
      all += inside, right += inside && fabs(picture_get(&t.result, x, y, 0) - brightness) < .1;
    }
  task_clear(&t);
  picture_clear(&inside_of);
  g_test_message("slant %.0f, tilt %.0f, direction %.0f, %s hole: %.0f of %.0f px", s->slant_deg,
                 s->tilt_deg, s->direction_deg, round ? "round" : "square", right, all);
  return right / all;
}

static void kerbs_among_setts(void) {
  static const scene scenes[] = {
      {alley, 55, -5, 10, .3, 0, MIDDLE},  {alley, 60, 0, -20, 0, 0, MIDDLE},
      {alley, 65, 5, 60, -.3, 0, MIDDLE},  {alley, 70, 0, 75, 0, 0, MIDDLE},
      {alley, 60, 0, -60, .3, .5, MIDDLE}, {alley, 55, 5, 35, .3, .5, MIDDLE},
  };
  double sum = 0;
  for (guint i = 0; i < 2 * G_N_ELEMENTS(scenes); i++)
    sum += part_of(&scenes[i / 2], i % 2, kerb_of_alley, KERB) / (2 * G_N_ELEMENTS(scenes));
  g_test_message("together %.3f", sum);
  g_assert_cmpfloat(sum, >, .7);
}

static void slabs_joints(void) {
  static const scene scenes[] = {
      {slabs, 55, -5, 15, 0, 0, MIDDLE},  {slabs, 60, 0, -35, 0, 0, MIDDLE},
      {slabs, 50, 10, 70, 0, -7, MIDDLE}, {slabs, 60, 40, 20, .5, -7, MIDDLE},
      {slabs, 0, 0, 25, 0, .5, MIDDLE},
  };
  double sum = 0;
  for (guint i = 0; i < 2 * G_N_ELEMENTS(scenes); i++)
    sum += part_of(&scenes[i / 2], i % 2, joint_of_slabs, JOINT) / (2 * G_N_ELEMENTS(scenes));
  g_test_message("together %.3f", sum);
  g_assert_cmpfloat(sum, >, .93);
}

static void rails(void) {
  static const scene scenes[] = {
      {railway, 60, 0, 15, 0, 0, MIDDLE},
      {railway, 55, 0, -30, .5, 0, MIDDLE},
      {railway, 65, 5, 5, -.5, 0, MIDDLE},
  };
  go_on(scenes, G_N_ELEMENTS(scenes), .85);
}

static void posts(void) {
  static const scene scenes[] = {
      {window, 70, 90, 0, 0, 0, {270, 140, 370, 340}},
      {window, 50, 90, 0, .5, 0, {270, 140, 370, 340}},
      {window, 30, -90, 0, -.5, 0, {250, 150, 390, 330}},
  };
  go_on(scenes, G_N_ELEMENTS(scenes), .9);
}

static void corners(void) {
  static const scene scenes[] = {
      {crossing, 50, 0, 15, 6, 1, MIDDLE},
      {crossing, 60, -10, -20, 7, -1, MIDDLE},
      {crossing, 40, 20, 40, 0, 1, MIDDLE},
  };
  go_on(scenes, G_N_ELEMENTS(scenes), .8);
}

static void crossings(void) {
  static const scene scenes[] = {
      {squares, 45, 0, 20, 0, 0, MIDDLE},
      {squares, 55, 10, 30, 1, 1, MIDDLE},
  };
  go_on(scenes, G_N_ELEMENTS(scenes), .9);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/edges/kerbs", kerbs);
  test_add_judged("/edges/kerbs-among-setts", kerbs_among_setts);
  test_add_judged("/edges/slabs", slabs_joints);
  g_test_add_func("/edges/rails", rails);
  g_test_add_func("/edges/posts", posts);
  g_test_add_func("/edges/corners", corners);
  g_test_add_func("/edges/crossings", crossings);
  return g_test_run();
}
