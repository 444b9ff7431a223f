/* The plane: conversions, exact scale maps against finite differences of a homography that this
 * test builds on its own, and the paper's eqs 1-3. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "recede.h"

#define RADIAN (G_PI / 180)

typedef struct camera {
  double e[2], d[2], cx, cy, f, z0, sine, cosine;
} camera;

/* Texel (m across, l along) -> image px: p = f m / (z0 + l sin), q = f l cos / (z0 + l sin). */
static camera camera_of(int width, int height, double slant, double tilt, double fov, double g) {
  camera c;
  int longest = MAX(width, height);
  c.d[0] = sin(tilt * RADIAN), c.d[1] = -cos(tilt * RADIAN);
  c.e[0] = -c.d[1], c.e[1] = c.d[0];
  c.cx = (width - 1) / 2., c.cy = (height - 1) / 2.;
  c.f = .5 * longest / tan(fov * RADIAN / 2);
  c.z0 = c.f / g, c.sine = sin(slant * RADIAN), c.cosine = cos(slant * RADIAN);
  return c;
}
static void texel_at(const camera *c, double x, double y, double *m, double *l) {
  double p = (x - c->cx) * c->e[0] + (y - c->cy) * c->e[1];
  double q = (x - c->cx) * c->d[0] + (y - c->cy) * c->d[1];
  *l = q * c->z0 / (c->f * c->cosine - q * c->sine);
  *m = p * (c->z0 + *l * c->sine) / c->f;
}

/* px per texel from the inverse's finite differences, along direction v of the image. */
static double texels_per_px(const camera *c, double x, double y, const double v[2]) {
  double h = 1e-3, m1, l1, m0, l0;
  texel_at(c, x + h * v[0], y + h * v[1], &m1, &l1);
  texel_at(c, x - h * v[0], y - h * v[1], &m0, &l0);
  return hypot(m1 - m0, l1 - l0) / (2 * h);
}
static double texel_area_per_px(const camera *c, double x, double y) {
  double h = 1e-3, m[4], l[4];
  texel_at(c, x + h, y, &m[0], &l[0]), texel_at(c, x - h, y, &m[1], &l[1]);
  texel_at(c, x, y + h, &m[2], &l[2]), texel_at(c, x, y - h, &m[3], &l[3]);
  return fabs((m[0] - m[1]) * (l[2] - l[3]) - (m[2] - m[3]) * (l[0] - l[1])) / (4 * h * h);
}

static const double tilts[] = {-180, -135, -90, -60, -10, 0, 18, 45, 77, 90, 120, 180};
static const double fovs[] = {20, 36, 50, 75};

static void check_scales(double slant, double tilt, double fov) {
  int width = 401, height = 300;
  camera c = camera_of(width, height, slant, tilt, fov, slant < 90 ? 1 : -1);
  recede_plane plane;
  g_assert_cmpint(recede_plane_from_angles(width, height, slant, tilt, fov, &plane), ==, RECEDE_OK);
  /* Where a texel is 1 px across: the centre, or for slants from 90 on a point before the horizon.
   */
  double ref_q = slant < 75 ? 0 : c.f * c.cosine / c.sine - 60;
  double ref_x = c.cx + ref_q * c.d[0], ref_y = c.cy + ref_q * c.d[1];
  double unit = texels_per_px(&c, ref_x, ref_y, c.e);
  for (int i = 1; i < 40; i++) {
    double q = ref_q - 4 * i + (slant < 75 ? 80 : 0);
    double x = c.cx + q * c.d[0], y = c.cy + q * c.d[1];
    if (recede_plane_w(&plane, x, y) < .02) continue;
    double across = unit / texels_per_px(&c, x, y, c.e),
           along = unit / texels_per_px(&c, x, y, c.d);
    double off_x = x + 37 * c.e[0], off_y = y + 37 * c.e[1];
    double area = unit * unit / texel_area_per_px(&c, off_x, off_y);
    g_assert_cmpfloat_with_epsilon(
        recede_scale_at(&plane, RECEDE_SCALE_ACROSS, ref_x, ref_y, x, y) / across, 1, 1e-6);
    g_assert_cmpfloat_with_epsilon(
        recede_scale_at(&plane, RECEDE_SCALE_ALONG, ref_x, ref_y, x, y) / along, 1, 1e-6);
    g_assert_cmpfloat_with_epsilon(
        recede_scale_at(&plane, RECEDE_SCALE_AREA, ref_x, ref_y, off_x, off_y) / area, 1, 1e-6);
  }
}

