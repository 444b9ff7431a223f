#include "synthesis/regions.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/distance.h"
#include "synthesis/groups.h"

/* What is so far from the hole, in its widths, says what two textures there are. */
#define BESIDE_OF_HOLE .6
#define LEAST_BESIDE_PX 8
/* Of thin holes the coarsest level is large, and patches see across. */
#define MOST_PIXELS (1 << 17)
/* How much two groups must explain where there is one chord: a pier's light and dark end have .84,
 * and boards were cut between; a roof and a wall .87. Two chords hardly come by chance. */
#define LEAST_OF_ONE_CHORD .86
/* Each of them has so much of the hole's border. */
#define LEAST_SHARE .1
/* Two changes so near to each other are a spur of one texture (or lie on two parts of the hole that
 * nearly touch: then nothing is told). */
#define APART_PX 6.f
#define MOST_CHANGES 4
#define MOST_SEEN 32
/* A change's direction is that of the edge so far outwards. */
#define FOLLOWED_PX 7.f
/* Chords may turn from the edges' directions: 1 - cos at both ends together. A right angle cut by a
 * chord has .6; real ones had up to .2, chance ones from .76 on. */
#define MOST_TURN .7f
/* An edge that goes straight on out of the picture, where the hole does, counts as so much. */
#define TURN_OF_LEAVING .35f
/* Edges of one thing that leave may get so many times as far from each other, in the plane. */
#define MOST_OPENING 1.5f
/* A chord's pixels; and so near to its ends the border's are not asked. */
#define CHORD_PX .75f
#define ENDS_PX 4.f
/* The border is so wide. */
#define BORDER_PX 2

/* Where the edge of the textures meets that of the hole. */
typedef struct change {
  float x, y;
  float ux, uy; /* the edge's direction outwards, a unit vector, or 0 */
} change;

/* Lines through the hole from one change to another, or out of the picture. */
typedef struct chords {
  change end[MOST_CHANGES][2];
  int count;
  float turn; /* of all together */
} chords;

typedef struct finder {
  rc_context *context;
  rc_chart chart; /* of the level */
  rc_around around;
  int8_t *label;
  change ends[MOST_SEEN]; /* all changes, spurs too */
  int end_count;
} finder;

static bool on_border(const finder *f, int x, int y) {
  const rc_around *a = &f->around;
  size_t at = (size_t)y * (size_t)a->width + (size_t)x;
  return rc_inside(a->width, a->height, x, y) && f->label[at] && a->from_hole[at] &&
         a->from_hole[at] <= BORDER_PX;
}

static bool differ(const finder *f, int x, int y, int label) {
  const rc_around *a = &f->around;
  return rc_inside(a->width, a->height, x, y) &&
         f->label[(size_t)y * (size_t)a->width + (size_t)x] == -label;
}

/* Whether a pixel of the border touches one with the other label. */
static bool changes_at(const finder *f, int x, int y) {
  int label = f->label[(size_t)y * (size_t)f->around.width + (size_t)x];
  for (int j = y - 1; j <= y + 1; j++)
    for (int i = x - 1; i <= x + 1; i++)
      if (on_border(f, i, j) && differ(f, i, j, label)) return true;
  return false;
}

/* The change that a pixel is part of: the middle of those that touch one another in left, from
 * which they are taken. */
static change collect(const finder *f, int32_t pixel, uint8_t *left, int32_t *stack) {
  int width = f->around.width, depth = 0;
  float x = 0, y = 0, count = 0;
  stack[depth++] = pixel, left[pixel] = 0;
  while (depth) {
    int here = stack[--depth], hx = here % width, hy = here / width;
    x += (float)hx, y += (float)hy, count++;
    for (int j = hy - 1; j <= hy + 1; j++)
      for (int i = hx - 1; i <= hx + 1; i++) {
        if (!rc_inside(width, f->around.height, i, j) || !left[j * width + i]) continue;
        stack[depth++] = j * width + i, left[j * width + i] = 0;
      }
  }
  return (change){x / count, y / count, 0, 0};
}

