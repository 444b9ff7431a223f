/* Graph cuts by expansion (Boykov, Veksler and Zabih 2001): in turn each of the largest copies may
 * take any pixel where that makes the sum cheaper of what copies cost at their pixels and of what
 * they differ by along the seams. */
#include "synthesis/search/cuts.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/search/evaluate.h"
#include "synthesis/search/mincut.h"
#include "synthesis/search/usage.h"

/* So many copies may expand, the largest, and those that take anything once more. */
#define MOST_COPIES 16
#define LEAST_PIXELS 4
#define ROUNDS 2
/* Squares of differences are told in so many times what neighbours within a copy differ by, bytes:
 * of textures that is half their variance, but smooth sand must not be measured by its shadows. */
#define UNIT_OF_CHANGES 5.
#define LEAST_UNIT 1.f
/* Beside what is known the distance of a copy's patch counts so much times the part that is known.
 * Deeper in the hole any stone will do; but what the guide has nothing of, a person's shadow in
 * sand, costs a little of the square that it differs by. */
#define OF_KNOWN 4.f
#define OF_GUIDE .01f
/* A seam costs what the copies differ by at both pixels, and so much in itself. */
#define OF_SEAM .02f
/* A source that other copies show, too, costs so much: of drawn stones .076 come again without a
 * price, .049 by .05, .039 by .1; by .2 more of them are chips. */
#define OF_USE .1f
/* Capacities are integers, so many to a unit, and none may count more than MOST, but a copy that is
 * not allowed more than all seams of a pixel. */
#define FIXED_POINT 1000.f
#define MOST (1 << 23)
#define FORBIDDEN (1 << 27)

typedef struct colour {
  float value[RC_COMPONENTS];
} colour;

typedef struct cuts {
  const rc_kernels *kernels;
  rc_level *level;
  rc_cut_grid grid; /* of the box and a frame of 1 px */
  /* Of the grid's pixels: */
  uint8_t *part;  /* those that take part */
  float *known;   /* what a distance counts */
  float *cost;    /* of the own copy */
  float *cost_of; /* of the copy that expands */
  colour *own;    /* what the own copy has here and to the left, right, above and below */
  colour *other;  /* what the one that expands has */
  uint8_t *taken;
  float *uses; /* of every pixel of the picture; NULL: they cost nothing */
  float unit;  /* of squares */
} cuts;

static colour colour_of(uint32_t pixel) {
  colour c;
  for (int k = 0; k < RC_COMPONENTS; k++) c.value[k] = (float)(pixel >> 8 * k & 255);
  return c;
}

static const int step_x[4] = {-1, 1, 0, 0}, step_y[4] = {0, 0, -1, 1};

static size_t grid_at(const cuts *c, int x, int y) {
  return (size_t)(y - c->level->box.y0 + 1) * (size_t)c->grid.width +
         (size_t)(x - c->level->box.x0 + 1);
}

/* What a copy has at (x, y), between the pixels. */
static colour sample(const rc_level *level, rc_copy copy, int x, int y) {
  colour c = {{0, 0, 0, 0}};
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
  if (place.beyond) return c;
  float sx = fminf(fmaxf(place.x + level->chart.x0, 0.f), (float)(level->width - 1));
  float sy = fminf(fmaxf(place.y + level->chart.y0, 0.f), (float)(level->height - 1));
  int ix = (int)sx, iy = (int)sy;
  int right = ix + 1 < level->width, below = iy + 1 < level->height ? level->width : 0;
  const uint32_t *at = level->pixels + (size_t)iy * (size_t)level->width + (size_t)ix;
  float fx = sx - (float)ix, fy = sy - (float)iy;
  for (int k = 0; k < RC_COMPONENTS; k++) {
    float a = (float)(at[0] >> 8 * k & 255), b = (float)(at[right] >> 8 * k & 255);
    float d = (float)(at[below] >> 8 * k & 255), e = (float)(at[below + right] >> 8 * k & 255);
    c.value[k] = (a + (b - a) * fx) * (1 - fy) + (d + (e - d) * fx) * fy;
  }
  return c;
}

static int32_t fixed(float value) {
  return value < (float)MOST / FIXED_POINT ? rc_floor(value * FIXED_POINT + .5f) : MOST;
}

/* Of two copies that differ by so much at the two pixels of a seam; 0: it is none. */
static int32_t seam(const cuts *c, float here, float there) {
  if (here + there <= 0.f) return 0;
  return fixed(OF_SEAM + (here + there) / sqrtf(c->unit));
}

static bool is_known(const rc_level *level, int x, int y) {
  uint8_t flags = level->flags[(size_t)y * (size_t)level->width + (size_t)x];
  return (flags & (RC_TARGET | RC_KNOWN)) == RC_KNOWN;
}

/* How much of the patch is known. */
static float known_part(const rc_level *level, int x, int y) {
  int known = 0;
  for (int j = y - RC_PATCH_RADIUS; j <= y + RC_PATCH_RADIUS; j++)
    for (int i = x - RC_PATCH_RADIUS; i <= x + RC_PATCH_RADIUS; i++)
      known += rc_inside(level->width, level->height, i, j) && is_known(level, i, j);
  return (float)known / RC_PATCH_PIXELS;
}

