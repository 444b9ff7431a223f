/* A plane's orientation as the search sees it. */
#ifndef RECEDE_PLANE_LEAN_H
#define RECEDE_PLANE_LEAN_H

/* slant * (sin tilt, cos tilt), radians. Smooth at frontal. */
typedef struct rc_lean {
  double across, along;
} rc_lean;

/* normal (0, 0, 1) turned by the lean: what recede_plane holds. */
void rc_lean_normal(rc_lean lean, double normal[3]);
rc_lean rc_lean_of_normal(const double normal[3]);
/* The angle between two planes. */
double rc_lean_degrees(rc_lean a, rc_lean b);
/* 1: a level ceiling; 0: a wall or a floor. */
double rc_lean_ceiling(rc_lean lean);

/* Of floors with a level horizon the sine of the slant; 0: a wall, a ceiling, a frontal plane, or a
 * floor that leans to a side by 15 degrees and more. */
double rc_lean_level(rc_lean lean);
/* A plane that holds the unit vector v, turned about it by this angle from the one that holds the
 * view axis, too. */
rc_lean rc_lean_holding(const double v[3], double angle);

/* Orientations to begin with, all of them; the first is frontal. */
#define RC_COARSE_LEANS 109
rc_lean rc_coarse_lean(int i);

#endif
