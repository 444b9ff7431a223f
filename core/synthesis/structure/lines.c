#include "synthesis/structure/lines.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/real.h"
#include "synthesis/structure/alone.h"
#include "synthesis/structure/follow.h"

/* Profiles are averaged along a run outside the hole. */
#define RUN 16                 /* samples */
#define MOST_MISSING (RUN / 4) /* of them, where there is no source */
#define STEP_PX 2.f            /* between them */
#define DIRECTIONS 128
/* Lines are looked for at the finest level whose hole has at most so many border pixels. */
#define MOST_BORDER 800
/* Large stones have straight edges of 20 to 100, and one may by chance point at another: where
 * more than this part of the rest of the hole's border has a line as strong, one alone is none. A
 * stone .17; cracks and a row of tiles .02 to .08. */
#define MOST_AS_STRONG .12f
/* How alike both sides' profiles must be: their correlation, and one's amplitude over the other's,
 * for lines fade. */
#define LEAST_LIKENESS .85f
#define MOST_UNLIKE 4.f
#define STRAIGHT .9945f /* cosine of 6 degrees: both runs and what connects them */
#define SHORTEST_PX 12.f
/* Of a marking wider than half a profile both edges are kept. */
#define LEAST_RISE .8f
#define LEAST_INSIDE .7f /* of a line between its ends */
/* Ends are moved by up to so much to where the line is clearest. */
#define REFINED_STEP_PX .5f
#define REFINED_PLACES 17 /* 4 px to each side */
/* Of border pixels so near to each other the strongest is looked at. */
#define APART_PX 2

typedef struct profile {
  float mean[RC_PROFILE];
  float strength; /* signal to noise; 0: not enough known pixels */
  float clarity;  /* how much changes in its middle */
} profile;

typedef struct finder {
  rc_seen picture;
  float least_strength;
  const int32_t *border; /* pixels */
  int border_count;
  float (*direction)[2];
  profile *best; /* of each border pixel, its strongest direction */
  int *best_direction;
} finder;

/* Of the change from one sample to the next. */
static const float middle[RC_PROFILE] = {0, .2f, .6f, 1, 1, .6f, .2f};

/* The run that begins at (x, y) and leaves along outwards u, read across u. */
static profile measure(const finder *f, float x, float y, float ux, float uy, float outwards) {
  profile p = {.strength = 0};
  const rc_mask *flags = f->picture.flags;
  int missing[RC_PROFILE] = {0};
  float square[RC_PROFILE] = {0}, noise = 0, centre = 0, signal = 0;
  for (int k = 0; k < RUN; k++)
    for (int o = 0; o < RC_PROFILE; o++) {
      float along = outwards * (RC_PROFILE_FROM_PX + STEP_PX * (float)k);
      float across = (float)(o - RC_PROFILE_HALF);
      int px = rc_floor(x + ux * along - uy * across + .5f);
      int py = rc_floor(y + uy * along + ux * across + .5f);
      size_t at = (size_t)py * (size_t)flags->width + (size_t)px;
      if (!rc_inside(flags->width, flags->height, px, py) || !(flags->data[at] & RC_SOURCE)) {
        if (++missing[o] > MOST_MISSING) return p;
        continue;
      }
      float value = f->picture.value[at];
      p.mean[o] += value, square[o] += value * value;
    }
  for (int o = 0; o < RC_PROFILE; o++) {
    float count = (float)(RUN - missing[o]);
    p.mean[o] /= count;
    noise += square[o] / count - p.mean[o] * p.mean[o];
    centre += p.mean[o] / RC_PROFILE;
  }
  for (int o = 0; o < RC_PROFILE; o++) {
    p.mean[o] -= centre;
    float change = o ? p.mean[o] - p.mean[o - 1] : 0;
    signal += p.mean[o] * p.mean[o];
    p.clarity += middle[o] * change * change;
  }
  /* Neighbouring samples are alike: half of them count. */
  p.strength = signal / fmaxf(noise / (RUN / 2), 1e-6f);
  return p;
}

static void search_border(void *user, int item, int thread) {
  finder *f = user;
  float x = (float)(f->border[item] % f->picture.flags->width);
  float y = (float)(f->border[item] / f->picture.flags->width);
  (void)thread;
  f->best[item] = (profile){.strength = 0};
  for (int d = 0; d < DIRECTIONS; d++) {
    profile p = measure(f, x, y, f->direction[d][0], f->direction[d][1], 1);
    if (p.strength <= f->best[item].strength) continue;
    f->best[item] = p;
    f->best_direction[item] = d;
  }
}

