#include "synthesis/structure/ends.h"

#include <math.h>

#include "base/four.h"
#include "base/memory.h"
#include "base/parallel.h"

/* Profiles are averaged along a run outside the hole. */
#define RUN 16                 /* samples */
#define MOST_MISSING (RUN / 4) /* of them, where there is no source */
#define STEP_PX 2.f            /* between them */
/* Of border pixels so near to each other the strongest is looked at. */
#define APART_PX 2

/* Where lines get narrower samples across are no nearer to each other, where wider no farther. */
#define LEAST_APART_PX .5f
#define MOST_APART_PX 3.f

/* Of the change from one sample to the next. */
static const float middle[RC_PROFILE] = {0, .2f, .6f, 1, 1, .6f, .2f};

/* A row that is so many times as far from the mean, squared, as half of all is what crosses the
 * line, and tells nothing of it; then its edges are those that are half as far. So many of a run
 * may. Less than 2 of 255 in each sample is nothing. */
#define CROSSED 12.f
#define EDGE_OF_CROSSED 6.f
#define MOST_CROSSED 4
#define LEAST_UNLIKE 4e-4f

/* A row of samples across, and one more: two vectors. */
#define LANES (RC_PROFILE + 1)
_Static_assert(LANES == 8, "two vectors");
typedef union row {
  float at[LANES];
  rc_four half[2];
} row;

/* Of the rows of a run, each sample's. */
typedef struct run_sums {
  row value, square;
  union {
    int32_t at[LANES];
    rc_four_ints half[2];
  } missing;
} run_sums;

static float median_of(const float values[RUN]) {
  float sorted[RUN] = {values[0]};
  for (int i = 1; i < RUN; i++) {
    int at = i;
    for (; at > 0 && sorted[at - 1] > values[i]; at--) sorted[at] = sorted[at - 1];
    sorted[at] = values[i];
  }
  return sorted[RUN / 2];
}

/* Takes them from the sums. */
static void leave_out_crossed(const row rows[RUN], run_sums *sums) {
  float unlike[RUN], farthest = 0;
  int crossed = 0;
  for (int k = 0; k < RUN; k++) {
    unlike[k] = 0;
    for (int o = 0; o < RC_PROFILE; o++) {
      float off = rows[k].at[o] - sums->value.at[o] / (float)(RUN - sums->missing.at[o]);
      if (!isnan(off)) unlike[k] += off * off;
    }
    farthest = fmaxf(farthest, unlike[k]);
  }
  if (farthest <= CROSSED * LEAST_UNLIKE) return;
  float usual = fmaxf(median_of(unlike), LEAST_UNLIKE), most = EDGE_OF_CROSSED * usual;
  if (farthest <= CROSSED * usual) return;
  for (int k = 0; k < RUN; k++) crossed += unlike[k] > most;
  if (crossed > MOST_CROSSED) return;
  for (int k = 0; k < RUN; k++)
    for (int o = 0; o < RC_PROFILE && unlike[k] > most; o++) {
      float value = rows[k].at[o];
      if (isnan(value)) continue;
      sums->missing.at[o]++, sums->value.at[o] -= value, sums->square.at[o] -= value * value;
    }
}

/* How far from each other samples across lie, so far along the run: it gets wider and narrower as
 * the ground does. */
static float apart_px(const rc_seen *seen, float x, float y, float along_x, float along_y) {
  if (!seen->narrows) return 1.f;
  float px = rc_chart_w(seen->narrows, x + along_x, y + along_y) / rc_chart_w(seen->narrows, x, y);
  return !(px >= LEAST_APART_PX) ? LEAST_APART_PX : px > MOST_APART_PX ? MOST_APART_PX : px;
}

static bool is_inside(const rc_mask *flags, float x, float y) {
  return x >= 0 && y >= 0 && x < (float)flags->width && y < (float)flags->height;
}

/* Unsigned, for outside it may be anything. */
static uint32_t pixel_at(const rc_mask *flags, float x, float y) {
  return (uint32_t)(int)y * (uint32_t)flags->width + (uint32_t)(int)x;
}

/* The values of the sources nearest to a row of samples across u through (x, y), NAN where there
 * are none. Most of what looking for ends takes is spent here. */
