#include "synthesis/sources/layers.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"

/* Colours are compared by cells of this part of the hole's longer side, up to so many apart, around
 * the hole up to that side from it. A cell counts if half of it is seen. */
#define CELL_OF_HOLE 6
#define MOST_APART 3
#define LEAST_SEEN .5f
/* Less than 4 of 255 is nothing. */
#define LEAST_SQUARE 3e-4
/* Layers begin where colours change so many times faster upwards than sideways, as squares, and are
 * sure where they do so many. */
#define LEAST_FASTER 1.5f
#define SURELY_FASTER 4.f
#define PRICE_OF_LAYERS 6.f

/* Mean colours; seen: the part of the cell. */
typedef struct cell {
  float sum[3], seen;
} cell;

typedef struct cells {
  cell *cells;
  int columns, rows, channels;
} cells;

static void add(const rc_image *image, const rc_tone *tone, int exponent, int x, int y, cell *to) {
  int half = 1 << exponent >> 1;
  double light[3];
  rc_tone_at(tone, (x << exponent) + half, (y << exponent) + half, light);
  for (int k = 0; k < image->channels; k++)
    to->sum[k] += rc_pixel(image, x, y)[k] + (float)light[k];
  to->seen++;
}

static recede_status gather(rc_context *context, const rc_image *image, const rc_mask *flags,
                            int exponent, const rc_tone *tone, rc_box around, int side,
                            cells *all) {
  all->columns = (around.x1 - around.x0) / side, all->rows = (around.y1 - around.y0) / side;
  all->channels = image->channels;
  RC_TRY(RC_NEW_ZERO(context, (size_t)all->columns * (size_t)all->rows + 1, &all->cells));
  for (int y = 0; y < all->rows * side; y++) {
    for (int x = 0; x < all->columns * side; x++)
      if (*rc_flag(flags, around.x0 + x, around.y0 + y) & (RC_SOURCE | RC_ALLOWED))
        add(image, tone, exponent, around.x0 + x, around.y0 + y,
            &all->cells[y / side * all->columns + x / side]);
    RC_TRY(rc_poll(context));
  }
  for (int i = 0; i < all->columns * all->rows; i++) {
    cell *c = &all->cells[i];
    for (int k = 0; k < 3; k++) c->sum[k] /= fmaxf(c->seen, 1);
    c->seen /= (float)(side * side);
  }
  return RECEDE_OK;
}

/* The mean square that cells differ by which are so far from each other. */
static double differ(const cells *all, int right, int down) {
  double square = 0, pairs = 0;
  for (int row = 0; row + down < all->rows; row++)
    for (int column = 0; column + right < all->columns; column++) {
      const cell *a = &all->cells[row * all->columns + column];
      const cell *b = a + down * all->columns + right;
      if (a->seen < LEAST_SEEN || b->seen < LEAST_SEEN) continue;
      for (int k = 0; k < all->channels; k++)
        square += (double)((a->sum[k] - b->sum[k]) * (a->sum[k] - b->sum[k]));
      pairs++;
    }
  return pairs > 0 ? square / pairs : 0;
}

recede_status rc_layers_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                             int exponent, const rc_tone *tone, float *price) {
  rc_box hole = rc_box_of(flags, RC_TARGET), all = {0, 0, flags->width, flags->height};
  int longer = rc_longer_side(hole), side = longer / CELL_OF_HOLE;
  double upwards = 0, sideways = LEAST_SQUARE * MOST_APART;
  rc_block *mark = rc_mark(context);
  cells c;
  hole = (rc_box){hole.x0 - longer, hole.y0 - longer, hole.x1 + longer, hole.y1 + longer};
  RC_TRY(gather(context, image, flags, exponent, tone, rc_box_common(hole, all),
                side > 1 ? side : 1, &c));
  for (int apart = 1; apart <= MOST_APART; apart++)
    upwards += differ(&c, 0, apart), sideways += differ(&c, apart, 0);
  float faster = rc_log2((float)(upwards / sideways) / LEAST_FASTER) /
                 rc_log2(SURELY_FASTER / LEAST_FASTER);
  *price = PRICE_OF_LAYERS * fminf(fmaxf(faster, 0.f), 1.f);
  rc_release(context, mark);
  return RECEDE_OK;
}