/* Looks outwards where the edge leads. */
static void follow(const finder *f, change *c) {
  const rc_around *a = &f->around;
  int reach = (int)FOLLOWED_PX, cx = (int)(c->x + .5f), cy = (int)(c->y + .5f);
  for (int y = cy - reach; y <= cy + reach; y++)
    for (int x = cx - reach; x <= cx + reach; x++) {
      float dx = (float)x - c->x, dy = (float)y - c->y;
      if (!rc_inside(a->width, a->height, x, y) || dx * dx + dy * dy > FOLLOWED_PX * FOLLOWED_PX)
        continue;
      size_t at = (size_t)y * (size_t)a->width + (size_t)x;
      int label = a->from_hole[at] ? f->label[at] : 0;
      if (!label || !(differ(f, x - 1, y, label) || differ(f, x + 1, y, label) ||
                      differ(f, x, y - 1, label) || differ(f, x, y + 1, label)))
        continue;
      c->ux += dx, c->uy += dy;
    }
  float length = sqrtf(c->ux * c->ux + c->uy * c->uy);
  bool leads = length > .5f; /* px; else it leads nowhere */
  c->ux = leads ? c->ux / length : 0, c->uy = leads ? c->uy / length : 0;
}

static float apart(const change *a, const change *b) {
  return sqrtf((a->x - b->x) * (a->x - b->x) + (a->y - b->y) * (a->y - b->y));
}

/* Takes pairs of changes that are spurs out. */
static void drop_spurs(change changes[MOST_SEEN], int *count) {
  for (int i = 0; i < *count; i++)
    for (int k = i + 1; k < *count; k++) {
      if (apart(&changes[i], &changes[k]) >= APART_PX) continue;
      changes[k] = changes[--*count];
      changes[i] = changes[--*count];
      i = -1;
      break;
    }
}

/* count: none where there are more than can be told, or one texture has hardly any border. */
static recede_status find_changes(finder *f, change changes[MOST_SEEN], int *count) {
  const rc_around *a = &f->around;
  uint8_t *left;
  int32_t *stack;
  double border = 0, first = 0;
  rc_block *mark = rc_mark(f->context);
  RC_TRY(RC_NEW_ZERO(f->context, a->pixels, &left));
  RC_TRY(RC_NEW(f->context, a->pixels, &stack));
  *count = 0;
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++) {
      if (!on_border(f, x, y)) continue;
      border++, first += f->label[y * a->width + x] > 0;
      left[y * a->width + x] = changes_at(f, x, y);
    }
  for (size_t i = 0; i < a->pixels && *count < MOST_SEEN; i++)
    if (left[i]) changes[(*count)++] = collect(f, (int32_t)i, left, stack);
  rc_release(f->context, mark);
  if (*count == MOST_SEEN || first < LEAST_SHARE * border || first > (1 - LEAST_SHARE) * border)
    *count = 0;
  memcpy(f->ends, changes, (size_t)*count * sizeof *changes);
  f->end_count = *count;
  drop_spurs(changes, count);
  for (int i = 0; i < *count; i++) follow(f, &changes[i]);
  return rc_poll(f->context);
}

static float turn(const change *a, const change *b) {
  float length = fmaxf(apart(a, b), 1e-6f);
  float ux = (b->x - a->x) / length, uy = (b->y - a->y) / length;
  return 2.f + a->ux * ux + a->uy * uy - b->ux * ux - b->uy * uy;
}

static float side_of_chord(const change *a, const change *b, const change *p) {
  return (b->x - a->x) * (p->y - a->y) - (b->y - a->y) * (p->x - a->x);
}

static bool cross(const change *a, const change *b, const change *p, const change *q) {
  return side_of_chord(a, b, p) * side_of_chord(a, b, q) < 0 &&
         side_of_chord(p, q, a) * side_of_chord(p, q, b) < 0;
}

/* Where the edge would leave the picture if it went straight on through the hole. False: it would
 * reach something known. */
static bool leaves_the_picture(const finder *f, const change *c, change *end) {
  const rc_around *a = &f->around;
  bool in_hole = false;
  *end = *c;
  for (int step = 0; c->ux != 0 || c->uy != 0; step++) {
    end->x -= .5f * c->ux, end->y -= .5f * c->uy;
    int x = (int)floorf(end->x + .5f), y = (int)floorf(end->y + .5f);
    if (!rc_inside(a->image->width, a->image->height, a->box.x0 + x, a->box.y0 + y)) return in_hole;
    if (!rc_inside(a->width, a->height, x, y)) return false;
    if (a->from_hole[y * a->width + x] == 0)
      in_hole = true;
    else if (in_hole || step > 4 * BORDER_PX)
      return false;
  }
  return false;
}

static change in_plane(const finder *f, const change *c) {
  float x = c->x + (float)f->around.box.x0 - f->chart.x0;
  float y = c->y + (float)f->around.box.y0 - f->chart.y0;
  float w = fmaxf(1.f + f->chart.lx * x + f->chart.ly * y, 1e-3f);
  return (change){x / w, y / w, 0, 0};
}

