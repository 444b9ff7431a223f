#include "synthesis/sources/layers.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"

/* Colours are compared by cells of this part of the hole's longer side, up to so many apart, around
 * the hole up to that side from it. Of large cells only every n-th pixel is looked at. A cell
 * counts if half of it is seen, and cells so far apart if there are some pairs of them both ways.
 */
#define CELL_OF_HOLE 6
#define MOST_APART 3
#define LOOKED_AT 16 /* each way */
#define LEAST_SEEN .5f
#define LEAST_PAIRS 4
/* Less than 2.5 of 255 is nothing. */
#define LEAST_SQUARE 1e-4
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
  int step = side > LOOKED_AT ? side / LOOKED_AT : 1, looked_at = (side + step - 1) / step;
  for (int row = 0; row < all->rows; row++) {
    for (int column = 0; column < all->columns; column++) {
      cell *c = &all->cells[row * all->columns + column];
      for (int k = 0; k < looked_at * looked_at; k++) {
        int x = around.x0 + column * side + k % looked_at * step;
        int y = around.y0 + row * side + k / looked_at * step;
        if (*rc_flag(flags, x, y) & (RC_SOURCE | RC_ALLOWED)) add(image, tone, exponent, x, y, c);
      }
      for (int k = 0; k < 3; k++) c->sum[k] /= fmaxf(c->seen, 1);
      c->seen /= (float)(looked_at * looked_at);
    }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

/* The mean square that cells so far from each other differ by. False: there are hardly any. */
static bool differ(const cells *all, int right, int down, double *by) {
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
  *by = square / fmax(pairs, 1) / all->channels;
  return pairs >= LEAST_PAIRS;
}

recede_status rc_layers_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                             int exponent, const rc_tone *tone, float *price) {
  rc_box hole = rc_box_of(flags, RC_TARGET), all = {0, 0, flags->width, flags->height};
  int longer = rc_longer_side(hole), side = longer / CELL_OF_HOLE;
  double upwards = 0, sideways = 0, up, across;
  rc_block *mark = rc_mark(context);
  cells c;
  hole = (rc_box){hole.x0 - longer, hole.y0 - longer, hole.x1 + longer, hole.y1 + longer};
  RC_TRY(gather(context, image, flags, exponent, tone, rc_box_common(hole, all),
                side > 1 ? side : 1, &c));
  for (int apart = 1; apart <= MOST_APART; apart++)
    if (differ(&c, 0, apart, &up) && differ(&c, apart, 0, &across))
      upwards += up, sideways += across + LEAST_SQUARE;
  rc_release(context, mark);
  *price = 0;
  if (!(upwards > (double)LEAST_FASTER * sideways)) return RECEDE_OK;
  float faster =
      rc_log2((float)(upwards / sideways) / LEAST_FASTER) / rc_log2(SURELY_FASTER / LEAST_FASTER);
  *price = PRICE_OF_LAYERS * fminf(faster, 1.f);
  return RECEDE_OK;
}
