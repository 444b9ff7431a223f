#include <math.h>

#include "base/real.h"
#include "synthesis/structure/dash_row.h"
#include "synthesis/structure/dash_rows.h"

/* Copies of nearer ones may be so much too fine; an octave of what is too coarse is so much worse.
 */
#define MOST_FINE 6.
#define PRICE_COARSE 3.f
/* Its own row's, which lean as it does, are preferred by so many octaves. */
#define PRICE_OF_OTHER_ROW 1.f
#define RC_MOST_CANDIDATES (RC_MOST_DASH_ROWS * RC_MOST_IN_ROW)
/* Where one is seen in part the copy must fit that, moved by up to so many px of the level, in the
 * mean of squares to this part of the contrast: over so much of its length and width, if so many px
 * of that are seen. Each is the mean of some samples along and across. */
#define MOST_MOVED_PX 3
#define MOST_MISFIT .33
#define PART_ALONG 1.2
#define PART_ACROSS 2.
#define LEAST_SEEN 12
#define SAMPLES 3
/* A px farther must be so much better. */
#define PRICE_OF_MOVING .01
/* So many are tried, the cheapest first. */
#define MOST_TRIES 6

/* A hole that follows a dash is there to take it away: so much more of the dash is hidden than of
 * what lies around it, so many times its width to each side and beyond its ends. Places that are
 * looked at, along and across. */
#define FOLLOWS .5
#define AROUND 4.
#define PLACES 32

typedef struct chooser {
  const rc_dashes *dashes;
  const rc_mask *flags;
  const rc_ground *ground;
  int exponent;
} chooser;

/* The mean over a pixel of what lies (du, dv) away and so many px of the level farther. */
static bool off_away(const chooser *c, int x, int y, double du, double dv, int right, int down,
                     double *off) {
  double sum = 0;
  for (int k = 0; k < SAMPLES * SAMPLES; k++) {
    double u, v, w, from_x, from_y, here;
    double px = x + (k % SAMPLES + .5) / SAMPLES - .5, py = y + (k / SAMPLES + .5) / SAMPLES - .5;
    if (!rc_ground_place(c->ground, c->exponent, px, py, &u, &v, &w) ||
        !rc_ground_px(c->ground, c->exponent, u + du, v + dv, &from_x, &from_y, &w) ||
        !rc_dashes_off(c->dashes, from_x + right, from_y + down, &here))
      return false;
    sum += here;
  }
  *off = sum / (SAMPLES * SAMPLES);
  return true;
}

static rc_box box_of(const rc_ground *ground, const rc_mask *flags, int exponent,
                     const rc_dash_row *row, int n) {
  rc_box all = {0, 0, flags->width, flags->height};
  return rc_dash_box(ground, row, n, exponent, PART_ALONG, PART_ACROSS, 0, all);
}

static bool is_within(const rc_ground *ground, int exponent, const rc_dash_row *row, int n, int x,
                      int y) {
  double u, v, w;
  return rc_ground_place(ground, exponent, x, y, &u, &v, &w) &&
         fabs(rc_dash_along(row, u, v) - rc_dash_place(row, n)) < .5 * PART_ALONG * row->length &&
         fabs(rc_dash_across(row, u, v)) < .5 * PART_ACROSS * row->width;
}

bool rc_dash_is_hidden(const rc_ground *ground, const rc_mask *flags, int exponent,
                       const rc_dash_row *row, int n) {
  rc_box box = box_of(ground, flags, exponent, row, n);
  for (int y = box.y0; y < box.y1; y++)
    for (int x = box.x0; x < box.x1; x++)
      if (*rc_flag(flags, x, y) & RC_TARGET && is_within(ground, exponent, row, n, x, y))
        return true;
  return false;
}