/* Two edges that run the same way, farther and farther from each other: those of a stain. */
static bool opens(const finder *f, const change *a, const change *b, const change *p,
                  const change *q) {
  change from[2] = {in_plane(f, a), in_plane(f, p)}, to[2] = {in_plane(f, b), in_plane(f, q)};
  return a->ux * p->ux + a->uy * p->uy > 0 &&
         apart(&to[0], &to[1]) > MOST_OPENING * apart(&from[0], &from[1]);
}

/* Adds a chord. False: it crosses another, or leaves the picture and opens from one. */
static bool add_chord(const finder *f, chords *to, const change *a, const change *b, bool leaves,
                      float turned) {
  change *next = to->end[to->count];
  for (int i = 0; i < to->count; i++)
    if (cross(a, b, &to->end[i][0], &to->end[i][1]) ||
        (leaves && opens(f, a, b, &to->end[i][0], &to->end[i][1])))
      return false;
  next[0] = *a, next[1] = *b;
  to->count++, to->turn += turned;
  return true;
}

/* Tries all ways to pair up the changes that are not taken, or to lead them out of the picture. */
static void pair_up(const finder *f, const change *c, int count, unsigned taken,
                    const chords *sofar, chords *best) {
  int i = 0;
  change out;
  while (i < count && taken >> i & 1) i++;
  if (i == count) {
    if (sofar->turn < best->turn) *best = *sofar;
    return;
  }
  chords with = *sofar;
  if (leaves_the_picture(f, &c[i], &out) && add_chord(f, &with, &c[i], &out, true, TURN_OF_LEAVING))
    pair_up(f, c, count, taken | 1u << i, &with, best);
  for (int k = i + 1; k < count; k++) {
    with = *sofar;
    if (taken >> k & 1 || turn(&c[i], &c[k]) > MOST_TURN ||
        !add_chord(f, &with, &c[i], &c[k], false, turn(&c[i], &c[k])))
      continue;
    pair_up(f, c, count, taken | 1u << i | 1u << k, &with, best);
  }
}

static bool on_a_chord(const chords *c, float x, float y) {
  for (int i = 0; i < c->count; i++) {
    const change *from = &c->end[i][0], *to = &c->end[i][1];
    float ux = to->x - from->x, uy = to->y - from->y;
    float t = ((x - from->x) * ux + (y - from->y) * uy) / fmaxf(ux * ux + uy * uy, 1e-6f);
    t = fminf(fmaxf(t, 0.f), 1.f);
    change nearest = {from->x + t * ux, from->y + t * uy, 0, 0}, here = {x, y, 0, 0};
    if (apart(&nearest, &here) <= CHORD_PX) return true;
  }
  return false;
}

static bool near_an_end(const finder *f, float x, float y) {
  change here = {x, y, 0, 0};
  for (int i = 0; i < f->end_count; i++)
    if (apart(&f->ends[i], &here) <= ENDS_PX) return true;
  return false;
}

/* Spreads the labels of the border's pixels, near or not near ends of the edges, into what has none
 * yet of the hole, up to the chords. */
static void spread(const finder *f, const chords *c, bool near, int32_t *queue, bool *kept_apart) {
  static const int dx[4] = {1, -1, 0, 0}, dy[4] = {0, 0, 1, -1};
  const rc_around *a = &f->around;
  size_t first = 0, last = 0;
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++)
      if (on_border(f, x, y) && near_an_end(f, (float)x, (float)y) == near)
        queue[last++] = y * a->width + x;
  *kept_apart = true;
  while (first < last) {
    int here = queue[first++];
    for (int k = 0; k < 4; k++) {
      int x = here % a->width + dx[k], y = here / a->width + dy[k], next = y * a->width + x;
      if (!rc_inside(a->width, a->height, x, y) || a->from_hole[next] ||
          on_a_chord(c, (float)x, (float)y))
        continue;
      if (f->label[next] == -f->label[here]) *kept_apart = false;
      if (f->label[next]) continue;
      f->label[next] = f->label[here];
      queue[last++] = next;
    }
  }
}

/* Labels the hole. kept_apart: no two labels meet but at chords. What only an edge's end leads to,
 * in a corner of the picture, is asked last. */
static recede_status label_hole(const finder *f, const chords *c, bool *kept_apart) {
  int32_t *queue;
  bool unused;
  rc_block *mark = rc_mark(f->context);
  RC_TRY(RC_NEW(f->context, f->around.pixels, &queue));
  spread(f, c, false, queue, kept_apart);
  spread(f, c, true, queue, &unused);
  rc_release(f->context, mark);
  return rc_poll(f->context);
}