static void scales_agree_with_the_homography(void) {
  for (int slant = 0; slant <= 75; slant += 15)
    for (size_t t = 0; t < G_N_ELEMENTS(tilts); t++)
      for (size_t f = 0; f < G_N_ELEMENTS(fovs); f++) check_scales(slant, tilts[t], fovs[f]);
}

static void horizon_inside_the_picture(void) {
  for (int slant = 91; slant <= 120; slant += 5)
    for (size_t t = 0; t < G_N_ELEMENTS(tilts); t++) check_scales(slant, tilts[t], 75);
  recede_plane plane;
  double ends[4];
  recede_plane_from_angles(300, 200, 95, 0, 60, &plane);
  g_assert_true(recede_plane_horizon(&plane, ends));
  g_assert_cmpfloat(ends[1], >, 99.5); /* below the centre */
  g_assert_cmpfloat(ends[0], <, ends[2]);
}

static double angle_between(const recede_plane *a, const recede_plane *b) {
  double dot = 0, cross[3];
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    dot += a->normal[i] * b->normal[i];
    cross[i] = a->normal[j] * b->normal[k] - a->normal[k] * b->normal[j];
  }
  return atan2(hypot(hypot(cross[0], cross[1]), cross[2]), dot) / RADIAN;
}

static void every_form_converts(void) {
  for (int slant = 10; slant < 130; slant += 10)
    for (size_t t = 0; t < G_N_ELEMENTS(tilts); t++) {
      recede_plane plane, again;
      double s, tilt, fov, ends[4], quad[8];
      recede_plane_from_angles(640, 480, slant, tilts[t], 50, &plane);
      recede_plane_angles(&plane, &s, &tilt, &fov);
      g_assert_cmpfloat_with_epsilon(s, slant, 1e-9);
      g_assert_cmpfloat_with_epsilon(remainder(tilt - tilts[t], 360), 0, 1e-9);
      g_assert_cmpfloat_with_epsilon(fov, 50, 1e-9);
      g_assert_true(recede_plane_horizon(&plane, ends));
      double qx = ends[0] + ends[2], qy = ends[1] + ends[3];
      double on_x = qx / 2 - 90 * sin(tilt * RADIAN), on_y = qy / 2 + 90 * cos(tilt * RADIAN);
      g_assert_cmpint(recede_plane_from_horizon(640, 480, 50, ends[0], ends[1], ends[2], ends[3],
                                                on_x, on_y, &again),
                      ==, RECEDE_OK);
      g_assert_cmpfloat(angle_between(&plane, &again), <, 1e-7);
      g_assert_true(recede_plane_quad(&plane, on_x, on_y, 20, quad));
      g_assert_cmpint(recede_plane_from_quad(640, 480, 50, quad, 0, &again), ==, RECEDE_OK);
      g_assert_cmpfloat(angle_between(&plane, &again), <, 1e-4);
    }
}

static void quad_of_a_rectangle_tells_the_field_of_view(void) {
  recede_plane plane, rotated, again;
  double quad[8], s, t, fov;
  /* A square seen under tilt 0 has one vanishing point at infinity; one turned by 30 degrees on the
   * plane has two: made as two of a square's diagonals' halves. */
  recede_plane_from_angles(800, 600, 60, 0, 65, &plane);
  g_assert_true(recede_plane_quad(&plane, 400, 400, 100, quad));
  double cx = 0, cy = 0, diamond[8];
  camera c = camera_of(800, 600, 60, 0, 65, 1);
  for (int i = 0; i < 4; i++) { /* a rhombus with right angles: the middles of the square's sides */
    double m0, l0, m1, l1, m, l;
    texel_at(&c, quad[2 * i], quad[2 * i + 1], &m0, &l0);
    texel_at(&c, quad[(2 * i + 2) % 8], quad[(2 * i + 3) % 8], &m1, &l1);
    m = (m0 + m1) / 2, l = (l0 + l1) / 2;
    double p = c.f * m / (c.z0 + l * c.sine), q = c.f * l * c.cosine / (c.z0 + l * c.sine);
    diamond[2 * i] = c.cx + p * c.e[0] + q * c.d[0];
    diamond[2 * i + 1] = c.cy + p * c.e[1] + q * c.d[1];
    cx += diamond[2 * i], cy += diamond[2 * i + 1];
  }
  g_assert_cmpint(recede_plane_from_quad(800, 600, 30, diamond, 1, &again), ==, RECEDE_OK);
  recede_plane_angles(&again, &s, &t, &fov);
  g_assert_cmpfloat_with_epsilon(fov, 65, 1e-3);
  g_assert_cmpfloat_with_epsilon(s, 60, 1e-3);
  g_assert_cmpint(recede_plane_from_quad(800, 600, 65, quad, 1, &rotated), ==, RECEDE_OK);
  recede_plane_angles(&rotated, &s, &t, &fov);
  g_assert_cmpfloat_with_epsilon(fov, 65, 1e-9); /* one point at infinity: as given */
}

