#include "plane/lean.h"

#include <math.h>

#define TILTS 12
/* Sine of the angle by which level floors may lean to a side: hands are not quite steady. */
#define LEVEL_SINE .12

void rc_lean_normal(rc_lean lean, double normal[3]) {
  double slant = sqrt(lean.across * lean.across + lean.along * lean.along);
  double sinc = slant > 1e-9 ? sin(slant) / slant : 1;
  normal[0] = -lean.across * sinc;
  normal[1] = lean.along * sinc;
  normal[2] = cos(slant);
}

rc_lean rc_lean_of_normal(const double n[3]) {
  double sine = sqrt(n[0] * n[0] + n[1] * n[1]), slant = atan2(sine, n[2]);
  return sine > 1e-9 ? (rc_lean){-slant * n[0] / sine, slant * n[1] / sine} : (rc_lean){0, 0};
}

double rc_lean_degrees(rc_lean a, rc_lean b) {
  double n[3], m[3], difference = 0;
  rc_lean_normal(a, n);
  rc_lean_normal(b, m);
  for (int i = 0; i < 3; i++) difference += (n[i] - m[i]) * (n[i] - m[i]);
  return 2 * asin(fmin(1, sqrt(difference) / 2)) * (180 / M_PI);
}

double rc_lean_ceiling(rc_lean lean) {
  double n[3];
  rc_lean_normal(lean, n);
  return fmax(0, -n[1]);
}

double rc_lean_level(rc_lean lean) {
  double n[3];
  rc_lean_normal(lean, n);
  return fmax(0, n[1]) * exp(-(n[0] / LEVEL_SINE) * (n[0] / LEVEL_SINE));
}

rc_lean rc_lean_holding(const double v[3], double angle) {
  double side = sqrt(v[0] * v[0] + v[1] * v[1]), n[3];
  double a[3] = {1, 0, 0}, b[3] = {0, 1, 0};
  if (side > 1e-6) {
    a[0] = -v[1] / side, a[1] = v[0] / side, a[2] = 0;
    b[0] = -v[2] * v[0] / side, b[1] = -v[2] * v[1] / side, b[2] = side;
  }
  for (int k = 0; k < 3; k++) n[k] = cos(angle) * a[k] + sin(angle) * b[k];
  for (int k = 0; k < 3 && n[2] < 0; k++) n[k] = -n[k];
  return rc_lean_of_normal(n);
}

rc_lean rc_coarse_lean(int i) {
  static const double slants[] = {12, 25, 38, 50, 60, 70, 80, 90, 98};
  double slant = i ? slants[(i - 1) / TILTS] * (M_PI / 180) : 0;
  double tilt = i ? (i - 1) % TILTS * (2 * M_PI / TILTS) : 0;
  rc_lean lean = {slant * sin(tilt), slant * cos(tilt)};
  return lean;
}
