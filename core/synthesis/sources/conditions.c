#include "synthesis/sources/conditions.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/sources/focus.h"
#include "synthesis/sources/places.h"

/* A copy may be more or less blurred than what it continues by so many octaves; more costs this per
 * square. */
#define MOST_BLUR_OFF .3f
#define PRICE_OF_BLUR 3.f
/* And relit by so many deviations of the texture; but where the light drifts so fast that few
 * places are left, by so many more and by any number costs the same. */
#define MOST_RELIT 1.f
#define MOST_PRICED .7f
#define PRICE_OF_LIGHT .3f
/* And be no kin of what lies beside the hole there, at this price. With 1 a floor still got a piece
 * of a carved stone that stands near it. */
#define PRICE_OF_NO_KIN 3.f

/* Cells are pixels of the coarsest level, but not finer than this. */
#define LEAST_EXPONENT 3

typedef struct table {
  rc_mask cells; /* what any of a cell's pixels is */
  const rc_mask *finest;
  int exponent;
  const rc_tone *tone;
  double unit;  /* of light */
  int coarsest; /* level */
  rc_kin kin;
  rc_condition *conditions;
} table;

static void mark_row(void *user, int row, int thread) {
  const table *t = user;
  int end = (row + 1) << t->exponent;
  (void)thread;
  for (int y = row << t->exponent; y < end && y < t->finest->height; y++)
    for (int x = 0; x < t->finest->width; x++)
      *rc_flag(&t->cells, x >> t->exponent, row) |=
          *rc_flag(t->finest, x, y) & (RC_SOURCE | RC_TARGET);
}

static void light_row(void *user, int row, int thread) {
  const table *t = user;
  int half = 1 << t->exponent >> 1;
  (void)thread;
  for (int x = 0; x < t->cells.width; x++) {
    double values[3] = {0, 0, 0};
    rc_tone_at(t->tone, (x << t->exponent) + half, (row << t->exponent) + half, values);
    for (int k = 0; k < 3; k++)
      t->conditions[row * t->cells.width + x].light[k] = (float)(t->unit * values[k]);
  }
}

/* Whether it differs by so much that a copy might cost something; in doubt it does. */
static bool light_differs(const table *t) {
  float square = 0;
  for (int k = 0; k < 3; k++) {
    float least = INFINITY, most = -INFINITY;
    for (int i = 0; i < t->cells.width * t->cells.height; i++) {
      if (!t->cells.data[i]) continue;
      least = fminf(least, t->conditions[i].light[k]);
      most = fmaxf(most, t->conditions[i].light[k]);
    }
    if (most > least) square += (most - least) * (most - least);
  }
  return square > MOST_RELIT * MOST_RELIT;
}

static recede_status set_light(rc_context *context, table *t, bool *differs) {
  *differs = false;
  if (!rc_tone_drifts(t->tone)) return RECEDE_OK;
  RC_TRY(rc_parallel(context, t->cells.height, light_row, t));
  *differs = light_differs(t);
  for (int i = 0; !*differs && i < t->cells.width * t->cells.height; i++)
    for (int k = 0; k < 3; k++) t->conditions[i].light[k] = 0;
  return RECEDE_OK;
}

/* Of all that a cell's pixels have it gets the most; finer ones beside the hole, where none of
 * these is a source, are what they are made of themselves. */
static void add_likeness(rc_likeness *to, rc_likeness one) {
  for (int k = 0; k < RC_KIN_PARTS; k++)
    if (one.part[k] > to->part[k]) to->part[k] = one.part[k];
}

static void add_nearness(rc_nearness *to, rc_nearness one) {
  if (to->unit == 0) memcpy(to->across, one.across, sizeof to->across);
  for (int k = 0; k < RC_KIN_PARTS; k++)
    if (one.part[k] > to->part[k]) to->part[k] = one.part[k];
  to->unit = fmaxf(to->unit, one.unit);
}

