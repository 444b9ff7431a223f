/* What light and the stones around it do to the tone of a fill, through the public interface. */
#include <math.h>
#include <string.h>

#include "plane_scene.h"

#define WIDTH 200
#define HEIGHT 150

/* Root mean square and mean of the step from column x - 1 to column x. */
static moments step_at(const picture *p, int x, int y0, int y1) {
  moments m = {0};
  for (int y = y0; y < y1; y++) {
    double d = picture_get(p, x, y, 0) - picture_get(p, x - 1, y, 0);
    m.mean += d / (y1 - y0);
    m.deviation += d * d / (y1 - y0);
  }
  m.deviation = sqrt(m.deviation);
  return m;
}

/* Brightness drifts by half the range: the fill follows, and its sides step no more than any column
 * of the truth. */
static void drift_leaves_no_seam(void) {
  task t = task_new(picture_of_plane(WIDTH, HEIGHT, 3, RECEDE_FLOAT, grains, 5, 40, 0), "slant=40");
  for (int y = 0; y < HEIGHT; y++)
    for (int x = 0; x < WIDTH; x++)
      for (int k = 0; k < 3; k++)
        picture_set(&t.image, x, y, k,
                    .25f * picture_get(&t.image, x, y, k) + .6f * (float)x / WIDTH);
  const area hole = {60, 45, 140, 105};
  picture truth = picture_copy(&t.image);
  task_hole(&t, hole);
  picture_fill(&t.image, hole, 0);
  task_succeeds(&t);
  for (int x = hole.x0; x < hole.x1; x += 8) {
    const area strip = {x, hole.y0, x + 8, hole.y1};
    double got = moments_of(&t.result, &t.mask, true, strip, 0).mean;
    double known = moments_of(&truth, &t.mask, true, strip, 0).mean;
    g_test_message("strip at %d: %.3f, truth %.3f", x, got, known);
    g_assert_cmpfloat(fabs(got - known), <, .05);
  }
  double usual = 0;
  for (int x = hole.x0; x <= hole.x1; x++)
    usual = fmax(usual, step_at(&truth, x, hole.y0, hole.y1).deviation);
  for (int x = hole.x0; x <= hole.x1; x += hole.x1 - hole.x0) {
    moments step = step_at(&t.result, x, hole.y0, hole.y1);
    g_test_message("step at %d: mean %.4f, rms %.4f; the truth's largest %.4f", x, step.mean,
                   step.deviation, usual);
    g_assert_cmpfloat(fabs(step.mean), <, .01);
    g_assert_cmpfloat(step.deviation, <, 1.1 * usual);
  }
  picture_clear(&truth);
  task_clear(&t);
}

#define TILE_PX 48
/* Tiles with dark joints; those of the third column are brighter. */
static picture tiles(void) {
  picture p = picture_new(384, 288, 1, RECEDE_U8);
  for (int y = 0; y < 288; y++)
    for (int x = 0; x < 384; x++) {
      bool joint = x % TILE_PX < 3 || y % TILE_PX < 3;
      double tone = x / TILE_PX == 2 ? .62 : .5;
      picture_set(&p, x, y, 0, (float)((joint ? .2 : tone) + .04 * noise_at(x, y, 9)));
    }
  return p;
}

/* Mean of the tiles, not their joints, of some columns of the hole. */
static double tone_of(const picture *p, int x0, int x1) {
  double sum = 0, count = 0;
  for (int y = 100; y < 190; y++)
    for (int x = x0; x < x1; x++) {
      if (y % TILE_PX < 5 || y % TILE_PX > TILE_PX - 3) continue;
      sum += picture_get(p, x, y, 0);
      count++;
    }
  return sum / count;
}

