#include "synthesis/paper/matches.h"

#include "base/memory.h"

static rc_grid grid_of(int picture_width, int picture_height, int width) {
  rc_grid grid = {.width = width, .step = width >= 4 ? width / 4 : 1};
  grid.last_x = picture_width - width;
  grid.last_y = picture_height - width;
  grid.columns = (grid.last_x + grid.step - 1) / grid.step + 1;
  grid.rows = (grid.last_y + grid.step - 1) / grid.step + 1;
  return grid;
}

static void look_at(const rc_mask *flags, int x0, int y0, int width, uint8_t *active,
                    float *known) {
  int targets = 0, knowns = 0;
  for (int y = y0; y < y0 + width; y++)
    for (int x = x0; x < x0 + width; x++) {
      targets += *rc_flag(flags, x, y) & RC_TARGET ? 1 : 0;
      knowns += *rc_flag(flags, x, y) & RC_KNOWN ? 1 : 0;
    }
  *active = targets > 0;
  *known = (float)knowns / (float)(width * width);
}

recede_status rc_matches_new(rc_context *context, const rc_mask *flags, int width,
                             rc_matches *matches) {
  rc_grid grid = grid_of(flags->width, flags->height, width);
  size_t count = (size_t)grid.columns * (size_t)grid.rows;
  *matches = (rc_matches){.grid = grid};
  RC_TRY(RC_NEW_ZERO(context, count, &matches->active));
  RC_TRY(RC_NEW(context, count, &matches->corner));
  RC_TRY(RC_NEW_ZERO(context, count, &matches->distance));
  RC_TRY(RC_NEW_ZERO(context, count, &matches->weight));
  RC_TRY(RC_NEW(context, count, &matches->known));
  for (int row = 0; row < grid.rows; row++) {
    for (int column = 0; column < grid.columns; column++) {
      size_t i = (size_t)row * (size_t)grid.columns + (size_t)column;
      look_at(flags, rc_grid_x(&grid, column), rc_grid_y(&grid, row), width, &matches->active[i],
              &matches->known[i]);
      matches->corner[i] = (rc_corner){-1, -1};
      matches->count += matches->active[i];
    }
    RC_TRY(rc_poll(context));
  }
  return RECEDE_OK;
}

static int clamp(int v, int count) { return v < 0 ? 0 : v >= count ? count - 1 : v; }

/* The old grid's line whose window's centre is nearest to that of the window at position. */
static int nearest_line(int position, int width, const rc_grid *old, int factor, int lines) {
  double centre = (position + .5 * width) / factor - .5 * old->width;
  return clamp((int)(centre / old->step + .5), lines);
}

static rc_corner moved(const rc_matches *old, int column, int row, int factor, int x, int y) {
  column = clamp(column, old->grid.columns);
  row = clamp(row, old->grid.rows);
  rc_corner z = old->corner[(size_t)row * (size_t)old->grid.columns + (size_t)column];
  if (z.x < 0) return z;
  return (rc_corner){x + factor * (z.x - rc_grid_x(&old->grid, column)),
                     y + factor * (z.y - rc_grid_y(&old->grid, row))};
}

/* The nearest old window first, then those around it. */
static rc_corner taken(const rc_matches *old, int factor, const rc_windows *windows, int x, int y) {
  static const int8_t around[9][2] = {{0, 0},   {-1, 0}, {1, 0},  {0, -1}, {0, 1},
                                      {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  int column = nearest_line(x, windows->width, &old->grid, factor, old->grid.columns);
  int row = nearest_line(y, windows->width, &old->grid, factor, old->grid.rows);
  for (int i = 0; i < 9; i++) {
    rc_corner z = moved(old, column + around[i][0], row + around[i][1], factor, x, y);
    if (rc_window_valid(windows, z.x, z.y)) return z;
  }
  return (rc_corner){-1, -1};
}

void rc_matches_take(const rc_matches *old, int factor, const rc_windows *windows,
                     rc_matches *matches) {
  const rc_grid *grid = &matches->grid;
  for (int row = 0; row < grid->rows; row++)
    for (int column = 0; column < grid->columns; column++) {
      size_t i = (size_t)row * (size_t)grid->columns + (size_t)column;
      if (matches->active[i])
        matches->corner[i] =
            taken(old, factor, windows, rc_grid_x(grid, column), rc_grid_y(grid, row));
    }
}
