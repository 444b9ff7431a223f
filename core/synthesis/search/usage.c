#include "synthesis/search/usage.h"

#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/search/evaluate.h"

/* Uses are counted per pixel and averaged over a square of 5 px. */
#define AROUND 2
/* One use is free: whole copies are right, and half a use broke bricks' joints. Then .2 variances
 * for each more, up to four: hard cases gained 3 points by prices of .1 to .3. */
#define FREE_USES 1.f
#define PRICE_OF_USE .2f
#define MOST_USES 4.f

/* Adds for each pixel of the field what it shows of its source, or for the search the inverse, as
 * of flat copies: what is magnified is used up sooner, for it is blurred, too. By what it shows
 * five photos score 59 and 61 instead of 65, the cases the same. */
static void count_uses(const rc_level *level, bool for_search, float *uses) {
  memset(uses, 0, (size_t)level->width * (size_t)level->height * sizeof *uses);
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      rc_copy copy = level->field[rc_level_at(level, x, y)];
      if (isnan(copy.a)) continue;
      rc_place place =
          rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
      size_t at;
      if (!rc_place_at(level, &place, &at)) continue;
      uses[at] +=
          for_search ? 1.f / (place.ratio * place.ratio * place.ratio) : rc_use_of(copy, &place);
    }
}

void rc_count_uses(const rc_level *level, float *uses) { count_uses(level, false, uses); }

typedef struct averaging {
  const rc_level *level;
  float *price, *across;
} averaging;

/* The means over 2 AROUND + 1 pixels; beyond the picture's borders nothing is used. */
static void average_across(void *user, int y, int thread) {
  const averaging *a = user;
  int width = a->level->width;
  const float *from = a->price + (size_t)y * (size_t)width;
  float *restrict to = a->across + (size_t)y * (size_t)width;
  (void)thread;
  for (int x = 0; x < width; x++) to[x] = 0.f;
  for (int k = -AROUND; k <= AROUND; k++) {
    int first = k < 0 ? -k : 0, end = k > 0 ? width - k : width;
    for (int x = first; x < end; x++) to[x] += from[x + k];
  }
  for (int x = 0; x < width; x++) to[x] /= 2 * AROUND + 1;
}

static void average_along(void *user, int y, int thread) {
  const averaging *a = user;
  size_t width = (size_t)a->level->width;
  int height = a->level->height;
  int first = y > AROUND ? y - AROUND : 0, last = y + AROUND < height ? y + AROUND : height - 1;
  float *to = a->price + (size_t)y * width, unit = PRICE_OF_USE * a->level->variance;
  (void)thread;
  for (size_t x = 0; x < width; x++) to[x] = 0.f;
  for (int k = first; k <= last; k++) {
    const float *from = a->across + (size_t)k * width;
    for (size_t x = 0; x < width; x++) to[x] += from[x];
  }
  for (size_t x = 0; x < width; x++) {
    float uses = to[x] / (2 * AROUND + 1) - FREE_USES;
    uses = uses < 0.f ? 0.f : uses;
    to[x] = unit * (uses > MOST_USES ? MOST_USES : uses);
  }
}

recede_status rc_usage_prices(rc_context *context, const rc_level *level, float *price) {
  size_t count = (size_t)level->width * (size_t)level->height;
  averaging a = {level, price, NULL};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &a.across));
  count_uses(level, true, price);
  RC_TRY(rc_parallel(context, level->height, average_across, &a));
  RC_TRY(rc_parallel(context, level->height, average_along, &a));
  rc_release(context, mark);
  return RECEDE_OK;
}
