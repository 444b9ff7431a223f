#include "synthesis/search/mincut.h"

#include <string.h>

#include "base/memory.h"

enum { FREE, OF_SOURCE, OF_SINK };
/* A pixel's parent: a direction, 0 .. 3, or: */
enum { NO_PARENT = -1, THE_END = -2, ORPHAN = -3 };
#define LAST -1   /* of a queue */
#define NOT_IN -2 /* any */
#define FAR INT32_MAX
/* Takes some 10 ms. */
#define PIXELS_TO_POLL 10000

typedef struct cut {
  rc_cut_grid *g;
  int step[4];
  int first, last; /* of the active pixels, linked by next */
  int32_t *orphans;
  int orphan_first, orphan_last, orphan_room; /* a ring */
  int32_t now;
} cut;

static int opposite(int direction) { return direction ^ 1; }

/* What could still flow between a pixel and its neighbour, away from the source, if the pixel is
 * nearer to the root of that tree. */
static int32_t left_over(const cut *c, int tree, int pixel, int direction) {
  const rc_cut_grid *g = c->g;
  return tree == OF_SOURCE ? g->beside[direction][pixel]
                           : g->beside[opposite(direction)][pixel + c->step[direction]];
}

static void activate(cut *c, int pixel) {
  rc_cut_grid *g = c->g;
  if (g->next[pixel] != NOT_IN) return;
  g->next[pixel] = LAST;
  if (c->last == LAST)
    c->first = pixel;
  else
    g->next[c->last] = pixel;
  c->last = pixel;
}

static int take_active(cut *c) {
  rc_cut_grid *g = c->g;
  while (c->first != LAST) {
    int pixel = c->first;
    c->first = g->next[pixel];
    if (c->first == LAST) c->last = LAST;
    g->next[pixel] = NOT_IN;
    if (g->tree[pixel] != FREE) return pixel;
  }
  return LAST;
}

static void make_orphan(cut *c, int pixel) {
  c->g->parent[pixel] = ORPHAN;
  c->orphans[c->orphan_last] = pixel;
  c->orphan_last = (c->orphan_last + 1) % c->orphan_room;
}

/* The least capacity on the way from a pixel to the root of its tree. */
static int32_t narrowest(const cut *c, int pixel, int32_t least) {
  const rc_cut_grid *g = c->g;
  int tree = g->tree[pixel];
  while (g->parent[pixel] != THE_END) {
    int direction = g->parent[pixel], up = pixel + c->step[direction];
    int32_t here = left_over(c, tree, up, opposite(direction));
    least = here < least ? here : least;
    pixel = up;
  }
  int32_t end = tree == OF_SOURCE ? g->end[pixel] : -g->end[pixel];
  return end < least ? end : least;
}

/* Sends the flow along that way. What has no capacity left is an orphan. */
static void send(cut *c, int pixel, int32_t flow) {
  rc_cut_grid *g = c->g;
  bool down = g->tree[pixel] == OF_SOURCE;
  while (g->parent[pixel] != THE_END) {
    int direction = g->parent[pixel], up = pixel + c->step[direction];
    int32_t *to_up = &g->beside[direction][pixel], *from_up = &g->beside[opposite(direction)][up];
    *to_up += down ? flow : -flow;
    *from_up -= down ? flow : -flow;
    if ((down ? *from_up : *to_up) == 0) make_orphan(c, pixel);
    pixel = up;
  }
  g->end[pixel] -= down ? flow : -flow;
  if (g->end[pixel] == 0) make_orphan(c, pixel);
}

/* From a pixel of the source's tree to its neighbour in the sink's. */
static void augment(cut *c, int pixel, int direction) {
  rc_cut_grid *g = c->g;
  int other = pixel + c->step[direction];
  int32_t flow = g->beside[direction][pixel];
  flow = narrowest(c, pixel, flow);
  flow = narrowest(c, other, flow);
  g->beside[direction][pixel] -= flow;
  g->beside[opposite(direction)][other] += flow;
  send(c, pixel, flow);
  send(c, other, flow);
}

/* Steps to the root of its tree, FAR if an orphan lies between; what was asked since the last
 * augmentation is remembered. */
static int32_t steps_to_root(cut *c, int pixel) {
  rc_cut_grid *g = c->g;
  int32_t steps = 0, all;
  int at = pixel;
  for (;; steps++) {
    if (g->time[at] == c->now) {
      all = steps + g->distance[at];
      break;
    }
    if (g->parent[at] == THE_END) {
      g->time[at] = c->now, g->distance[at] = 1;
      all = steps + 1;
      break;
    }
    if (g->parent[at] < 0) return FAR;
    at += c->step[g->parent[at]];
  }
  int32_t here = all;
  for (at = pixel; g->time[at] != c->now; at += c->step[g->parent[at]])
    g->time[at] = c->now, g->distance[at] = here--;
  return all;
}

