#include "synthesis/search/whole.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "synthesis/search/evaluate.h"

/* The ring of known pixels around the hole that copies are compared with: so wide that it shows
 * where edges go. Of a long one every n-th pixel. */
#define RING_PX 3
#define MOST_RING 200
#define MOST_COPIES 48
/* A candidate is no better than none where it differs by more, in variances. */
#define NO_FIT 2.f
/* One more copy must take so much off the ring's misfit. */
#define LEAST_GAIN .05
/* Of boards each wants its own. */
#define LEAST_GAIN_OF_BOARDS .01
/* What the ring beside other boards counts: a board may lie wholly in the hole. */
#define OTHER_BOARD .001f
/* Ratios of scale that are compared at all. */
#define LEAST_RATIO .5f
#define MOST_RATIO 2.f

typedef struct candidate {
  rc_copy copy;
  float *misfit; /* at each pixel of the ring */
  float gain;    /* what it would take off the misfit of those chosen so far */
} candidate;

typedef struct whole {
  rc_level *level;
  int32_t *ring;
  int ring_count;
  candidate *candidates;
  int candidate_count; /* 0 where there is no source */
  float *least;        /* misfit of the chosen ones at each pixel of the ring */
  const candidate *chosen[MOST_COPIES];
  int chosen_count;
} whole;

static bool near_target(const rc_level *level, int x, int y) {
  for (int dy = -RING_PX; dy <= RING_PX; dy++)
    for (int dx = -RING_PX; dx <= RING_PX; dx++)
      if (rc_inside(level->width, level->height, x + dx, y + dy) &&
          rc_level_is_target(level, x + dx, y + dy))
        return true;
  return false;
}

/* Every n-th pixel of the ring, or with ring NULL how many pixels it has. */
static int collect_ring(const rc_level *level, int step, int32_t *ring) {
  int found = 0;
  for (int y = level->box.y0 - RING_PX; y < level->box.y1 + RING_PX; y++)
    for (int x = level->box.x0 - RING_PX; x < level->box.x1 + RING_PX; x++) {
      if (!rc_inside(level->width, level->height, x, y)) continue;
      int32_t pixel = y * level->width + x;
      if (!(level->flags[pixel] & RC_KNOWN) || !near_target(level, x, y)) continue;
      if (ring && found % step == 0) ring[found / step] = pixel;
      found++;
    }
  return ring ? (found + step - 1) / step : found;
}

static void measure(void *user, int item, int thread) {
  const whole *w = user;
  const rc_level *level = w->level;
  candidate *c = &w->candidates[item];
  (void)thread;
  for (int i = 0; i < w->ring_count; i++) {
    uint32_t pixel;
    int x = w->ring[i] % level->width, y = w->ring[i] / level->width;
    rc_place place =
        rc_copy_place(&level->chart, c->copy, rc_level_x(level, x), rc_level_y(level, y));
    c->misfit[i] = NO_FIT * level->variance;
    if (!rc_place_pixel(level, &place, &pixel)) continue;
    float misfit = rc_pixels_square(pixel, level->pixels[w->ring[i]]);
    if (misfit >= c->misfit[i]) continue;
    misfit += rc_place_price(level->variance, &place, LEAST_RATIO, MOST_RATIO);
    if (misfit < c->misfit[i]) c->misfit[i] = misfit;
  }
}

static void weigh(void *user, int item, int thread) {
  const whole *w = user;
  candidate *c = &w->candidates[item];
  (void)thread;
  c->gain = 0.f;
  for (int i = 0; i < w->ring_count; i++)
    c->gain += c->misfit[i] < w->least[i] ? w->least[i] - c->misfit[i] : 0.f;
}

/* One after the other the candidate that helps most. */
static recede_status choose(rc_context *context, whole *w, int most) {
  double sum = 0, least_gain = w->level->board ? LEAST_GAIN_OF_BOARDS : LEAST_GAIN;
  for (int i = 0; i < w->ring_count; i++) sum += w->least[i] = NO_FIT * w->level->variance;
  while (w->chosen_count < most && w->candidate_count) {
    const candidate *best = w->candidates;
    RC_TRY(rc_parallel(context, w->candidate_count, weigh, w));
    for (int n = 1; n < w->candidate_count; n++)
      if (w->candidates[n].gain > best->gain) best = &w->candidates[n];
    if (w->chosen_count && best->gain < least_gain * sum) break;
    sum -= best->gain;
    for (int i = 0; i < w->ring_count; i++) w->least[i] = fminf(w->least[i], best->misfit[i]);
    w->chosen[w->chosen_count++] = best;
  }
  return RECEDE_OK;
}

