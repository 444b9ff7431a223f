#include "synthesis/usage.h"

#include "base/memory.h"
#include "synthesis/evaluate.h"

/* Uses are counted per pixel and averaged over a square of 5 px. */
#define AROUND 2
/* A use in two is free: a hole's neighbourhood holds several times its pixels. Then .2 variances
 * for each more: hard cases gained 3 points by prices of .1 to .3. */
#define FREE_USES .5f
#define PRICE_OF_USE .2f
#define MOST_USES 4.f

static void count_uses(const rc_level *level, float *uses) {
  for (int y = level->box.y0; y < level->box.y1; y++)
    for (int x = level->box.x0; x < level->box.x1; x++) {
      if (!rc_level_is_target(level, x, y)) continue;
      rc_copy copy = level->field[rc_level_at(level, x, y)];
      if (isnan(copy.a)) continue;
      rc_place place =
          rc_copy_place(&level->chart, copy, rc_level_x(level, x), rc_level_y(level, y));
      size_t at;
      /* A target pixel covers 1 / area scale of the source's. */
      if (rc_place_at(level, &place, &at))
        uses[at] += 1.f / (place.ratio * place.ratio * place.ratio);
    }
}

/* The mean over 2 AROUND + 1 pixels of a line; beyond its ends nothing is used. */
static void average_line(const float *from, float *to, int count, size_t step) {
  for (int i = 0; i < count; i++) {
    float sum = 0.f;
    int first = i > AROUND ? i - AROUND : 0, last = i + AROUND < count ? i + AROUND : count - 1;
    for (int k = first; k <= last; k++) sum += from[(size_t)k * step];
    to[(size_t)i * step] = sum / (2 * AROUND + 1);
  }
}

recede_status rc_usage_prices(rc_context *context, const rc_level *level, float *price) {
  size_t width = (size_t)level->width, count = width * (size_t)level->height;
  float *rows;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, count, &rows));
  for (size_t i = 0; i < count; i++) price[i] = 0.f;
  count_uses(level, price);
  for (int y = 0; y < level->height; y++)
    average_line(price + (size_t)y * width, rows + (size_t)y * width, level->width, 1);
  for (int x = 0; x < level->width; x++) average_line(rows + x, price + x, level->height, width);
  for (size_t i = 0; i < count; i++) {
    float uses = price[i] - FREE_USES;
    uses = uses < 0.f ? 0.f : uses > MOST_USES ? MOST_USES : uses;
    price[i] = PRICE_OF_USE * level->variance * uses;
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