/* The hole cuts bright tiles that are no source: they go on bright, up to their own joint. */
static void tiles_keep_their_tone(void) {
  task t = task_new(tiles(), "orientation=frontal engine-tone=0");
  task_hole(&t, (area){112, 90, 220, 200});
  t.source = picture_new(384, 288, 1, RECEDE_U8);
  picture_fill(&t.source, (area){0, 0, 384, 288}, 1);
  picture_fill(&t.source, (area){2 * TILE_PX, 0, 3 * TILE_PX, 288}, 0);
  task_succeeds(&t);
  double cut = tone_of(&t.result, 126, 138), beyond = tone_of(&t.result, 152, 180);
  g_test_message("14 to 26 px from the border %.3f, beyond the joint %.3f", cut, beyond);
  g_assert_cmpfloat(cut, >, .555); /* by a join of 7 px .533 */
  g_assert_cmpfloat(beyond, <, .54);
  task_clear(&t);
}

/* A white thing that is no source reaches 4 px and more into the hole, on ground with that much
 * contrast: how much brighter it is below the thing than beside it. */
static double shine_of(area thing, area below, area beside, double contrast) {
  picture ground = picture_new(320, 240, 3, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++)
      for (int k = 0; k < 3; k++)
        picture_set(&ground, x, y, k, (float)(.35 + contrast * (noise_at(x, y, 11) - .5)));
  picture_fill(&ground, thing, .95f);
  task t = task_new(ground, "orientation=frontal");
  task_hole(&t, (area){100, 100, 220, 200});
  t.source = picture_new(320, 240, 1, RECEDE_U8);
  picture_fill(&t.source, (area){0, 0, 320, 240}, 1);
  picture_fill(&t.source, (area){thing.x0 - 10, 0, thing.x1 + 10, 240}, 0);
  task_succeeds(&t);
  double near = moments_of(&t.result, &t.mask, true, below, 0).mean;
  double far = moments_of(&t.result, &t.mask, true, beside, 0).mean;
  g_test_message("contrast %.2f: below %.4f, beside %.4f", contrast, near, far);
  task_clear(&t);
  return near - far;
}

static double shine_of_a_post(double contrast) {
  return shine_of((area){150, 0, 158, 130}, (area){146, 102, 162, 112}, (area){106, 102, 130, 112},
                  contrast);
}

static void cut_things_do_not_shine(void) {
  g_assert_cmpfloat(shine_of_a_post(.1), <, .03);
  g_assert_cmpfloat(shine_of_a_post(.25), <, .055); /* by the mean alone .078 */
}

/* A line along a fifth of the hole's border: what it misses by must not be its own measure. */
static void long_things_do_not_shine(void) {
  for (int n = 0; n < some_of(3); n++) {
    double shine = shine_of((area){100, 84, 180, 104}, (area){110, 106, 160, 116},
                            (area){196, 106, 216, 116}, .05 + .05 * n);
    g_assert_cmpfloat(shine, <, .03);
  }
}

/* Two gravels of one grain, the lower one darker. Their step is no drift of the light: without it
 * each looks like the other, and takes its tone. */
static void steps_stay(void) {
  const area hole = {100, 80, 220, 160}, above = {104, 84, 216, 108}, below = {104, 132, 216, 156};
  picture gravel = picture_new(320, 240, 1, RECEDE_U8);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 320; x++) {
      double grain = .4 * noise_at(x / 7, y / 5, 12) + .15 * noise_at(x, y, 13);
      picture_set(&gravel, x, y, 0, (float)((y < 120 ? .45 : .1) + grain));
    }
  task t = task_new(picture_copy(&gravel), "orientation=frontal engine-lines=0");
  task_hole(&t, hole);
  task_succeeds(&t);
  double got = moments_of(&t.result, &t.mask, true, above, 0).mean -
               moments_of(&t.result, &t.mask, true, below, 0).mean;
  double known = moments_of(&gravel, &t.mask, true, above, 0).mean -
                 moments_of(&gravel, &t.mask, true, below, 0).mean;
  g_test_message("step %.4f, truth %.4f", got, known);
  g_assert_cmpfloat(fabs(got - known), <, .05);
  picture_clear(&gravel);
  task_clear(&t);
}

