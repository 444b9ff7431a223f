#include "synthesis/structure/repeats.h"

#include <math.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/structure/moves.h"

/* A texture repeats if, moved along by so many px of the coarsest level, it changes by less than
 * this part of what it does moved half as far and, if that is seen, half as far again: bricks .43
 * to .70, tiles .53 to .66, roofs .82 and more, cracks and markings .73 to 1, boards .92 and more.
 * The same points are compared: of a road, those seen far along it are fewer and others. So it must
 * be also where no point counts more than most differ by: what stands out, as a dash on a road,
 * differs by more than all the rest together. And half as far it must change by this part of what
 * it does moved a little across, .57 and more, or there is nothing that could repeat: bands that
 * converge .01. */
#define MOST_REPEATED .72
#define LEAST_BETWEEN .1
#define LEAST_PERIOD_PX 6
#define MOST_PERIOD_PX 64
#define FARTHEST_PX (MOST_PERIOD_PX + MOST_PERIOD_PX / 2)
#define ACROSS_PX 2.f

/* What each point changes by moved so far, half of the least period or more; NAN: that is not
 * seen. */
typedef struct changes {
  int count; /* points, to both sides */
  float *of[FARTHEST_PX + 1];
} changes;

/* Of the points seen at all of three distances the mean change at each. False: too few are. */
static bool compare(const changes *c, int near, int px, int beyond, double mean[3]) {
  int seen = 0;
  mean[0] = mean[1] = mean[2] = 0;
  for (int i = 0; i < c->count; i++) {
    float at[3] = {c->of[near][i], c->of[px][i], c->of[beyond][i]};
    if (isnan(at[0] + at[1] + at[2])) continue;
    for (int k = 0; k < 3; k++) mean[k] += at[k];
    seen++;
  }
  for (int k = 0; k < 3; k++) mean[k] /= seen ? seen : 1;
  return seen >= RC_MOVES_LEAST_SEEN;
}

static bool comes_again_at(const changes *c, int px, double least) {
  for (int odd = 0; odd <= px % 2; odd++) {
    double mean[3];
    int near = px / 2 + odd, beyond = px + near;
    if (!compare(c, near, px, near, mean) || mean[0] < least || mean[1] >= MOST_REPEATED * mean[0])
      return false;
    if (compare(c, near, px, beyond, mean) && mean[1] >= MOST_REPEATED * mean[2]) return false;
  }
  return true;
}

static bool comes_again(const rc_moves *m, float a, float b, const changes *c) {
  double least = LEAST_BETWEEN * rc_moves_across(m, a, b, ACROSS_PX);
  for (int px = LEAST_PERIOD_PX; px <= MOST_PERIOD_PX; px++)
    if (comes_again_at(c, px, least)) return true;
  return false;
}

/* Moved along (a, b). */
typedef struct looking {
  const rc_moves *moves;
  float a, b;
  changes *c;
} looking;

static void look(void *user, int item, int thread) {
  const looking *l = user;
  int px = LEAST_PERIOD_PX / 2 + item, count = l->moves->count;
  float a = (float)px * l->a, b = (float)px * l->b, *of = l->c->of[px];
  (void)thread;
  for (int i = 0; i < count; i++) {
    of[i] = rc_moves_change_of(l->moves, i, a, b);
    of[count + i] = rc_moves_change_of(l->moves, i, -a, -b);
  }
}

/* No point counts more. */
static void limit(float most, changes *c) {
  for (int px = LEAST_PERIOD_PX / 2; px <= FARTHEST_PX; px++)
    for (int i = 0; i < c->count; i++)
      if (c->of[px][i] > most) c->of[px][i] = most;
}

static recede_status repeats(rc_context *context, rc_moves *m, float a, float b, bool *result) {
  changes c = {.count = 2 * m->count};
  looking l = {m, a, b, &c};
  for (int px = LEAST_PERIOD_PX / 2; px <= FARTHEST_PX; px++)
    RC_TRY(RC_NEW(context, c.count, &c.of[px]));
  RC_TRY(rc_parallel(context, FARTHEST_PX + 1 - LEAST_PERIOD_PX / 2, look, &l));
  *result = comes_again(m, a, b, &c);
  m->most_change = rc_moves_usual_change(m);
  if (*result) limit((float)m->most_change, &c);
  *result = *result && comes_again(m, a, b, &c);
  return rc_poll(context);
}

recede_status rc_repeats_near(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const rc_chart *chart, float a, float b, bool *result) {
  rc_moves *m;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &m));
  RC_TRY(rc_moves_set(context, image, flags, *chart, true, NULL, m));
  RC_TRY(repeats(context, m, a, b, result));
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_repeats_beside(rc_context *context, const rc_image *images, const rc_mask *masks,
                                int levels, const rc_chart *chart, const rc_crossing *line,
                                const rc_boundary *boundary, float x, float y, bool *result) {
  int coarsest = levels - 1;
  rc_boundary b = rc_boundary_coarser(*boundary, coarsest);
  rc_copy d = rc_crossing_direction(chart, line);
  rc_moves *m;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, 1, &m));
  if (boundary->nx * (x - chart->x0) + boundary->ny * (y - chart->y0) + boundary->at < 0)
    b = rc_other_side(b);
  RC_TRY(rc_moves_set(context, &images[coarsest], &masks[coarsest],
                      rc_chart_coarser(*chart, coarsest), false, &b, m));
  RC_TRY(repeats(context, m, d.a, d.b, result));
  rc_release(context, mark);
  return RECEDE_OK;
}