static bool alike(const profile *a, const profile *b) {
  float aa = 0, bb = 0, ab = 0, most = MOST_UNLIKE * MOST_UNLIKE;
  for (int o = 0; o < RC_PROFILE; o++)
    aa += a->mean[o] * a->mean[o], bb += b->mean[o] * b->mean[o], ab += a->mean[o] * b->mean[o];
  return ab > LEAST_LIKENESS * sqrtf(aa * bb) && aa < most * bb && bb < most * aa;
}

/* Its correlation with a step. */
static float rise_of(const profile *p) {
  float dot = 0, square = 1e-12f;
  for (int o = 0; o < RC_PROFILE; o++) {
    dot += o < RC_PROFILE_HALF ? -p->mean[o] : o > RC_PROFILE_HALF ? p->mean[o] : 0;
    square += p->mean[o] * p->mean[o];
  }
  return dot / sqrtf(square * (RC_PROFILE - 1));
}

static bool crosses_the_hole(const rc_mask *flags, const rc_crossing *c) {
  int inside = 0, samples = 32;
  for (int i = 1; i < samples; i++) {
    float t = (float)i / (float)samples;
    int x = (int)floorf(c->ax + t * (c->bx - c->ax) + .5f);
    int y = (int)floorf(c->ay + t * (c->by - c->ay) + .5f);
    inside += (*rc_flag(flags, x, y) & RC_TARGET) != 0;
  }
  return (float)inside > LEAST_INSIDE * (float)samples;
}

/* Moves both ends across the line to where it is clearest on both sides. The direction changes with
 * that, so it is done twice. */
static void refine(const finder *f, rc_crossing *c) {
  profile a[REFINED_PLACES], b[REFINED_PLACES];
  for (int round = 0; round < 2; round++) {
    float dx = c->bx - c->ax, dy = c->by - c->ay, length = sqrtf(dx * dx + dy * dy), most = 0;
    float ux = dx / length, uy = dy / length;
    rc_crossing from = *c;
    c->strength = 0;
    for (int i = 0; i < REFINED_PLACES; i++) {
      float across = REFINED_STEP_PX * (float)(i - REFINED_PLACES / 2);
      a[i] = measure(f, from.ax - across * uy, from.ay + across * ux, ux, uy, -1);
      b[i] = measure(f, from.bx - across * uy, from.by + across * ux, ux, uy, 1);
    }
    for (int i = 0; i < REFINED_PLACES; i++)
      for (int k = 0; k < REFINED_PLACES; k++) {
        float strength = fminf(a[i].strength, b[k].strength);
        float clarity = fminf(a[i].clarity, b[k].clarity);
        if (strength < f->least_strength || clarity <= most || !alike(&a[i], &b[k])) continue;
        float p = REFINED_STEP_PX * (float)(i - REFINED_PLACES / 2);
        float q = REFINED_STEP_PX * (float)(k - REFINED_PLACES / 2);
        most = clarity;
        *c = (rc_crossing){.ax = from.ax - p * uy,
                           .ay = from.ay + p * ux,
                           .bx = from.bx - q * uy,
                           .by = from.by + q * ux,
                           .strength = strength,
                           .rise = rise_of(&a[i])};
      }
    if (c->strength == 0) return;
  }
}

static bool run_into_one_another(const rc_crossing *p, const rc_crossing *q) {
  return rc_crossing_distance(p, q->ax, q->ay) <= RC_PROFILE ||
         rc_crossing_distance(p, q->bx, q->by) <= RC_PROFILE;
}

/* Both are clear, and one rises where the other falls. */
static bool rise_against_each_other(const rc_crossing *p, const rc_crossing *q) {
  if (fminf(p->strength, q->strength) < RC_CLEAR_STRENGTH) return false;
  float along = (p->bx - p->ax) * (q->bx - q->ax) + (p->by - p->ay) * (q->by - q->ay);
  float rises = along > 0 ? -q->rise : q->rise;
  return fminf(p->rise, rises) > LEAST_RISE || fmaxf(p->rise, rises) < -LEAST_RISE;
}

