#include "synthesis/structure/chords.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Each of them has so much of the hole's border. */
#define LEAST_SHARE .1
/* Two changes so near to each other are a spur of one texture (or lie on two parts of the hole that
 * nearly touch: then nothing is told). */
#define APART_PX 6.f
/* Chords may turn from the edges' directions: 1 - cos at both ends together. A right angle cut by a
 * chord has .6; real ones had up to .2, chance ones from .76 on. */
#define MOST_TURN .7f
/* Edges that meet in a corner do so at 40 to 140 degrees, and count as so much. */
#define LEAST_SINE .64f
#define TURN_OF_CORNER .25f
/* Two that cross together turn by no more, and count as so much more: both edges of a kerb may be
 * paired up crosswise, too. */
#define MOST_TURN_OF_CROSSING .1f
#define PRICE_OF_CROSSING .4f
/* An edge that goes straight on out of the picture, where the hole does, counts as so much. */
#define TURN_OF_LEAVING .35f
/* Edges of one thing that leave may get so many times as far from each other, in the plane. */
#define MOST_OPENING 1.5f
typedef struct finder {
  rc_labels labels;
  const rc_chart *chart;
} finder;

/* Whether a pixel of the border touches one with the other label. */
static bool changes_at(const finder *f, int x, int y) {
  for (int j = y - 1; j <= y + 1; j++)
    for (int i = x - 1; i <= x + 1; i++)
      if (rc_on_border(&f->labels, i, j) && rc_labels_differ(&f->labels, x, y, i, j)) return true;
  return false;
}

/* The change that a pixel is part of: the middle of those that touch one another in left, from
 * which they are taken. */
static rc_change collect(const finder *f, int32_t pixel, uint8_t *left, int32_t *stack) {
  int width = f->labels.around->width, depth = 0;
  float x = 0, y = 0, count = 0;
  stack[depth++] = pixel, left[pixel] = 0;
  while (depth) {
    int here = stack[--depth], hx = here % width, hy = here / width;
    x += (float)hx, y += (float)hy, count++;
    for (int j = hy - 1; j <= hy + 1; j++)
      for (int i = hx - 1; i <= hx + 1; i++) {
        if (!rc_inside(width, f->labels.around->height, i, j) || !left[j * width + i]) continue;
        stack[depth++] = j * width + i, left[j * width + i] = 0;
      }
  }
  return (rc_change){x / count, y / count, 0, 0};
}

/* Takes pairs of changes that are spurs out. */
static void drop_spurs(rc_change changes[RC_MOST_CHANGES], int *count) {
  for (int i = 0; i < *count; i++)
    for (int k = i + 1; k < *count; k++) {
      if (rc_apart(&changes[i], &changes[k]) >= APART_PX) continue;
      changes[k] = changes[--*count];
      changes[i] = changes[--*count];
      i = -1;
      break;
    }
}

/* None where there are more than can be told, or one texture has hardly any border. */
static recede_status find_changes(rc_context *context, const finder *f, rc_chords *chords) {
  const rc_around *a = f->labels.around;
  int *count = &chords->change_count;
  uint8_t *left;
  int32_t *stack;
  double border = 0, first = 0;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, a->pixels, &left));
  RC_TRY(RC_NEW(context, a->pixels, &stack));
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++) {
      if (!rc_on_border(&f->labels, x, y)) continue;
      border++, first += f->labels.label[y * a->width + x] > 0;
      left[y * a->width + x] = changes_at(f, x, y);
    }
  for (size_t i = 0; i < a->pixels && *count < RC_MOST_CHANGES; i++)
    if (left[i]) chords->changes[(*count)++] = collect(f, (int32_t)i, left, stack);
  rc_release(context, mark);
  if (*count == RC_MOST_CHANGES || first < LEAST_SHARE * border ||
      first > (1 - LEAST_SHARE) * border)
    *count = 0;
  return rc_poll(context);
}

static float turn(const rc_change *a, const rc_change *b) {
  float length = fmaxf(rc_apart(a, b), 1e-6f);
  float ux = (b->x - a->x) / length, uy = (b->y - a->y) / length;
  return 2.f + a->ux * ux + a->uy * uy - b->ux * ux - b->uy * uy;
}

