/* One plane, many ways to say it: slant and tilt, a horizon line, a quad.
 * With the ray r(x, y) = ((x - cx) / f, (y - cy) / f, 1) and the plane's unit normal n, the depth
 * is proportional to 1 / (n . r): everything below is this one fact. */
#include <math.h>
#include <string.h>

#include "recede.h"

#define PI 3.14159265358979323846

static double radians(double degrees) { return degrees * (PI / 180); }
static double degrees(double radians_) { return radians_ * (180 / PI); }
static int within(double value, double low, double high) { return value >= low && value <= high; }

static recede_status frontal(int width, int height, double fov_deg, recede_plane *plane) {
  if (width < 1 || height < 1 || !within(fov_deg, 1, 170)) return RECEDE_ARGUMENT;
  int longest = width > height ? width : height;
  *plane = (recede_plane){width, height, .5 * longest / tan(radians(fov_deg) / 2), {0, 0, 1}};
  return RECEDE_OK;
}

static double centre_x(const recede_plane *plane) { return (plane->width - 1) / 2.; }
static double centre_y(const recede_plane *plane) { return (plane->height - 1) / 2.; }

double recede_plane_w(const recede_plane *plane, double x, double y) {
  return (plane->normal[0] * (x - centre_x(plane)) + plane->normal[1] * (y - centre_y(plane))) /
             plane->focal_px +
         plane->normal[2];
}

recede_status recede_plane_from_angles(int width, int height, double slant_deg, double tilt_deg,
                                       double fov_deg, recede_plane *plane) {
  if (!(slant_deg >= 0 && slant_deg < 180) || !within(tilt_deg, -180, 180)) return RECEDE_ARGUMENT;
  recede_status status = frontal(width, height, fov_deg, plane);
  if (status != RECEDE_OK) return status;
  double slant = radians(slant_deg), tilt = radians(tilt_deg);
  /* w = cos(slant) - (q / f) sin(slant), q measured along d = (sin(tilt), -cos(tilt)). */
  plane->normal[0] = -sin(slant) * sin(tilt);
  plane->normal[1] = sin(slant) * cos(tilt);
  plane->normal[2] = cos(slant);
  return RECEDE_OK;
}

/* The plane whose vanishing line is a x + b y + c = 0 in px, positive at (on_x, on_y). */
static recede_status set_line(recede_plane *plane, double a, double b, double c, double on_x,
                              double on_y) {
  double n[3] = {a * plane->focal_px, b * plane->focal_px,
                 a * centre_x(plane) + b * centre_y(plane) + c};
  double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  double on = a * on_x + b * on_y + c;
  if (!isfinite(length) || length == 0 || !isfinite(on) || on == 0) return RECEDE_NO_PLANE;
  for (int i = 0; i < 3; i++) plane->normal[i] = (on > 0 ? n[i] : -n[i]) / length;
  return RECEDE_OK;
}

recede_status recede_plane_from_horizon(int width, int height, double fov_deg, double x1, double y1,
                                        double x2, double y2, double on_x, double on_y,
                                        recede_plane *plane) {
  if (!isfinite(x1 + y1 + x2 + y2 + on_x + on_y)) return RECEDE_ARGUMENT;
  recede_plane made;
  recede_status status = frontal(width, height, fov_deg, &made);
  if (status != RECEDE_OK) return status;
  double length = hypot(x2 - x1, y2 - y1);
  if (length == 0) return RECEDE_NO_PLANE;
  double a = -(y2 - y1) / length, b = (x2 - x1) / length;
  status = set_line(&made, a, b, -a * x1 - b * y1, on_x, on_y);
  if (status == RECEDE_OK) *plane = made;
  return status;
}

static void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* Positive for every corner turning the same way: the quad is convex and in order around it. */
static int convex(const double quad[8]) {
  double sign = 0;
  for (int i = 0; i < 4; i++) {
    const double *a = quad + 2 * i, *b = quad + 2 * ((i + 1) % 4), *c = quad + 2 * ((i + 2) % 4);
    double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    double size = hypot(b[0] - a[0], b[1] - a[1]) * hypot(c[0] - b[0], c[1] - b[1]);
    if (fabs(turn) <= 1e-6 * size || turn * sign < 0) return 0;
    sign = turn;
  }
  return 1;
}

/* The focal length at which the vanishing points of two directions are at right angles seen from
 * the camera: v1 . v2 + f^2 = 0 about the principal point. 0 when a point is (almost) at infinity
 * or no real f exists. */