static void sample_row(const rc_seen *seen, float x, float y, float ux, float uy, float apart,
                       row *to) {
  const rc_mask *flags = seen->flags;
  float at_x[LANES], at_y[LANES];
  uint32_t at[LANES];
  for (int o = 0; o < LANES; o++) {
    float across = (float)(o - RC_PROFILE_HALF) * apart;
    at_x[o] = x - uy * across + .5f, at_y[o] = y + ux * across + .5f;
    at[o] = pixel_at(flags, at_x[o], at_y[o]);
  }
  /* Along the row they only grow, or only fall. */
  bool inside = is_inside(flags, at_x[0], at_y[0]) &&
                is_inside(flags, at_x[RC_PROFILE - 1], at_y[RC_PROFILE - 1]);
  for (int o = 0; o < RC_PROFILE; o++)
    to->at[o] = inside || is_inside(flags, at_x[o], at_y[o]) ? seen->value[at[o]] : NAN;
  to->at[LANES - 1] = 0;
}

static float along_run(int k, float outwards) {
  return outwards * (RC_PROFILE_FROM_PX + STEP_PX * (float)k);
}

/* Whether too much of the run's own line is missing: most directions lead into the hole. */
static bool leads_nowhere(const rc_seen *seen, float x, float y, float ux, float uy,
                          float outwards) {
  int missing = 0;
  for (int k = 0; k < RUN && missing <= MOST_MISSING; k++) {
    float along = along_run(k, outwards);
    float at_x = x + ux * along + .5f, at_y = y + uy * along + .5f;
    missing += !is_inside(seen->flags, at_x, at_y) ||
               isnan(seen->value[pixel_at(seen->flags, at_x, at_y)]);
  }
  return missing > MOST_MISSING;
}

/* Where all four pixels around a sample are sources it is taken between them. */
static void look_between(const rc_seen *seen, float x, float y, float ux, float uy, float apart,
                         row *to) {
  const rc_ruler ruler = {seen, ux, uy, NULL};
  for (int o = 0; o < RC_PROFILE; o++) {
    float across = (float)(o - RC_PROFILE_HALF) * apart;
    if (!isnan(to->at[o])) rc_ruler_sample(&ruler, x - uy * across, y + ux * across, &to->at[o]);
  }
}

/* False: too many are missing. */
static bool add_row(const row *samples, run_sums *sums) {
  rc_four_ints too_many = {0};
  for (int h = 0; h < 2; h++) {
    rc_four value = samples->half[h];
    rc_four_ints known = value == value; /* -1, or 0 */
    value = rc_select(known, value, (rc_four){0});
    sums->value.half[h] += value, sums->square.half[h] += value * value;
    sums->missing.half[h] += 1 + known;
    too_many |= sums->missing.half[h] > MOST_MISSING;
  }
  return !(too_many[0] | too_many[1] | too_many[2] | too_many[3]);
}

static rc_run measure(const rc_seen *seen, float x, float y, float ux, float uy, float outwards,
                      bool between) {
  rc_run p = {.strength = 0};
  run_sums sums = {.missing = {{0}}};
  row rows[RUN];
  float noise = 0, signal = 0, *mean = p.profile.mean;
  if (leads_nowhere(seen, x, y, ux, uy, outwards)) return p;
  for (int k = 0; k < RUN; k++) {
    float along = along_run(k, outwards);
    float apart = apart_px(seen, x, y, ux * along, uy * along);
    float at_x = x + ux * along, at_y = y + uy * along;
    sample_row(seen, at_x, at_y, ux, uy, apart, &rows[k]);
    if (between) look_between(seen, at_x, at_y, ux, uy, apart, &rows[k]);
    if (!add_row(&rows[k], &sums)) return p;
  }
  if (seen->without_crossings) leave_out_crossed(rows, &sums);
  for (int o = 0; o < RC_PROFILE; o++) {
    float count = (float)(RUN - sums.missing.at[o]);
    mean[o] = sums.value.at[o] / count;
    noise += sums.square.at[o] / count - mean[o] * mean[o];
    p.profile.tone += mean[o] / RC_PROFILE;
  }
  for (int o = 0; o < RC_PROFILE; o++) {
    mean[o] -= p.profile.tone;
    float change = o ? mean[o] - mean[o - 1] : 0;
    signal += mean[o] * mean[o];
    p.clarity += middle[o] * change * change;
  }
  /* Neighbouring samples are alike: half of them count. */
  p.strength = signal / fmaxf(noise / (RUN / 2), 1e-6f);
  return p;
}