/* A floor, horizon at row 80, lit from the right, and less and less from row 230 on. */
static picture floor_lit_from_the_right(void) {
  picture p = picture_new(1000, 300, 1, RECEDE_U8);
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 1000; x++) {
      double light = (.24 + .47 * x / 1000) * exp(-fmax(y - 230, 0) / 30);
      picture_set(&p, x, y, 0, (float)(light * (.8 + .4 * noise_at(x, y, 14))));
    }
  return p;
}

/* The light is that of the hole's own depth: what lies nearer, beside a hole that is wide and flat,
 * does not speak against it. */
static void light_is_that_of_the_holes_depth(void) {
  const area hole = {200, 160, 800, 220};
  picture truth = floor_lit_from_the_right();
  task t = task_new(picture_copy(&truth), "orientation=horizon horizon=0,80,1000,80");
  double off = 0;
  task_hole(&t, hole);
  picture_fill(&t.image, hole, 0);
  task_succeeds(&t);
  for (int x = hole.x0; x < hole.x1; x += 40) {
    const area strip = {x, hole.y0, x + 40, hole.y1};
    off = fmax(off, fabs(moments_of(&t.result, &t.mask, true, strip, 0).mean -
                         moments_of(&truth, &t.mask, true, strip, 0).mean));
  }
  g_test_message("a strip is off by %.4f at the most", off);
  g_assert_cmpfloat(off, <, .07); /* without the trend .09 */
  picture_clear(&truth);
  task_clear(&t);
}

#define BANDS 12
/* A road, horizon at row 40, with faint bands towards the vanishing point; grain as on a plane. */
static double band_at(double across) {
  double tone = 0;
  for (int i = -12; i <= 12; i++) {
    double off = (across - .2 * i) / .08;
    tone += .1 * (noise_at(i + 12, 0, 15) - .5) * exp(-off * off);
  }
  return tone;
}
static double across_at(int x, int y) { return (x - 320) / (y - 40.); }

static picture road(double bands) {
  picture p = picture_new(640, 400, 1, RECEDE_U8);
  for (int y = 0; y < 400; y++)
    for (int x = 0; x < 640; x++) {
      double away = 400 / fmax(y - 40, 1), across = across_at(x, y > 41 ? y : 41);
      double grain = noise_at((int)floor(200 * away), (int)floor(200 * across), 16);
      picture_set(&p, x, y, 0, (float)(.4 + bands * band_at(across) + .3 * (grain - .5)));
    }
  return p;
}

/* The mean of each of some bands between the hole's sides. */
static void profile_of(const picture *p, area hole, double profile[BANDS]) {
  double counts[BANDS] = {0};
  memset(profile, 0, BANDS * sizeof *profile);
  for (int y = hole.y0; y < hole.y1; y++)
    for (int x = hole.x0; x < hole.x1; x++) {
      int i = (int)floor((across_at(x, y) + .36) / .72 * BANDS);
      if (i < 0 || i >= BANDS) continue;
      profile[i] += picture_get(p, x, y, 0), counts[i]++;
    }
  for (int i = 0; i < BANDS; i++) profile[i] /= counts[i];
}

static double bands_are_off(const picture *truth, const char *settings) {
  const area hole = {240, 200, 400, 290};
  double got[BANDS], known[BANDS], square = 0;
  task t = task_new(picture_copy(truth), settings);
  task_hole(&t, hole);
  picture_fill(&t.image, hole, 0);
  task_succeeds(&t);
  task_assert_outside(&t);
  profile_of(&t.result, hole, got), profile_of(truth, hole, known);
  for (int i = 0; i < BANDS; i++) square += (got[i] - known[i]) * (got[i] - known[i]) / BANDS;
  task_clear(&t);
  return sqrt(square);
}