bool rc_dash_is_to_go(const rc_ground *ground, const rc_mask *flags, int exponent,
                      const rc_dash_row *row, int n) {
  double hidden[2] = {0, 0}, all[2] = {0, 0}, x, y, w; /* around it, and of it */
  for (int k = 0; k < PLACES * PLACES; k++) {
    double t = (k % PLACES + .5) / PLACES - .5, side = (k / PLACES + .5) / PLACES - .5;
    t *= row->length + 2 * AROUND * row->width, side *= (1 + 2 * AROUND) * row->width;
    double along = rc_dash_place(row, n) + t;
    bool own = fabs(t) < .5 * row->length && fabs(side) < .5 * row->width;
    if (!rc_dash_px(ground, exponent, row, along, side, &x, &y, &w)) continue;
    int px = (int)floor(x + .5), py = (int)floor(y + .5);
    if (!rc_inside(flags->width, flags->height, px, py)) continue;
    all[own]++, hidden[own] += (*rc_flag(flags, px, py) & RC_TARGET) != 0;
  }
  return all[0] > 0 && all[1] > 0 && hidden[1] / all[1] - hidden[0] / all[0] > FOLLOWS;
}

/* How badly what lies (du, dv) away, moved by so many px of the level, fits the part of the n-th
 * that is seen; 0 where too little is. */
static double misfit_of(const chooser *c, const rc_dash_row *row, int n, double du, double dv,
                        int right, int down) {
  double squares = 0, here, there;
  int seen = 0, wanted = 0;
  rc_box box = box_of(c->ground, c->flags, c->exponent, row, n);
  for (int y = box.y0; y < box.y1; y++)
    for (int x = box.x0; x < box.x1; x++) {
      if (!is_within(c->ground, c->exponent, row, n, x, y) ||
          !rc_dashes_off(c->dashes, x, y, &here))
        continue;
      wanted++;
      if (!off_away(c, x, y, du, dv, right, down, &there)) continue;
      squares += (here - there) * (here - there), seen++;
    }
  if (wanted < LEAST_SEEN) return 0;
  if (2 * seen < wanted) return INFINITY;
  return squares / seen / (row->contrast * row->contrast);
}

/* A dash that is seen, as the source of another. */
typedef struct candidate {
  double u, v;
  float price;
} candidate;

/* Moves it to where it fits best. False: it does not. */
static bool move(const chooser *c, const rc_dash_row *row, int n, const candidate *from,
                 rc_dash_laid *laid) {
  double t = rc_dash_place(row, n), x, y, w, least = INFINITY, misfit = 0;
  double du = from->u - row->u - t * row->a, dv = from->v - row->v - t * row->b;
  if (!rc_ground_px(c->ground, c->exponent, from->u, from->v, &x, &y, &w)) return false;
  for (int down = -MOST_MOVED_PX; down <= MOST_MOVED_PX; down++)
    for (int right = -MOST_MOVED_PX; right <= MOST_MOVED_PX; right++) {
      double off = misfit_of(c, row, n, du, dv, right, down);
      double far = PRICE_OF_MOVING * sqrt((double)(right * right + down * down));
      if (off + far >= least ||
          !rc_ground_place(c->ground, c->exponent, x + right, y + down, &laid->u, &laid->v, &w))
        continue;
      least = off + far, misfit = off;
    }
  return least < INFINITY && misfit < MOST_MISFIT * MOST_MISFIT;
}

/* Those of a size that will do for a row's n-th, in the rows' order. */
static int collect(const rc_dash_rows *rows, const rc_dash_row *row, int n,
                   candidate candidates[RC_MOST_CANDIDATES]) {
  double x, y, w, there, t = rc_dash_place(row, n);
  int count = 0;
  if (!rc_dash_px(&rows->ground, 0, row, t, 0, &x, &y, &w)) return 0;
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *from = &rows->rows[i];
    if (!rc_dashes_alike(row, from->length, from->a, from->b)) continue;
    for (int k = 0; k < from->seen_count; k++) {
      t = rc_dash_place(from, from->seen[k]);
      candidate c = {.u = from->u + t * from->a, .v = from->v + t * from->b};
      if (!rc_ground_px(&rows->ground, 0, c.u, c.v, &x, &y, &there) ||
          there * RC_DASHES_MOST_COARSE < w || there > MOST_FINE * w)
        continue;
      float finer = rc_log2((float)(there / w));
      c.price = (finer < 0 ? -PRICE_COARSE : 1.f) * finer;
      if (from != row) c.price += PRICE_OF_OTHER_ROW;
      candidates[count++] = c;
    }
  }
  return count;
}