static float square_apart(const colour *p, const colour *q) {
  float sum = 0;
  for (int k = 0; k < RC_COMPONENTS; k++)
    sum += (p->value[k] - q->value[k]) * (p->value[k] - q->value[k]);
  return sum;
}

static float apart(const colour *p, const colour *q) { return sqrtf(square_apart(p, q)); }

static float distance_of(const cuts *c, rc_query *query, rc_copy copy) {
  rc_place place = rc_query_place(c->level, query, copy);
  return rc_query_cost(c->level, c->kernels, query, copy, &place, RC_NO_COST);
}

/* What a copy that shows this colour costs, in units; RC_NO_COST: it is not allowed. */
static float cost_at(const cuts *c, rc_query *query, rc_copy copy, const colour *shown, int x,
                     int y) {
  float known = c->known[grid_at(c, x, y)], unit = c->unit;
  colour guide = colour_of(c->level->pixels[(size_t)y * (size_t)c->level->width + (size_t)x]);
  float odd = OF_GUIDE * square_apart(shown, &guide) / unit;
  rc_query_set(c->level, x, y, query);
  if (!rc_query_is_kind(c->level, query, copy)) return RC_NO_COST;
  if (known > 0.f) {
    float cost = distance_of(c, query, copy);
    return cost < RC_NO_COST ? known * cost / unit + odd : cost;
  }
  rc_place place = rc_query_place(c->level, query, copy);
  float price = rc_query_price(c->level, query, copy, &place);
  return price < RC_NO_COST ? price / unit + odd : price;
}

/* How many pixels here and around have the copy. */
static int count_own(const cuts *c, rc_copy copy, int x, int y) {
  int count = 0;
  for (int j = y - 1; j <= y + 1; j++)
    for (int i = x - 1; i <= x + 1; i++)
      count += c->part[grid_at(c, i, j)] &&
               rc_same_copy(c->level->field[rc_level_at(c->level, i, j)], copy);
  return count;
}

/* What it costs that others show the copy's source at (x, y), too. */
static float price_of_use(const cuts *c, rc_copy copy, int x, int y) {
  const rc_level *level = c->level;
  rc_place place = rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
  size_t at;
  if (!c->uses || !rc_place_at(level, &place, &at)) return 0.f;
  int sx = (int)(at % (size_t)level->width), sy = (int)(at / (size_t)level->width);
  float uses = 0;
  for (int j = -1; j <= 1; j++)
    for (int i = -1; i <= 1; i++)
      if (rc_inside(level->width, level->height, sx + i, sy + j))
        uses += c->uses[(size_t)(sy + j) * (size_t)level->width + (size_t)(sx + i)];
  uses -= (float)count_own(c, copy, x, y) * rc_use_of(copy, &place);
  return OF_USE * fminf(fmaxf(uses / 9, 0.f), 1.f);
}

static void look_at_own(cuts *c, int x, int y) {
  size_t at = grid_at(c, x, y);
  rc_copy copy = c->level->field[rc_level_at(c->level, x, y)];
  c->own[5 * at] = sample(c->level, copy, x, y);
  for (int k = 0; k < 4; k++)
    c->own[5 * at + 1 + (size_t)k] = sample(c->level, copy, x + step_x[k], y + step_y[k]);
}

static recede_status prepare(rc_context *context, bool price_uses, cuts *c) {
  rc_level *level = c->level;
  size_t count = (size_t)(level->box_w + 2) * (size_t)(level->box_h + 2);
  RC_TRY(rc_grid_new(context, level->box_w + 2, level->box_h + 2, &c->grid));
  RC_TRY(RC_NEW_ZERO(context, count, &c->part));
  RC_TRY(RC_NEW(context, count, &c->known));
  RC_TRY(RC_NEW(context, count, &c->cost));
  RC_TRY(RC_NEW(context, count, &c->cost_of));
  RC_TRY(RC_NEW(context, 5 * count, &c->own));
  RC_TRY(RC_NEW(context, count, &c->other));
  RC_TRY(RC_NEW(context, count, &c->taken));
  if (price_uses) RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &c->uses));
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = grid_at(c, x, y);
      if (!rc_level_is_target(level, x, y) || isnan(level->field[rc_level_at(level, x, y)].a))
        continue;
      c->part[at] = 1;
      c->known[at] = OF_KNOWN * known_part(level, x, y);
      look_at_own(c, x, y);
    }
  return rc_poll(context);
}

