#include "plane/beyond.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/real.h"

/* Less of the hole is the horizon's own error. */
#define LEAST_CROSSED .005
/* A horizon read too high has some sky before it: what lies on the plane is more than so far below,
 * about the sine of the angle. */
#define SURELY_ON .09
/* Cells of so much of the hole's longer side, up to so far around it, each seen by its mean colour
 * and how far its brightness deviates. Fewer tell nothing. */
#define CELL_OF_HOLE (1. / 24)
#define LEAST_CELL_PX 4
#define AROUND_OF_HOLE .2
#define LEAST_CELLS 12
#define FEATURES 4
#define WEIGHT_OF_DEVIATION 2.f
/* A cell looks like others if its third nearest of them is no farther than that of 90 of 100 of
 * theirs. */
#define NEAREST 3
#define OWN_PERCENTILE 90

typedef struct cell {
  float value[FEATURES];
} cell;

typedef struct cells {
  cell *on, *beyond;
  int on_count, beyond_count;
} cells;

typedef struct view {
  const rc_image *image;
  const rc_mask *flags;
  const recede_plane *plane;
} view;

/* 1: the whole cell lies on the plane, -1: beyond; 0: on both sides, too near to the horizon to
 * say, or not all of it is known. */
static int side_of(const view *v, int x0, int y0, int side) {
  int on = 0, beyond = 0;
  for (int y = y0; y < y0 + side; y++)
    for (int x = x0; x < x0 + side; x++) {
      if (!(*rc_flag(v->flags, x, y) & RC_KNOWN)) return 0;
      double w = recede_plane_w(v->plane, x, y);
      on += w > SURELY_ON, beyond += w <= 0;
    }
  return on == side * side ? 1 : beyond == side * side ? -1 : 0;
}

static cell look(const view *v, int x0, int y0, int side) {
  cell c = {{0}};
  float sum = 0, square = 0, count = (float)(side * side);
  for (int y = y0; y < y0 + side; y++)
    for (int x = x0; x < x0 + side; x++) {
      float brightness = 0;
      for (int k = 0; k < v->image->channels; k++) {
        float value = rc_pixel(v->image, x, y)[k];
        c.value[k] += value / count, brightness += value / (float)v->image->channels;
      }
      sum += brightness, square += brightness * brightness;
    }
  c.value[FEATURES - 1] =
      WEIGHT_OF_DEVIATION * sqrtf(fmaxf(square / count - sum / count * (sum / count), 0));
  return c;
}

static recede_status gather(rc_context *context, const view *v, rc_box hole, cells *c) {
  int longer = rc_longer_side(hole), side = (int)(CELL_OF_HOLE * longer);
  if (side < LEAST_CELL_PX) side = LEAST_CELL_PX;
  rc_box box =
      rc_box_grown(hole, (int)(AROUND_OF_HOLE * longer), v->flags->width, v->flags->height);
  size_t most = (size_t)((box.x1 - box.x0) / side) * (size_t)((box.y1 - box.y0) / side);
  RC_TRY(RC_NEW(context, most + 1, &c->on));
  RC_TRY(RC_NEW(context, most + 1, &c->beyond));
  for (int y = box.y0; y + side <= box.y1; y += side)
    for (int x = box.x0; x + side <= box.x1; x += side) {
      int which = side_of(v, x, y, side);
      if (which > 0) c->on[c->on_count++] = look(v, x, y, side);
      if (which < 0) c->beyond[c->beyond_count++] = look(v, x, y, side);
    }
  return rc_poll(context);
}

/* The square of the distance to the third nearest of them, without itself. */
static float to_nearest(const cell *own, const cell *others, int count) {
  float nearest[NEAREST] = {INFINITY, INFINITY, INFINITY};
  for (int i = 0; i < count; i++) {
    float square = 0;
    if (&others[i] == own) continue;
    for (int k = 0; k < FEATURES; k++) {
      float off = own->value[k] - others[i].value[k];
      square += off * off;
    }
    for (int k = 0; k < NEAREST; k++) {
      if (!(square < nearest[k])) continue;
      float farther = nearest[k];
      nearest[k] = square, square = farther;
    }
  }
  return nearest[NEAREST - 1];
}

static recede_status compare(rc_context *context, const cells *c, double *part) {
  float *own;
  int alike = 0;
  if (c->on_count < LEAST_CELLS || c->beyond_count < LEAST_CELLS) return RECEDE_OK;
  RC_TRY(RC_NEW(context, c->on_count, &own));
  for (int i = 0; i < c->on_count; i++) own[i] = to_nearest(&c->on[i], c->on, c->on_count);
  qsort(own, (size_t)c->on_count, sizeof *own, rc_by_value);
  float most = own[c->on_count * OWN_PERCENTILE / 100];
  for (int i = 0; i < c->beyond_count; i++)
    alike += to_nearest(&c->beyond[i], c->on, c->on_count) <= most;
  *part = (double)alike / c->beyond_count;
  return rc_poll(context);
}

static bool is_crossed(const view *v, rc_box hole) {
  double all = 0, beyond = 0;
  for (int y = hole.y0; y < hole.y1; y++)
    for (int x = hole.x0; x < hole.x1; x++) {
      if (!(*rc_flag(v->flags, x, y) & RC_TARGET)) continue;
      all++, beyond += recede_plane_w(v->plane, x, y) <= 0;
    }
  return beyond > LEAST_CROSSED * all;
}

recede_status rc_alike_beyond(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const recede_plane *plane, double *part) {
  view v = {image, flags, plane};
  rc_box hole = rc_box_of(flags, RC_TARGET);
  cells c = {.on_count = 0};
  *part = 0;
  if (!is_crossed(&v, hole)) return RECEDE_OK;
  rc_block *mark = rc_mark(context);
  RC_TRY(gather(context, &v, hole, &c));
  RC_TRY(compare(context, &c, part));
  rc_release(context, mark);
  return RECEDE_OK;
}