/* Faint bands go on through the hole, where copies would bring their own. */
static void tracks_go_on(void) {
  picture truth = road(1);
  double with = bands_are_off(&truth, "orientation=horizon horizon=0,40,640,40");
  double without = bands_are_off(&truth, "orientation=horizon horizon=0,40,640,40 engine-tracks=0");
  g_test_message("bands are off by %.4f, without the stage %.4f", with, without);
  g_assert_cmpfloat(with, <, .7 * without);
  picture_clear(&truth);
}

static guint64 road_hash(double bands, const char *settings) {
  task t = task_new(road(bands), settings);
  task_hole(&t, (area){240, 200, 400, 290});
  task_succeeds(&t);
  guint64 hash = t.report.output_hash;
  task_clear(&t);
  return hash;
}

/* Strong bands are things, which copies show. */
static void only_faint_tracks_are_led(void) {
  const char *on = "quality=draft orientation=horizon horizon=0,40,640,40";
  const char *off = "quality=draft orientation=horizon horizon=0,40,640,40 engine-tracks=0";
  g_assert_cmphex(road_hash(1, on), !=, road_hash(1, off));
  g_assert_cmphex(road_hash(4, on), ==, road_hash(4, off));
}

/* Ground lit from .2 at the left to 1 at the right: its contrast is the light's. */
static picture ground_in_drifting_light(void) {
  picture p = picture_new(600, 300, 1, RECEDE_U8);
  for (int y = 0; y < 300; y++)
    for (int x = 0; x < 600; x++) {
      double ground = 1 - .3 * noise_at(x / 5, y / 5, 1) - .2 * noise_at(x / 2, y / 2, 2);
      picture_set(&p, x, y, 0, (float)((.2 + .8 * x / 600) * ground));
    }
  return p;
}

/* Octaves by which the hole's contrast grows from left to right, from step to step. */
static double contrast_grows(const picture *p) {
  double squares[2] = {0, 0};
  for (int y = 90; y < 210; y++)
    for (int x = 180; x < 240; x++)
      for (int k = 0; k < 2; k++) {
        int at = k ? x + 180 : x;
        double step = picture_get(p, at + 1, y, 0) - picture_get(p, at, y, 0);
        squares[k] += step * step;
      }
  return log2(squares[1] / squares[0]) / 2;
}

/* How far that is off what was there: mean over seeds. */
static double contrast_off(const char *settings) {
  picture truth = ground_in_drifting_light();
  double sum = 0;
  for (int seed = 0; seed < 3; seed++) {
    task t = task_new(picture_copy(&truth), settings);
    t.params.seed = seed;
    task_hole(&t, (area){170, 80, 430, 220});
    task_succeeds(&t);
    sum += fabs(contrast_grows(&t.result) - contrast_grows(&truth)) / 3;
    task_clear(&t);
  }
  picture_clear(&truth);
  g_test_message("%s: %.3f octaves off", settings, sum);
  return sum;
}

/* What lies in another light looks like another thing, too. */
static void contrast_follows_the_light(void) {
  g_assert_cmpfloat(contrast_off("orientation=frontal"), <, .32);
  g_assert_cmpfloat(contrast_off("orientation=frontal engine-kin=0"), <, .32);
  g_assert_cmpfloat(contrast_off("orientation=frontal engine-light=0 engine-kin=0"), >, .4);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tone/drift", drift_leaves_no_seam);
  g_test_add_func("/tone/depth", light_is_that_of_the_holes_depth);
  g_test_add_func("/tone/tracks", tracks_go_on);
  g_test_add_func("/tone/strong-bands", only_faint_tracks_are_led);
  g_test_add_func("/tone/tiles", tiles_keep_their_tone);
  g_test_add_func("/tone/step", steps_stay);
  g_test_add_func("/tone/cut", cut_things_do_not_shine);
  g_test_add_func("/tone/cut-along", long_things_do_not_shine);
  test_add_judged("/tone/contrast", contrast_follows_the_light);
  return g_test_run();
}