/* From the nearest chord or pixel of the other label, positive where the first is; what is not
 * known has none. */
static recede_status measure_distances(const finder *f, float *distance) {
  const rc_around *a = &f->around;
  uint8_t *own, *depth;
  rc_block *mark = rc_mark(f->context);
  RC_TRY(RC_NEW(f->context, a->pixels, &own));
  RC_TRY(RC_NEW(f->context, a->pixels, &depth));
  for (int label = -1; label <= 1; label += 2) {
    for (size_t i = 0; i < a->pixels; i++)
      own[i] = f->label[i] == label || (!f->label[i] && a->from_hole[i]);
    rc_distance_inside(own, 1, a->width, a->height, false, depth);
    for (size_t i = 0; i < a->pixels; i++)
      if (f->label[i] == label) distance[i] = (float)label * ((float)depth[i] - .5f);
  }
  rc_release(f->context, mark);
  return rc_poll(f->context);
}

/* beside_px: how far from the hole its textures are looked at. */
static recede_status measure_from_hole(finder *f, int *beside_px) {
  rc_around *a = &f->around;
  uint8_t *hole;
  int deepest = 0;
  RC_TRY(RC_NEW(f->context, a->pixels, &a->from_hole));
  RC_TRY(RC_NEW(f->context, a->pixels, &hole));
  for (size_t i = 0; i < a->pixels; i++) {
    int x = a->box.x0 + (int)(i % (size_t)a->width), y = a->box.y0 + (int)(i / (size_t)a->width);
    hole[i] = (*rc_flag(a->flags, x, y) & RC_TARGET) != 0;
  }
  rc_distance_inside(hole, 1, a->width, a->height, false, a->from_hole);
  for (size_t i = 0; i < a->pixels; i++) {
    deepest = a->from_hole[i] > deepest ? a->from_hole[i] : deepest;
    hole[i] = !hole[i];
  }
  rc_distance_inside(hole, 1, a->width, a->height, false, a->from_hole);
  *beside_px = (int)(BESIDE_OF_HOLE * 2 * deepest);
  if (*beside_px < LEAST_BESIDE_PX) *beside_px = LEAST_BESIDE_PX;
  return rc_poll(f->context);
}

static recede_status find(finder *f, float *distance, bool *two, int *count) {
  change changes[MOST_SEEN];
  chords none = {.count = 0}, best = {.turn = INFINITY};
  int beside_px, change_count = 0;
  bool found;
  double explained;
  *count = 0;
  RC_TRY(measure_from_hole(f, &beside_px));
  RC_TRY(RC_NEW_ZERO(f->context, f->around.pixels, &f->label));
  RC_TRY(rc_two_groups(f->context, &f->around, beside_px, f->label, &explained));
  if (explained > 0) RC_TRY(find_changes(f, changes, &change_count));
  *two = f->end_count > 0;
  if (!change_count || change_count > MOST_CHANGES) return RECEDE_OK;
  pair_up(f, changes, change_count, 0, &none, &best);
  if (!best.count || (best.count == 1 && explained < LEAST_OF_ONE_CHORD)) return RECEDE_OK;
  RC_TRY(label_hole(f, &best, &found));
  if (!found) return RECEDE_OK;
  *count = best.count;
  return measure_distances(f, distance);
}

recede_status rc_regions_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const rc_chart *chart, rc_regions *regions, bool *two,
                              int *chord_count) {
  rc_box box = rc_box_of(flags, RC_SOURCE | RC_TARGET);
  finder f = {.context = context,
              .chart = *chart,
              .around = {.image = image,
                         .flags = flags,
                         .box = box,
                         .width = box.x1 - box.x0,
                         .height = box.y1 - box.y0}};
  float *distance;
  f.around.pixels = (size_t)f.around.width * (size_t)f.around.height;
  *regions = (rc_regions){NULL, box.x0, box.y0, f.around.width, f.around.height, 1};
  *two = false, *chord_count = 0;
  if (f.around.pixels > MOST_PIXELS) return RECEDE_OK;
  RC_TRY(RC_NEW_ZERO(context, f.around.pixels, &distance));
  rc_block *mark = rc_mark(context);
  RC_TRY(find(&f, distance, two, chord_count));
  rc_release(context, mark);
  if (*chord_count)
    regions->distance = distance;
  else
    RC_FREE(context, &distance);
  return RECEDE_OK;
}