/* Strongest first; of lines that run into one another the stronger stays. */
static void keep(rc_crossing lines[RC_MOST_LINES], int *count, rc_crossing c) {
  int at = 0;
  for (int i = 0; i < *count; i++) {
    rc_crossing *old = &lines[i];
    if (!run_into_one_another(old, &c) || rise_against_each_other(old, &c)) continue;
    if (old->strength >= c.strength) return;
    memmove(old, old + 1, (size_t)(*count - i - 1) * sizeof *old);
    (*count)--, i--;
  }
  while (at < *count && lines[at].strength >= c.strength) at++;
  if (at == RC_MOST_LINES) return;
  int moved = (*count < RC_MOST_LINES ? *count : RC_MOST_LINES - 1) - at;
  memmove(&lines[at + 1], &lines[at], (size_t)moved * sizeof c);
  lines[at] = c;
  if (*count < RC_MOST_LINES) (*count)++;
}

/* Whether a border pixel is the strongest around. */
static bool stands_out(const finder *f, int item) {
  int width = f->picture.flags->width, own = f->border[item];
  float strength = f->best[item].strength;
  if (strength < f->least_strength) return false;
  for (int i = 0; i < f->border_count; i++) {
    int dx = f->border[i] % width - own % width, dy = f->border[i] / width - own / width;
    if (dx * dx + dy * dy > APART_PX * APART_PX || i == item) continue;
    float other = f->best[i].strength;
    if (other > strength || (other == strength && i < item)) return false;
  }
  return true;
}

/* Of the border pixels away from a line the part that is as strong; of few pixels no small one. */
static float part_as_strong(const finder *f, const rc_crossing *c) {
  int width = f->picture.flags->width, away = 0, as_strong = 0;
  for (int i = 0; i < f->border_count; i++) {
    float x = (float)(f->border[i] % width), y = (float)(f->border[i] / width);
    if (rc_crossing_distance(c, x, y) <= RC_PROFILE) continue;
    away++, as_strong += f->best[i].strength >= c->strength;
  }
  if (!as_strong) return away ? fminf(.5f / (float)away, MOST_AS_STRONG) : MOST_AS_STRONG;
  return (float)as_strong / (float)away;
}

static void pair_up(const finder *f, rc_crossing lines[RC_MOST_LINES], int *count) {
  int width = f->picture.flags->width;
  for (int i = 0; i < f->border_count; i++) {
    if (!stands_out(f, i)) continue;
    for (int j = i + 1; j < f->border_count; j++) {
      if (f->best[j].strength < f->least_strength) continue;
      const float *u = f->direction[f->best_direction[i]], *v = f->direction[f->best_direction[j]];
      rc_crossing c = {.ax = (float)(f->border[i] % width),
                       .ay = (float)(f->border[i] / width),
                       .bx = (float)(f->border[j] % width),
                       .by = (float)(f->border[j] / width)};
      float dx = c.ax - c.bx, dy = c.ay - c.by, length = sqrtf(dx * dx + dy * dy);
      if (length < SHORTEST_PX || dx * u[0] + dy * u[1] < STRAIGHT * length ||
          dx * v[0] + dy * v[1] > -STRAIGHT * length || !crosses_the_hole(f->picture.flags, &c) ||
          !stands_out(f, j))
        continue;
      refine(f, &c);
      c.as_strong = part_as_strong(f, &c);
      if (c.strength >= f->least_strength) keep(lines, count, c);
    }
  }
}

/* Keeps what can be continued, in px of the finest level. One must go on by itself, and vouches for
 * those parallel to it. */