static float side_of_chord(const rc_change *a, const rc_change *b, const rc_change *p) {
  return (b->x - a->x) * (p->y - a->y) - (b->y - a->y) * (p->x - a->x);
}

static bool cross(const rc_change *a, const rc_change *b, const rc_change *p, const rc_change *q) {
  return side_of_chord(a, b, p) * side_of_chord(a, b, q) < 0 &&
         side_of_chord(p, q, a) * side_of_chord(p, q, b) < 0;
}

/* Whether both edges, going straight on, meet in the hole at something like a right angle. One that
 * leads nowhere does not: there is no sine. */
static bool make_a_corner(const finder *f, const rc_change *from, const rc_change *to,
                          rc_change *corner) {
  rc_change edges[2] = {rc_edge_straight(&f->labels, from), rc_edge_straight(&f->labels, to)},
            *a = edges, *b = edges + 1;
  float sine = a->ux * b->uy - a->uy * b->ux, dx = a->x - b->x, dy = a->y - b->y;
  if (fabsf(sine) < LEAST_SINE) return false;
  float s = (dx * b->uy - dy * b->ux) / sine, t = (dx * a->uy - dy * a->ux) / sine;
  *corner = (rc_change){a->x - s * a->ux, a->y - s * a->uy, 0, 0};
  int x = (int)floorf(corner->x + .5f), y = (int)floorf(corner->y + .5f);
  return s > 0 && t > 0 && rc_inside(f->labels.around->width, f->labels.around->height, x, y) &&
         !f->labels.around->from_hole[y * f->labels.around->width + x];
}

/* Where the edge would leave the picture if it went straight on through the hole. False: it would
 * reach something known. */
static bool leaves_the_picture(const finder *f, const rc_change *c, rc_change *end) {
  const rc_around *a = f->labels.around;
  bool in_hole = false;
  *end = *c;
  for (int step = 0; c->ux != 0 || c->uy != 0; step++) {
    end->x -= .5f * c->ux, end->y -= .5f * c->uy;
    int x = (int)floorf(end->x + .5f), y = (int)floorf(end->y + .5f);
    if (!rc_inside(a->image->width, a->image->height, a->box.x0 + x, a->box.y0 + y)) return in_hole;
    if (!rc_inside(a->width, a->height, x, y)) return false;
    if (a->from_hole[y * a->width + x] == 0)
      in_hole = true;
    else if (in_hole || step > 4 * RC_BORDER_PX)
      return false;
  }
  return false;
}

static rc_change in_plane(const finder *f, const rc_change *c) {
  float x = c->x + (float)f->labels.around->box.x0 - f->chart->x0;
  float y = c->y + (float)f->labels.around->box.y0 - f->chart->y0;
  float w = fmaxf(1.f + f->chart->lx * x + f->chart->ly * y, 1e-3f);
  return (rc_change){x / w, y / w, 0, 0};
}

/* Two edges that run the same way, farther and farther from each other: those of a stain. */
static bool opens(const finder *f, const rc_change *a, const rc_change *b, const rc_change *p,
                  const rc_change *q) {
  rc_change from[2] = {in_plane(f, a), in_plane(f, p)}, to[2] = {in_plane(f, b), in_plane(f, q)};
  return a->ux * p->ux + a->uy * p->uy > 0 &&
         rc_apart(&to[0], &to[1]) > MOST_OPENING * rc_apart(&from[0], &from[1]);
}

static bool crosses(const rc_chords *chords, const rc_change *a, const rc_change *b) {
  for (int i = 0; i < chords->piece_count; i++)
    if (cross(a, b, &chords->end[i][0], &chords->end[i][1])) return true;
  return false;
}

static void add_piece(rc_chords *to, const rc_change *a, const rc_change *b) {
  rc_change *next = to->end[to->piece_count++];
  next[0] = *a, next[1] = *b;
}

/* A straight chord. Two may cross, as on a chess board: of what is around them every other part has
 * the same label. False: they cross, but not as straight edges would. */
static bool add_chord(rc_chords *to, const rc_change *a, const rc_change *b) {
  to->count++, to->turn += turn(a, b);
  if (crosses(to, a, b)) {
    if (to->turn > MOST_TURN_OF_CROSSING) return false;
    to->turn += PRICE_OF_CROSSING;
  }
  add_piece(to, a, b);
  return true;
}

