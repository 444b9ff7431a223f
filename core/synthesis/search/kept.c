#include "synthesis/search/kept.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/structure/follow.h"
#include "synthesis/structure/profile.h"

/* At coarse levels a line's own profile needs so many px still, and each piece. */
#define LEAST_NEAR_PX 4
#define LOOKED_AT 8 /* pieces of a line */
#define LEAST_PIECE_PX 2

/* A level as its line was seen: what is known of it from outside, and with its guide. */
typedef struct views {
  const rc_level *level;
  float *outside, *everywhere;
} views;

static void look_by(const float axis[3], views *v) {
  const rc_level *level = v->level;
  float by[RC_COMPONENTS] = {0};
  for (int k = 0; k < RC_COMPONENTS; k++)
    for (int i = 0; i < 3; i++) by[k] += axis[i] * level->colours[k][i];
  for (size_t i = 0; i < (size_t)level->width * (size_t)level->height; i++) {
    float value = 0;
    for (int k = 0; k < RC_COMPONENTS; k++)
      value += by[k] * (float)(level->pixels[i] >> 8 * k & 255);
    v->outside[i] = level->flags[i] & (RC_SOURCE | RC_ALLOWED) ? value : NAN;
    v->everywhere[i] = level->flags[i] & (RC_KNOWN | RC_TARGET) ? value : NAN;
  }
}

static double line_kept(const views *v, const rc_crossing *line, int exponent) {
  rc_profile own[2], here;
  rc_crossing c = rc_crossing_coarser(*line, exponent);
  float unit = (float)(1 << exponent), sum = 0;
  float ax = c.ax, ay = c.ay, dx = c.bx - c.ax, dy = c.by - c.ay;
  float length = sqrtf(dx * dx + dy * dy), piece_px = length / LOOKED_AT;
  int near = (int)fmaxf(RC_PROFILE_NEAR_PX / unit, LEAST_NEAR_PX);
  int count = (int)fmaxf(piece_px, LEAST_PIECE_PX);
  const rc_level *level = v->level;
  const rc_mask size = {.width = level->width, .height = level->height};
  rc_seen picture = {.flags = &size, .value = v->outside};
  rc_ruler ruler = {&picture, dx / length, dy / length, &level->chart};
  if (!rc_profile_mean(&ruler, ax + dx, ay + dy, RC_PROFILE_FROM_PX, 1, near, &own[1])) return 1;
  if (line->ends_inside)
    own[0] = own[1];
  else if (!rc_profile_mean(&ruler, ax, ay, -RC_PROFILE_FROM_PX, -1, near, &own[0]))
    return 1;
  picture.value = v->everywhere;
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

recede_status rc_lines_kept(rc_context *context, const rc_level *level, const rc_crossing *lines,
                            int count, int exponent, double *kept) {
  size_t pixels = (size_t)level->width * (size_t)level->height;
  views v = {.level = level};
  double sum = 0;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &v.outside));
  RC_TRY(RC_NEW(context, pixels, &v.everywhere));
  for (int i = 0; i < count; i++) {
    if (!i || memcmp(lines[i].axis, lines[i - 1].axis, sizeof lines->axis))
      look_by(lines[i].axis, &v);
    sum += line_kept(&v, &lines[i], exponent);
  }
  *kept = count ? sum / count : 1;
  rc_release(context, mark);
  return RECEDE_OK;
}