static void follow(const rc_seen *seen, const rc_chart *chart, int exponent,
                   rc_crossing lines[RC_MOST_LINES], int *count) {
  int kept = 0;
  bool alone = true;
  for (int i = 0; i < *count && alone; i++) {
    rc_crossing c = lines[i];
    alone = !rc_follow(seen, chart, rc_windows_of(&c, false), &c);
  }
  for (int i = 0; i < *count && !alone; i++) {
    rc_crossing c = lines[i];
    if (!rc_follow(seen, chart, 0, &c)) continue;
    rc_crossing_tell_band(&c, false);
    rc_crossing_forget_chance(&c);
    lines[kept++] = rc_crossing_coarser(c, -exponent);
  }
  *count = kept;
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

bool rc_seen_source(const void *user, int x, int y, float *value) {
  const rc_seen *picture = user;
  if (!rc_inside(picture->flags->width, picture->flags->height, x, y)) return false;
  size_t at = (size_t)y * (size_t)picture->flags->width + (size_t)x;
  *value = picture->value[at];
  return (picture->flags->data[at] & RC_SOURCE) != 0;
}

recede_status rc_see(rc_context *context, const rc_image *image, const rc_mask *flags,
                     const float axis[3], rc_seen *seen) {
  size_t pixels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
  float *value;
  RC_TRY(RC_NEW_ZERO(context, pixels, &value));
  for (size_t i = 0; i < pixels; i++)
    for (size_t k = 0; k < channels; k++) value[i] += axis[k] * image->data[i * channels + k];
  *seen = (rc_seen){flags, value};
  return RECEDE_OK;
}

recede_status rc_see_contrast(rc_context *context, rc_seen *seen) {
  int width = seen->flags->width, height = seen->flags->height;
  float *contrast;
  RC_TRY(RC_NEW_ZERO(context, (size_t)width * (size_t)height, &contrast));
  for (int y = 1; y + 1 < height; y++)
    for (int x = 1; x + 1 < width; x++) {
      float sum = 0, square = 0, count = 0, value;
      for (int k = 0; k < 9; k++) {
        if (!rc_seen_source(seen, x - 1 + k % 3, y - 1 + k / 3, &value)) continue;
        sum += value, square += value * value, count++;
      }
      if (count > 0)
        contrast[(size_t)y * (size_t)width + (size_t)x] =
            sqrtf(fmaxf(square / count - sum / count * (sum / count), 0.f));
    }
  seen->value = contrast;
  return rc_poll(context);
}

static void set_directions(float (*direction)[2]) {
  const double c = .9987954562051724, s = .049067674327418015; /* of 360 / DIRECTIONS degrees */
  double x = 1, y = 0;
  for (int d = 0; d < DIRECTIONS; d++) {
    direction[d][0] = (float)x, direction[d][1] = (float)y;
    double next = x * c - y * s;
    y = x * s + y * c, x = next;
  }
}

int rc_border_length(const rc_mask *flags) { return collect_border(flags, NULL); }

int rc_lines_level(const rc_mask *masks, int levels) {
  for (int exponent = 0; exponent < levels; exponent++) {
    int border_count = collect_border(&masks[exponent], NULL);
    if (border_count <= MOST_BORDER) return border_count ? exponent : -1;
  }
  return -1;
}

recede_status rc_lines_at(rc_context *context, const rc_seen *seen, bool faint,
                          rc_crossing lines[RC_MOST_LINES], int *count) {
  float direction[DIRECTIONS][2];
  int32_t *border;
  finder f = {.picture = *seen, .least_strength = RC_LEAST_STRENGTH, .direction = direction};
  rc_block *mark = rc_mark(context);
  *count = 0;
  f.border_count = collect_border(seen->flags, NULL);
  RC_TRY(RC_NEW(context, f.border_count, &border));
  RC_TRY(RC_NEW(context, f.border_count, &f.best));
  RC_TRY(RC_NEW_ZERO(context, f.border_count, &f.best_direction));
  collect_border(seen->flags, border);
  set_directions(direction);
  f.border = border;
  RC_TRY(rc_parallel(context, f.border_count, search_border, &f));
  pair_up(&f, lines, count);
  f.least_strength = RC_LEAST_FAINT_STRENGTH;
  if (faint && !*count) pair_up(&f, lines, count);
  rc_release(context, mark);
  return RECEDE_OK;
}

recede_status rc_lines_find(rc_context *context, const rc_image *image, const rc_mask *mask,
                            int exponent, bool corners, const rc_chart *chart,
                            const rc_copy periods[2], rc_crossing lines[RC_MOST_LINES],
                            int *count) {
  static const float grey[3] = {1, 0, 0}, colours[3] = {.3f, .59f, .11f};
  const float *axis = image->channels == 1 ? grey : colours;
  rc_seen seen;
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_see(context, image, mask, axis, &seen));
  RC_TRY(rc_lines_at(context, &seen, false, lines, count));
  if (corners) rc_crossings_keep_corners(mask, lines, count);
  rc_chart here = rc_chart_coarser(*chart, exponent);
  int reach_px = rc_longer_side(rc_box_of(mask, RC_TARGET));
  rc_copy here_by[2];
  for (int k = 0; periods && k < 2; k++)
    here_by[k] =
        (rc_copy){periods[k].a / (float)(1 << exponent), periods[k].b / (float)(1 << exponent), 0};
  for (int i = 0; i < *count; i++)
    lines[i].alone = rc_stands_alone(&seen, &here, &lines[i], reach_px, periods ? here_by : NULL);
  rc_crossings_keep_parallel(&here, lines, count);
  follow(&seen, &here, exponent, lines, count);
  if (*count == 1 && lines->as_strong > MOST_AS_STRONG) *count = 0;
  for (int i = 0; i < *count; i++) memcpy(lines[i].axis, axis, sizeof lines[i].axis);
  rc_release(context, mark);
  return rc_poll(context);
}