/* The chosen copy that fits the ring best, nearer pixels of the ring counting more. */
static void label(const whole *w, int x, int y) {
  rc_level *level = w->level;
  size_t at = rc_level_at(level, x, y);
  float misfit[MOST_COPIES] = {0}, least = INFINITY;
  rc_query query;
  for (int i = 0; i < w->ring_count; i++) {
    int ring_x = w->ring[i] % level->width, ring_y = w->ring[i] / level->width;
    float dx = (float)(ring_x - x), dy = (float)(ring_y - y);
    float weight = 1.f / (dx * dx + dy * dy);
    if (!rc_level_same_board(level, x, y, ring_x, ring_y)) weight *= OTHER_BOARD;
    for (int n = 0; n < w->chosen_count; n++) misfit[n] += weight * w->chosen[n]->misfit[i];
  }
  level->field[at] = (rc_copy){NAN, NAN, NAN};
  level->cost[at] = RC_NO_COST;
  rc_query_init(&query);
  rc_query_set(level, x, y, &query);
  for (int n = 0; n < w->chosen_count; n++) {
    uint32_t pixel;
    rc_place place = rc_query_place(level, &query, w->chosen[n]->copy);
    if (misfit[n] >= least || !rc_query_allows(level, &query, w->chosen[n]->copy, &place) ||
        !rc_place_pixel(level, &place, &pixel))
      continue;
    least = misfit[n];
    level->field[at] = w->chosen[n]->copy;
    level->pixels[(size_t)y * (size_t)level->width + (size_t)x] = pixel;
  }
}

/* What is locked has its copy. */
static void show_locked(const rc_level *level, int x, int y) {
  size_t at = rc_level_at(level, x, y);
  uint32_t pixel;
  rc_place place =
      rc_copy_place(&level->chart, level->field[at], rc_level_x(level, x), rc_level_y(level, y));
  if (rc_place_field_pixel(level, &place, at, &pixel))
    level->pixels[(size_t)y * (size_t)level->width + (size_t)x] = pixel;
}

static void label_row(void *user, int row, int thread) {
  const whole *w = user;
  const rc_level *level = w->level;
  int y = level->box.y0 + row;
  (void)thread;
  for (int x = level->box.x0; x < level->box.x1; x++) {
    if (!rc_level_is_target(level, x, y)) continue;
    if (level->locked && level->locked[rc_level_at(level, x, y)])
      show_locked(level, x, y);
    else
      label(w, x, y);
  }
}

/* Copies that take the hole's centroid, which is on the plane as all of the hole is, to a source.
 */
static void draw(whole *w, uint64_t key) {
  const rc_level *level = w->level;
  rc_sources all = rc_level_all_sources(level);
  double sum_x = 0, sum_y = 0, count = 0;
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++)
      if (rc_level_is_target(level, x, y)) sum_x += x, sum_y += y, count++;
  float x = (float)(sum_x / count) - level->chart.x0, y = (float)(sum_y / count) - level->chart.y0;
  w->candidate_count = all.begin < all.end ? RC_WHOLE_CANDIDATES : 0;
  for (int n = 0; n < w->candidate_count; n++) {
    int sx, sy;
    rc_level_random_source(level, all, rc_random(key, (uint32_t)n, 0, 0), &sx, &sy);
    w->candidates[n].copy =
        rc_copy_between(&level->chart, x, y, rc_level_x(level, sx), rc_level_y(level, sy));
  }
}

static void take(whole *w, const rc_copy *moves, int count) {
  w->candidate_count = count < RC_WHOLE_CANDIDATES ? count : RC_WHOLE_CANDIDATES;
  for (int n = 0; n < w->candidate_count; n++) w->candidates[n].copy = moves[n];
}

recede_status rc_start_whole(rc_context *context, rc_level *level, uint64_t key,
                             const rc_copy *moves, int move_count, int copies) {
  whole w = {.level = level};
  float *misfits;
  int step = collect_ring(level, 1, NULL) / MOST_RING + 1;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, MOST_RING, &w.ring));
  w.ring_count = collect_ring(level, step, w.ring);
  RC_TRY(RC_NEW(context, MOST_RING, &w.least));
  RC_TRY(RC_NEW(context, RC_WHOLE_CANDIDATES, &w.candidates));
  if (move_count)
    take(&w, moves, move_count);
  else
    draw(&w, key);
  RC_TRY(RC_NEW(context, (size_t)w.candidate_count * (size_t)w.ring_count, &misfits));
  for (int n = 0; n < w.candidate_count; n++)
    w.candidates[n].misfit = misfits + (size_t)n * (size_t)w.ring_count;
  RC_TRY(rc_parallel(context, w.candidate_count, measure, &w));
  RC_TRY(choose(context, &w, copies < MOST_COPIES ? copies : MOST_COPIES));
  RC_TRY(rc_parallel(context, level->box_h, label_row, &w));
  rc_release(context, mark);
  return RECEDE_OK;
}