/* Finds the orphan another parent, or lets it go. */
static void adopt(cut *c, int pixel) {
  rc_cut_grid *g = c->g;
  int tree = g->tree[pixel], best = NO_PARENT;
  int32_t least = FAR;
  for (int k = 0; k < 4; k++) {
    int other = pixel + c->step[k];
    if (g->tree[other] != tree || !left_over(c, tree, other, opposite(k))) continue;
    int32_t steps = steps_to_root(c, other);
    if (steps < least) least = steps, best = k;
  }
  if (best != NO_PARENT) {
    g->parent[pixel] = (int8_t)best;
    g->time[pixel] = c->now, g->distance[pixel] = least + 1;
    return;
  }
  for (int k = 0; k < 4; k++) {
    int other = pixel + c->step[k];
    if (g->tree[other] != tree) continue;
    if (left_over(c, tree, other, opposite(k))) activate(c, other);
    if (g->parent[other] == opposite(k)) make_orphan(c, other);
  }
  g->tree[pixel] = FREE, g->parent[pixel] = NO_PARENT;
}

/* Grows the tree of an active pixel. The direction in which it meets the other tree, or -1. */
static int grow(cut *c, int pixel) {
  rc_cut_grid *g = c->g;
  int tree = g->tree[pixel];
  for (int k = 0; k < 4; k++) {
    int other = pixel + c->step[k];
    if (!left_over(c, tree, pixel, k)) continue;
    if (g->tree[other] == FREE) {
      g->tree[other] = (uint8_t)tree, g->parent[other] = (int8_t)opposite(k);
      g->time[other] = g->time[pixel], g->distance[other] = g->distance[pixel] + 1;
      activate(c, other);
    } else if (g->tree[other] != tree) {
      return k;
    }
  }
  return -1;
}

recede_status rc_grid_new(rc_context *context, int width, int height, rc_cut_grid *grid) {
  size_t count = (size_t)width * (size_t)height;
  grid->width = width, grid->height = height;
  RC_TRY(RC_NEW(context, count, &grid->end));
  for (int k = 0; k < 4; k++) RC_TRY(RC_NEW(context, count, &grid->beside[k]));
  RC_TRY(RC_NEW(context, count, &grid->tree));
  RC_TRY(RC_NEW(context, count, &grid->parent));
  RC_TRY(RC_NEW(context, count, &grid->next));
  RC_TRY(RC_NEW(context, count, &grid->distance));
  return RC_NEW(context, count, &grid->time);
}

static void plant(cut *c) {
  rc_cut_grid *g = c->g;
  int count = g->width * g->height;
  for (int i = 0; i < count; i++) {
    g->tree[i] = g->end[i] > 0 ? OF_SOURCE : g->end[i] < 0 ? OF_SINK : FREE;
    g->parent[i] = g->end[i] ? THE_END : NO_PARENT;
    g->next[i] = NOT_IN, g->time[i] = 0, g->distance[i] = 1;
  }
  for (int i = 0; i < count; i++)
    if (g->tree[i] != FREE) activate(c, i);
}

recede_status rc_grid_cut(rc_context *context, rc_cut_grid *grid, uint8_t *at_sink) {
  int count = grid->width * grid->height, pixel;
  cut c = {.g = grid,
           .step = {-1, 1, -grid->width, grid->width},
           .first = LAST,
           .last = LAST,
           .orphan_room = count + 1};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count + 1, &c.orphans));
  plant(&c);
  for (int taken = 1; (pixel = take_active(&c)) != LAST; taken++) {
    int met;
    if (taken % PIXELS_TO_POLL == 0) RC_TRY(rc_poll(context));
    while (grid->tree[pixel] != FREE && (met = grow(&c, pixel)) >= 0) {
      bool forward = grid->tree[pixel] == OF_SOURCE;
      c.now++;
      augment(&c, forward ? pixel : pixel + c.step[met], forward ? met : opposite(met));
      while (c.orphan_first != c.orphan_last) {
        int orphan = c.orphans[c.orphan_first];
        c.orphan_first = (c.orphan_first + 1) % c.orphan_room;
        adopt(&c, orphan);
      }
    }
  }
  for (int i = 0; i < count; i++) at_sink[i] = grid->tree[i] == OF_SINK;
  rc_release(context, mark);
  return rc_poll(context);
}