static void kin_of_cell(const table *t, int column, int row) {
  int side = 1 << (t->exponent - t->coarsest);
  const rc_mask *flags = t->kin.flags;
  rc_condition *to = &t->conditions[row * t->cells.width + column];
  rc_likeness of_others = {{0}};
  bool told = false;
  for (int y = row * side; y < (row + 1) * side && y < flags->height; y++)
    for (int x = column * side; x < (column + 1) * side && x < flags->width; x++) {
      bool is_source = *rc_flag(flags, x, y) & RC_SOURCE;
      add_likeness(is_source ? &to->likeness : &of_others, rc_likeness_at(&t->kin, x, y));
      told = told || is_source;
      if (*rc_flag(flags, x, y) & RC_TARGET)
        add_nearness(&to->nearness, rc_nearness_at(&t->kin, x, y));
    }
  if (!told) to->likeness = of_others;
}

static void kin_row(void *user, int row, int thread) {
  const table *t = user;
  (void)thread;
  for (int column = 0; column < t->cells.width; column++) kin_of_cell(t, column, row);
}

static recede_status set_kin(rc_context *context, table *t, const rc_image *images,
                             const rc_mask *flags, int levels, bool *told) {
  *told = false;
  if (!rc_is_looked_at(&flags[levels - 1])) return RECEDE_OK;
  RC_TRY(rc_kin_find(context, images, flags, levels, &t->kin, told));
  return *told ? rc_parallel(context, t->cells.height, kin_row, t) : RECEDE_OK;
}

recede_status rc_conditions_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                                 int levels, const rc_tone *tone, float deviation, bool focus,
                                 bool kin, bool light, rc_conditions *conditions) {
  int exponent = levels - 1 > LEAST_EXPONENT ? levels - 1 : LEAST_EXPONENT;
  int width = (flags[0].width + (1 << exponent) - 1) >> exponent;
  int height = (flags[0].height + (1 << exponent) - 1) >> exponent;
  table t = {.finest = flags, .exponent = exponent, .coarsest = levels - 1, .tone = tone};
  size_t count = (size_t)width * (size_t)height;
  float *blur;
  *conditions = (rc_conditions){NULL, 0, 0, 0};
  t.unit = 1 / ((double)deviation * sqrt(tone->channels));
  rc_block *before = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, count, &t.conditions));
  rc_block *mark = rc_mark(context);
  t.cells = (rc_mask){width, height, NULL};
  RC_TRY(RC_NEW_ZERO(context, count, &t.cells.data));
  RC_TRY(RC_NEW(context, count, &blur));
  RC_TRY(rc_parallel(context, height, mark_row, &t));
  if (focus)
    RC_TRY(rc_focus_measure(context, images, flags, levels, &t.cells, exponent, blur, &focus));
  for (size_t i = 0; focus && i < count; i++) t.conditions[i].blur = blur[i];
  if (light) RC_TRY(set_light(context, &t, &light));
  if (kin) RC_TRY(set_kin(context, &t, images, flags, levels, &kin));
  rc_release(context, mark);
  if (focus || kin || light)
    *conditions = (rc_conditions){t.conditions, width, height, exponent};
  else
    rc_release(context, before);
  return rc_poll(context);
}

void rc_conditions_forget_kin(rc_conditions *conditions) {
  for (int i = 0; i < conditions->width * conditions->height && conditions->cells; i++)
    conditions->cells[i].nearness.unit = 0;
}

float rc_conditions_price(const rc_condition *source, const rc_condition *target) {
  float blur = fabsf(source->blur - target->blur) - MOST_BLUR_OFF, square = 0, price = 0;
  if (blur > 0.f) price = PRICE_OF_BLUR * blur * blur;
  price += PRICE_OF_NO_KIN * (1 - rc_kinship(&source->likeness, &target->nearness));
  for (int k = 0; k < 3; k++) {
    float off = source->light[k] - target->light[k];
    square += off * off;
  }
  if (square <= MOST_RELIT * MOST_RELIT) return price;
  float relit = fminf(sqrtf(square) - MOST_RELIT, MOST_PRICED);
  return price + PRICE_OF_LIGHT * relit * relit;
}
