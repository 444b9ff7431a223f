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

/* What lies so far around the hole is looked at. */
#define AROUND_PX 64

/* A level as its line was seen: what is known of it from outside, and with its guide. */
typedef struct views {
  const rc_level *level;
  rc_box box; /* of the level, that they show */
  rc_mask size;
  rc_chart chart; /* of the box */
  float *outside, *everywhere;
} views;

static void look_by(const float axis[3], views *v) {
  const rc_level *level = v->level;
  float by[RC_COMPONENTS] = {0};
  size_t to = 0;
  for (int k = 0; k < RC_COMPONENTS; k++)
    for (int i = 0; i < 3; i++) by[k] += axis[i] * level->colours[k][i];
  for (int y = v->box.y0; y < v->box.y1; y++)
    for (int x = v->box.x0; x < v->box.x1; x++, to++) {
      size_t at = (size_t)y * (size_t)level->width + (size_t)x;
      float value = 0;
      for (int k = 0; k < RC_COMPONENTS; k++)
        value += by[k] * (float)(level->pixels[at] >> 8 * k & 255);
      v->outside[to] = level->flags[at] & (RC_SOURCE | RC_ALLOWED) ? value : NAN;
      v->everywhere[to] = level->flags[at] & (RC_KNOWN | RC_TARGET) ? value : NAN;
    }
}

static double line_kept(const views *v, const rc_crossing *line, int exponent) {
  rc_profile own[2], here;
  rc_crossing c = rc_crossing_coarser(*line, exponent);
  float unit = (float)(1 << exponent), sum = 0;
  float ax = c.ax - (float)v->box.x0, ay = c.ay - (float)v->box.y0, dx = c.bx - c.ax,
        dy = c.by - c.ay;
  float length = sqrtf(dx * dx + dy * dy), piece_px = length / LOOKED_AT;
  int near = (int)fmaxf(RC_PROFILE_NEAR_PX / unit, LEAST_NEAR_PX);
  int count = (int)fmaxf(piece_px, LEAST_PIECE_PX);
  rc_seen picture = {.flags = &v->size, .value = v->outside};
  rc_ruler ruler = {&picture, dx / length, dy / length, &v->chart};
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
  views v = {.level = level, .chart = level->chart};
  double sum = 0;
  *kept = 1;
  if (!count) return RECEDE_OK;
  v.box = rc_box_grown(level->box, AROUND_PX, level->width, level->height);
  v.size = (rc_mask){v.box.x1 - v.box.x0, v.box.y1 - v.box.y0, NULL};
  v.chart.x0 -= (float)v.box.x0, v.chart.y0 -= (float)v.box.y0;
  size_t pixels = (size_t)v.size.width * (size_t)v.size.height;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &v.outside));
  RC_TRY(RC_NEW(context, pixels, &v.everywhere));
  for (int i = 0; i < count; i++) {
    if (!i || memcmp(lines[i].axis, lines[i - 1].axis, sizeof lines->axis))
      look_by(lines[i].axis, &v);
    sum += line_kept(&v, &lines[i], exponent);
    RC_TRY(rc_poll(context));
  }
  *kept = sum / count;
  rc_release(context, mark);
  return RECEDE_OK;
}