/* One that leaves the picture. False: it crosses another, or opens from one. */
static bool add_leaving_chord(const finder *f, rc_chords *to, const rc_change *a,
                              const rc_change *b) {
  if (crosses(to, a, b)) return false;
  for (int i = 0; i < to->piece_count; i++)
    if (opens(f, a, b, &to->end[i][0], &to->end[i][1])) return false;
  to->count++, to->turn += TURN_OF_LEAVING;
  add_piece(to, a, b);
  return true;
}

/* One that turns in a corner. False: it crosses another. */
static bool add_bent_chord(rc_chords *to, const rc_change *a, const rc_change *b,
                           const rc_change *corner) {
  if (crosses(to, a, corner) || crosses(to, corner, b)) return false;
  to->count++, to->turn += TURN_OF_CORNER;
  add_piece(to, a, corner), add_piece(to, corner, b);
  return true;
}

static bool in_hole(const finder *f, const rc_change *c) {
  const rc_around *a = f->labels.around;
  int x = (int)floorf(c->x + .5f), y = (int)floorf(c->y + .5f);
  return rc_inside(a->width, a->height, x, y) && a->from_hole[y * a->width + x] <= RC_BORDER_PX;
}

/* The only one, which goes round on a circle and does not turn from the edges. False: there is no
 * circle, or it leads out of the hole. */
static bool add_arc(const finder *f, rc_chords *to, const rc_change *a, const rc_change *b) {
  rc_change points[RC_MOST_ARC_PIECES + 1];
  int pieces = rc_edge_arc(&f->labels, a, b, points);
  for (int i = 1; i < pieces; i++)
    if (!in_hole(f, &points[i])) return false;
  for (int i = 0; i < pieces; i++) add_piece(to, &points[i], &points[i + 1]);
  to->count++;
  return pieces > 0;
}

/* Tries all ways to pair up the changes that are not taken, or to lead them out of the picture. */
static void pair_up(const finder *f, const rc_change *c, int count, unsigned taken,
                    const rc_chords *sofar, rc_chords *best) {
  int i = 0;
  rc_change out;
  while (i < count && taken >> i & 1) i++;
  if (i == count) {
    if (sofar->turn < best->turn) *best = *sofar;
    return;
  }
  rc_chords with = *sofar;
  if (leaves_the_picture(f, &c[i], &out) && add_leaving_chord(f, &with, &c[i], &out))
    pair_up(f, c, count, taken | 1u << i, &with, best);
  for (int k = i + 1; k < count; k++) {
    unsigned both = taken | 1u << i | 1u << k;
    rc_change corner;
    if (taken >> k & 1) continue;
    with = *sofar;
    /* Of more edges it is not told which two make an arc, or a corner. */
    if (count == 2 && add_arc(f, &with, &c[i], &c[k])) pair_up(f, c, count, both, &with, best);
    with = *sofar;
    if (count == 2 && make_a_corner(f, &c[i], &c[k], &corner) &&
        add_bent_chord(&with, &c[i], &c[k], &corner))
      pair_up(f, c, count, both, &with, best);
    with = *sofar;
    if (turn(&c[i], &c[k]) <= MOST_TURN && add_chord(&with, &c[i], &c[k]))
      pair_up(f, c, count, both, &with, best);
  }
}

recede_status rc_chords_find(rc_context *context, const rc_around *around, const rc_chart *chart,
                             const int8_t *label, rc_chords *chords) {
  finder f = {{around, label}, chart};
  rc_change changes[RC_MOST_CHANGES];
  rc_chords none = {.count = 0}, best = {.turn = INFINITY};
  *chords = none;
  RC_TRY(find_changes(context, &f, chords));
  int count = chords->change_count;
  memcpy(changes, chords->changes, sizeof changes);
  drop_spurs(changes, &count);
  if (!count || count > RC_MOST_CHORDS) return RECEDE_OK;
  for (int i = 0; i < count; i++) rc_edge_follow(&f.labels, &changes[i]);
  pair_up(&f, changes, count, 0, &none, &best);
  memcpy(chords->end, best.end, sizeof best.end);
  chords->count = best.count, chords->piece_count = best.piece_count, chords->turn = best.turn;
  return RECEDE_OK;
}