rc_run rc_run_measure(const rc_seen *seen, float x, float y, float ux, float uy, float outwards) {
  return measure(seen, x, y, ux, uy, outwards, false);
}

float rc_run_fine_strength(const rc_seen *seen, float x, float y, float ux, float uy,
                           float outwards) {
  return measure(seen, x, y, ux, uy, outwards, true).strength;
}

static void search_border(void *user, int item, int thread) {
  rc_ends *ends = user;
  float x = (float)(ends->border[item] % ends->picture.flags->width);
  float y = (float)(ends->border[item] / ends->picture.flags->width);
  (void)thread;
  ends->best[item] = (rc_run){.strength = 0};
  for (int d = 0; d < RC_END_DIRECTIONS; d++) {
    rc_run p =
        rc_run_measure(&ends->picture, x, y, ends->direction[d][0], ends->direction[d][1], 1);
    if (p.strength <= ends->best[item].strength) continue;
    ends->best[item] = p;
    ends->best_direction[item] = d;
  }
}

bool rc_end_stands_out(const rc_ends *ends, int item, float least_strength) {
  int width = ends->picture.flags->width, own = ends->border[item];
  float strength = ends->best[item].strength;
  if (strength < least_strength) return false;
  for (int i = 0; i < ends->border_count; i++) {
    int dx = ends->border[i] % width - own % width, dy = ends->border[i] / width - own / width;
    if (dx * dx + dy * dy > APART_PX * APART_PX || i == item) continue;
    float other = ends->best[i].strength;
    if (other > strength || (other == strength && i < item)) return false;
  }
  return true;
}

float rc_ends_as_strong(const rc_ends *ends, const rc_crossing *c) {
  int width = ends->picture.flags->width, away = 0, as_strong = 0;
  for (int i = 0; i < ends->border_count; i++) {
    float x = (float)(ends->border[i] % width), y = (float)(ends->border[i] / width);
    if (rc_crossing_distance(c, x, y) <= RC_PROFILE) continue;
    away++, as_strong += ends->best[i].strength >= c->strength;
  }
  if (!as_strong) return away ? fminf(.5f / (float)away, RC_MOST_AS_STRONG) : RC_MOST_AS_STRONG;
  return (float)as_strong / (float)away;
}

/* Target pixels that touch known ones; border may be NULL. */
static int collect_border(const rc_mask *flags, int32_t *border) {
  rc_box box = rc_box_of(flags, RC_TARGET);
  int count = 0;
  for (int y = box.y0 > 1 ? box.y0 : 1; y < box.y1 && y + 1 < flags->height; y++)
    for (int x = box.x0 > 1 ? box.x0 : 1; x < box.x1 && x + 1 < flags->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET)) continue;
      int beside = *rc_flag(flags, x - 1, y) | *rc_flag(flags, x + 1, y) |
                   *rc_flag(flags, x, y - 1) | *rc_flag(flags, x, y + 1);
      if (!(beside & RC_KNOWN)) continue;
      if (border) border[count] = y * flags->width + x;
      count++;
    }
  return count;
}

static void set_directions(float (*direction)[2]) {
  const double c = .9987954562051724,
               s = .049067674327418015; /* of 360 / RC_END_DIRECTIONS degrees */
  double x = 1, y = 0;
  for (int d = 0; d < RC_END_DIRECTIONS; d++) {
    direction[d][0] = (float)x, direction[d][1] = (float)y;
    double next = x * c - y * s;
    y = x * s + y * c, x = next;
  }
}

int rc_border_length(const rc_mask *flags) { return collect_border(flags, NULL); }

recede_status rc_ends_find(rc_context *context, const rc_seen *seen, rc_ends *ends) {
  int32_t *border;
  *ends = (rc_ends){.picture = *seen, .border_count = collect_border(seen->flags, NULL)};
  RC_TRY(RC_NEW(context, ends->border_count, &border));
  RC_TRY(RC_NEW(context, ends->border_count, &ends->best));
  RC_TRY(RC_NEW_ZERO(context, ends->border_count, &ends->best_direction));
  collect_border(seen->flags, border);
  set_directions(ends->direction);
  ends->border = border;
  return rc_parallel(context, ends->border_count, search_border, ends);
}