/* The cheapest of some that fit. False: none does. */
static bool choose(const chooser *c, const rc_dash_rows *rows, const rc_dash_row *row, int n,
                   rc_dash_laid *laid) {
  candidate candidates[RC_MOST_CANDIDATES];
  int count = collect(rows, row, n, candidates);
  for (int tries = 0; tries < MOST_TRIES; tries++) {
    int best = -1;
    for (int i = 0; i < count; i++)
      if (candidates[i].price < INFINITY &&
          (best < 0 || candidates[i].price < candidates[best].price))
        best = i;
    if (best < 0) return false;
    if (move(c, row, n, &candidates[best], laid)) return true;
    candidates[best].price = INFINITY;
  }
  return false;
}

/* The farthest place along a row where any of the others is seen to end, to that side; INFINITY:
 * one does not, or there is none. */
static double end_of_others(const rc_dash_rows *rows, const rc_dash_row *row, double side) {
  double farthest = -INFINITY;
  for (int i = 0; i < rows->count; i++) {
    const rc_dash_row *s = &rows->rows[i];
    double same = s->a * row->a + s->b * row->b;
    if (s == row || !rc_dashes_alike(row, s->length, s->a, s->b)) continue;
    bool high = same * side > 0;
    double t = rc_dash_place(s, high ? s->high : s->low);
    if (!s->ends[high]) return INFINITY;
    farthest = fmax(farthest, side * rc_dash_along(row, s->u + t * s->a, s->v + t * s->b));
  }
  return farthest > -INFINITY ? farthest : INFINITY;
}

/* Lanes end together: where all others are seen to, those do of which the hole or the distance
 * hides it. But not before what is seen of them. */
static void end_together(rc_dash_rows *rows) {
  for (int i = 0; i < rows->count; i++) {
    rc_dash_row *row = &rows->rows[i];
    double low = -end_of_others(rows, row, -1), high = end_of_others(rows, row, 1);
    if (!row->ends[0] && isfinite(low)) row->low = rc_dash_number(row, low);
    if (!row->ends[1] && isfinite(high)) row->high = rc_dash_number(row, high);
    for (int k = 0; k < row->seen_count; k++) {
      if (row->seen[k] < row->low) row->low = row->seen[k];
      if (row->seen[k] > row->high) row->high = row->seen[k];
    }
  }
}

recede_status rc_dash_rows_choose(rc_context *context, const rc_dashes *dashes,
                                  const rc_mask *flags, int exponent, rc_dash_rows *rows) {
  chooser c = {dashes, flags, &rows->ground, exponent};
  end_together(rows);
  int found = rows->count;
  for (int i = 0; i < found; i++) {
    rc_dash_row *row = &rows->rows[i];
    row->laid_count = 0;
    for (int n = row->low; n <= row->high && row->laid_count < RC_MOST_IN_ROW; n++) {
      rc_dash_laid laid = {.number = n};
      RC_TRY(rc_poll(context));
      if (!rc_dash_is_hidden(&rows->ground, flags, exponent, row, n) ||
          rc_dash_is_to_go(&rows->ground, flags, exponent, row, n))
        continue;
      if (choose(&c, rows, row, n, &laid))
        row->laid[row->laid_count++] = laid;
      else if (rows->count < RC_MOST_DASH_ROWS)
        rows->count +=
            rc_dash_of_rest(dashes, rows, flags, exponent, row, n, &rows->rows[rows->count]);
    }
  }
  return RECEDE_OK;
}