static double focal_of_right_angle(const double v1[3], const double v2[3], double size) {
  if (fabs(v1[2]) * 50 * size < hypot(v1[0], v1[1]) ||
      fabs(v2[2]) * 50 * size < hypot(v2[0], v2[1]))
    return 0;
  double square = -(v1[0] * v2[0] + v1[1] * v2[1]) / (v1[2] * v2[2]);
  double focal = square > 0 ? sqrt(square) : 0;
  return within(focal, .5 * size / tan(radians(85)), .5 * size / tan(radians(.5))) ? focal : 0;
}

recede_status recede_plane_from_quad(int width, int height, double fov_deg, const double quad[8],
                                     int right_angles, recede_plane *plane) {
  double p[4][3], side[3], opposite[3], v1[3], v2[3], line[3], sum = 0;
  for (int i = 0; i < 8; i++) sum += quad[i];
  if (!isfinite(sum)) return RECEDE_ARGUMENT;
  recede_plane made;
  recede_status status = frontal(width, height, fov_deg, &made);
  if (status != RECEDE_OK) return status;
  if (!convex(quad)) return RECEDE_NO_PLANE;
  for (int i = 0; i < 4; i++) {
    p[i][0] = quad[2 * i] - centre_x(&made);
    p[i][1] = quad[2 * i + 1] - centre_y(&made);
    p[i][2] = 1;
  }
  cross(p[0], p[1], side), cross(p[3], p[2], opposite), cross(side, opposite, v1);
  cross(p[1], p[2], side), cross(p[0], p[3], opposite), cross(side, opposite, v2);
  if (right_angles) {
    double focal = focal_of_right_angle(v1, v2, width > height ? width : height);
    if (focal > 0) made.focal_px = focal;
  }
  cross(v1, v2, line);
  double on_x = 0, on_y = 0;
  for (int i = 0; i < 4; i++) on_x += p[i][0] / 4, on_y += p[i][1] / 4;
  status = set_line(&made, line[0], line[1],
                    line[2] - line[0] * centre_x(&made) - line[1] * centre_y(&made),
                    on_x + centre_x(&made), on_y + centre_y(&made));
  if (status == RECEDE_OK) *plane = made;
  return status;
}

void recede_plane_angles(const recede_plane *plane, double *slant_deg, double *tilt_deg,
                         double *fov_deg) {
  const double *n = plane->normal;
  int longest = plane->width > plane->height ? plane->width : plane->height;
  double sine = hypot(n[0], n[1]);
  *slant_deg = degrees(atan2(sine, n[2]));
  *tilt_deg = sine > 0 ? degrees(atan2(-n[0], n[1])) : 0;
  *fov_deg = degrees(2 * atan(.5 * longest / plane->focal_px));
}

int recede_plane_horizon(const recede_plane *plane, double ends[4]) {
  const double *n = plane->normal;
  double sine = hypot(n[0], n[1]);
  if (sine < 1e-9) return 0;
  double d[2] = {-n[0] / sine, -n[1] / sine}, f = plane->focal_px;
  double x = centre_x(plane) + f * n[2] / sine * d[0], y = centre_y(plane) + f * n[2] / sine * d[1];
  /* Facing where the plane recedes (d), the left hand points along (d.y, -d.x): y is down. */
  ends[0] = x + f * d[1], ends[1] = y - f * d[0];
  ends[2] = x - f * d[1], ends[3] = y + f * d[0];
  return 1;
}

int recede_plane_quad(const recede_plane *plane, double x, double y, double size_px,
                      double quad[8]) {
  const double *n = plane->normal;
  double f = plane->focal_px, w = recede_plane_w(plane, x, y), sine = hypot(n[0], n[1]);
  if (w <= 0) return 0;
  /* Point (x, y) on the plane n . P = 1, and the plane's axes across the tilt and along it. */
  double point[3] = {(x - centre_x(plane)) / f / w, (y - centre_y(plane)) / f / w, 1 / w};
  double across[3] = {1, 0, 0}, along[3];
  if (sine > 1e-12) across[0] = n[1] / sine, across[1] = -n[0] / sine;
  cross(n, across, along);
  double half = .5 * size_px / (f * w);
  static const int corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < 4; i++) {
    double p[3];
    for (int k = 0; k < 3; k++)
      p[k] = point[k] + half * (corner[i][0] * across[k] + corner[i][1] * along[k]);
    if (p[2] <= 1e-9 * point[2]) return 0;
    quad[2 * i] = centre_x(plane) + f * p[0] / p[2];
    quad[2 * i + 1] = centre_y(plane) + f * p[1] / p[2];
  }
  return 1;
}
