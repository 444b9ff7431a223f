#include "synthesis/search/boards.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"

typedef struct marking {
  rc_level *level;
  rc_rails rails;
} marking;

static void mark_row(void *user, int y, int thread) {
  const marking *m = user;
  const rc_level *level = m->level;
  const rc_rails *r = &m->rails;
  (void)thread;
  for (int x = 0; x < level->width; x++) {
    float px = rc_level_x(level, x), py = rc_level_y(level, y), w = rc_level_w(level, px, py);
    float row = ((py * r->a - px * r->b) / w - r->joint) / r->gauge;
    bool told = w > 0.f && fabsf(row) < 1e6f;
    level->board[(size_t)y * (size_t)level->width + (size_t)x] =
        told ? (uint8_t)((unsigned)(int)floorf(row) & 255u) : 0;
  }
}

recede_status rc_boards_mark(rc_context *context, const rc_rails *rails, int exponent,
                             rc_level *level) {
  marking m = {level, rc_rails_coarser(*rails, exponent)};
  if (!rails->rows) return RECEDE_OK;
  RC_TRY(RC_NEW(context, (size_t)level->width * (size_t)level->height, &level->board));
  return rc_parallel(context, level->height, mark_row, &m);
}
