#include "synthesis/search/kept.h"

#include <math.h>

#include "synthesis/structure/follow.h"
#include "synthesis/structure/profile.h"

/* At coarse levels a line's own profile needs so many px still, and each piece. */
#define LEAST_NEAR_PX 4
#define LOOKED_AT 8 /* pieces of a line */
#define LEAST_PIECE_PX 2

/* A level as its line was seen. */
typedef struct view {
  const rc_level *level;
  float axis[RC_COMPONENTS]; /* the line's, told by components */
} view;

static bool value_at(const view *v, int x, int y, int wanted, float *value) {
  const rc_level *level = v->level;
  if (!rc_inside(level->width, level->height, x, y)) return false;
  size_t at = (size_t)y * (size_t)level->width + (size_t)x;
  *value = 0;
  for (int k = 0; k < RC_COMPONENTS; k++)
    *value += v->axis[k] * (float)(level->pixels[at] >> 8 * k & 255);
  return (level->flags[at] & wanted) != 0;
}

static bool outside(const void *user, int x, int y, float *value) {
  return value_at(user, x, y, RC_SOURCE | RC_ALLOWED, value);
}

static bool everywhere(const void *user, int x, int y, float *value) {
  return value_at(user, x, y, RC_KNOWN | RC_TARGET, value);
}

static double line_kept(const rc_level *level, const rc_crossing *line, int exponent) {
  rc_profile own[2], here;
  rc_crossing c = rc_crossing_coarser(*line, exponent);
  float unit = (float)(1 << exponent), sum = 0;
  float ax = c.ax, ay = c.ay, dx = c.bx - c.ax, dy = c.by - c.ay;
  float length = sqrtf(dx * dx + dy * dy), piece_px = length / LOOKED_AT;
  int near = (int)fmaxf(RC_PROFILE_NEAR_PX / unit, LEAST_NEAR_PX);
  int count = (int)fmaxf(piece_px, LEAST_PIECE_PX);
  view v = {.level = level};
  for (int k = 0; k < RC_COMPONENTS; k++)
    for (int i = 0; i < 3; i++) v.axis[k] += line->axis[i] * level->colours[k][i];
  rc_ruler ruler = {outside, &v, dx / length, dy / length, &level->chart};
  if (!rc_profile_mean(&ruler, ax + dx, ay + dy, RC_PROFILE_FROM_PX, 1, near, &own[1])) return 1;
  if (line->ends_inside)
    own[0] = own[1];
  else if (!rc_profile_mean(&ruler, ax, ay, -RC_PROFILE_FROM_PX, -1, near, &own[0]))
    return 1;
  ruler.value = everywhere;
  for (int piece = 0; piece < LOOKED_AT; piece++) {
    const rc_profile *wanted = &own[2 * piece >= LOOKED_AT];
    float t = (float)piece / LOOKED_AT, square = rc_profile_dot(wanted, wanted);
    if (!rc_profile_mean(&ruler, ax + t * dx, ay + t * dy, .5f, piece_px / (float)count, count,
                         &here))
      continue;
    sum += fmaxf(fminf(rc_profile_dot(&here, wanted) / fmaxf(square, 1e-6f), 1), 0);
  }
  return sum / LOOKED_AT;
}

double rc_lines_kept(const rc_level *level, const rc_crossing *lines, int count, int exponent) {
  double sum = 0;
  for (int i = 0; i < count; i++) sum += line_kept(level, &lines[i], exponent);
  return count ? sum / count : 1;
}