/* What the own copies cost, and in which unit. */
static recede_status price_own(rc_context *context, cuts *c) {
  const rc_level *level = c->level;
  double changes = 0, count = 0;
  rc_query query;
  rc_query_init(&query);
  for (size_t at = 0; at < (size_t)c->grid.width * (size_t)c->grid.height; at++)
    for (int k = 1; k < 5 && c->part[at]; k++, count++)
      changes += (double)square_apart(&c->own[5 * at], &c->own[5 * at + (size_t)k]);
  c->unit = (float)(UNIT_OF_CHANGES * changes / fmax(count, 1)) + LEAST_UNIT;
  for (int y = level->box.y0; y < level->box.y1; y++) {
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = grid_at(c, x, y);
      if (c->part[at])
        c->cost[at] =
            cost_at(c, &query, level->field[rc_level_at(level, x, y)], &c->own[5 * at], x, y);
    }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

/* Adds what the seams between a pixel and its neighbour, right or below, ask for. */
static void add_edge(const cuts *c, size_t at, size_t next, int direction) {
  const colour *p = &c->own[5 * at], *q = &c->own[5 * next];
  int back = direction ^ 1;
  int32_t both = seam(c, apart(&p[0], &q[1 + back]), apart(&p[1 + direction], &q[0]));
  int32_t first = seam(c, apart(&p[0], &c->other[at]), apart(&p[1 + direction], &c->other[next]));
  int32_t second = seam(c, apart(&q[1 + back], &c->other[at]), apart(&q[0], &c->other[next]));
  /* first: the own copy here and the new one there; second: the other way round. */
  c->grid.end[at] += second - both;
  c->grid.end[next] -= second;
  int32_t across = first + second - both;
  c->grid.beside[direction][at] = across > 0 ? across : 0;
}

/* Lets a copy take what it makes cheaper. */
static recede_status expand(rc_context *context, cuts *c, rc_copy copy, bool *changed) {
  rc_level *level = c->level;
  rc_cut_grid *g = &c->grid;
  size_t count = (size_t)g->width * (size_t)g->height;
  rc_query query;
  rc_query_init(&query);
  /* As they are before: what this expansion itself changes is not seen. */
  if (c->uses) rc_count_uses(level, c->uses);
  memset(g->end, 0, count * sizeof *g->end);
  for (int k = 0; k < 4; k++) memset(g->beside[k], 0, count * sizeof *g->beside[k]);
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = grid_at(c, x, y);
      if (!c->part[at]) continue;
      c->other[at] = sample(level, copy, x, y);
      c->cost_of[at] = cost_at(c, &query, copy, &c->other[at], x, y);
      rc_copy own = level->field[rc_level_at(level, x, y)];
      int32_t taken = fixed(c->cost_of[at] + price_of_use(c, copy, x, y));
      int32_t kept = fixed(c->cost[at] + price_of_use(c, own, x, y));
      g->end[at] += c->cost_of[at] < RC_NO_COST ? taken - kept : FORBIDDEN;
    }
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = grid_at(c, x, y), right = at + 1, below = at + (size_t)g->width;
      if (!c->part[at]) continue;
      if (c->part[right]) add_edge(c, at, right, 1);
      if (c->part[below]) add_edge(c, at, below, 3);
    }
  RC_TRY(rc_grid_cut(context, g, c->taken));
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      size_t at = grid_at(c, x, y), own = rc_level_at(level, x, y);
      if (!c->taken[at] || rc_same_copy(level->field[own], copy)) continue;
      level->field[own] = copy, c->cost[at] = c->cost_of[at];
      look_at_own(c, x, y);
      *changed = true;
    }
  return rc_poll(context);
}

typedef struct candidate {
  rc_copy copy;
  int pixels;
} candidate;

/* The largest copies of the field; how many. */
static recede_status find_copies(rc_context *context, const rc_level *level,
                                 candidate chosen[MOST_COPIES], int *count) {
  int pixels = level->box_w * level->box_h, all = 0;
  candidate *found;
  *count = 0;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &found));
  for (int y = level->box.y0; y < level->box.y1; y++) {
    for (int x = level->box.x0; x < level->box.x1; x++) {
      rc_copy copy = level->field[rc_level_at(level, x, y)];
      int i = all - 1;
      if (!rc_level_is_target(level, x, y) || isnan(copy.a)) continue;
      while (i >= 0 && !rc_same_copy(found[i].copy, copy)) i--;
      if (i < 0) i = all++, found[i] = (candidate){copy, 0};
      found[i].pixels++;
    }
    RC_TRY(rc_poll(context));
  }
  while (*count < MOST_COPIES) {
    int most = 0;
    for (int i = 1; i < all; i++)
      if (found[i].pixels > found[most].pixels) most = i;
    if (!all || found[most].pixels < LEAST_PIXELS) break;
    chosen[(*count)++] = found[most];
    found[most].pixels = 0;
  }
  rc_release(context, mark);
  return rc_poll(context);
}

recede_status rc_cut_copies(rc_context *context, const rc_kernels *kernels, bool price_uses,
                            rc_level *level) {
  cuts c = {.kernels = kernels, .level = level};
  candidate copies[MOST_COPIES];
  int count;
  RC_TRY(find_copies(context, level, copies, &count));
  rc_block *mark = rc_mark(context);
  RC_TRY(prepare(context, price_uses, &c));
  RC_TRY(price_own(context, &c));
  for (int round = 0; round < ROUNDS; round++) {
    int left = 0;
    for (int i = 0; i < count; i++) {
      bool changed = false;
      RC_TRY(expand(context, &c, copies[i].copy, &changed));
      if (changed) copies[left++] = copies[i];
    }
    count = left;
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