static void degenerate_planes_are_refused(void) {
  recede_plane plane;
  const double crossed[8] = {0, 0, 10, 10, 10, 0, 0, 10}, line[8] = {0, 0, 1, 0, 2, 0, 3, 0};
  g_assert_cmpint(recede_plane_from_angles(10, 10, 180, 0, 50, &plane), ==, RECEDE_ARGUMENT);
  g_assert_cmpint(recede_plane_from_angles(10, 10, NAN, 0, 50, &plane), ==, RECEDE_ARGUMENT);
  g_assert_cmpint(recede_plane_from_angles(0, 10, 1, 0, 50, &plane), ==, RECEDE_ARGUMENT);
  g_assert_cmpint(recede_plane_from_horizon(10, 10, 50, 1, 1, 1, 1, 5, 5, &plane), ==,
                  RECEDE_NO_PLANE);
  g_assert_cmpint(recede_plane_from_horizon(10, 10, 50, 0, 5, 9, 5, 3, 5, &plane), ==,
                  RECEDE_NO_PLANE);
  g_assert_cmpint(recede_plane_from_quad(10, 10, 50, crossed, 1, &plane), ==, RECEDE_NO_PLANE);
  g_assert_cmpint(recede_plane_from_quad(10, 10, 50, line, 1, &plane), ==, RECEDE_NO_PLANE);
}

/* Eqs 1-3 as section 2 of the findings reads them: the range is 1/cos .. cos over the picture's
 * corners along the tilt, linear between them, 1/cos where it is nearest. */
static void paper_map_has_the_range_of_eq_1(void) {
  for (size_t t = 0; t < G_N_ELEMENTS(tilts); t++)
    for (int slant = 0; slant < 90; slant += 20) {
      int w = 61, h = 47;
      recede_plane plane;
      float map[61 * 47], low = 9e9f, high = 0;
      recede_view view = {map, sizeof(float) * 61, w, h, 1, RECEDE_FLOAT};
      recede_plane_from_angles(w, h, slant, tilts[t], 50, &plane);
      g_assert_cmpint(recede_scale_map(&plane, RECEDE_SCALE_PAPER, 0, 0, &view), ==, RECEDE_OK);
      for (int i = 0; i < w * h; i++) low = MIN(low, map[i]), high = MAX(high, map[i]);
      double cosine = cos(slant * RADIAN), middle = (cosine + 1 / cosine) / 2;
      g_assert_cmpfloat_with_epsilon(low, cosine, 1e-5);
      g_assert_cmpfloat_with_epsilon(high, 1 / cosine, 1e-5);
      g_assert_cmpfloat_with_epsilon(map[(h / 2) * w + w / 2], middle, 1e-5);
      if (slant && fabs(tilts[t]) < 80) g_assert_cmpfloat(map[w / 2], <, map[(h - 1) * w + w / 2]);
      if (slant && fabs(tilts[t]) > 100) g_assert_cmpfloat(map[w / 2], >, map[(h - 1) * w + w / 2]);
    }
  recede_plane steep;
  float one[4];
  recede_view view = {one, 8, 2, 2, 1, RECEDE_FLOAT};
  recede_plane_from_angles(2, 2, 100, 0, 50, &steep);
  g_assert_cmpint(recede_scale_map(&steep, RECEDE_SCALE_PAPER, 0, 0, &view), ==, RECEDE_NO_PLANE);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/geometry/homography", scales_agree_with_the_homography);
  g_test_add_func("/geometry/horizon-inside", horizon_inside_the_picture);
  g_test_add_func("/geometry/conversions", every_form_converts);
  g_test_add_func("/geometry/quad-focal", quad_of_a_rectangle_tells_the_field_of_view);
  g_test_add_func("/geometry/degenerate", degenerate_planes_are_refused);
  g_test_add_func("/geometry/paper", paper_map_has_the_range_of_eq_1);
  return g_test_run();
}
