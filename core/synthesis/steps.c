/* Method plane: what is too far away for any source is filled after the rest, from it. Its patches
 * cover so much more of the plane than nearer ones that none lies wholly in source: of a texture
 * seen only at one's feet that is most of a floor. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/fill_plane.h"
#include "synthesis/structure/rails.h"

/* Steps are worth their time where so much of the target is far, and as much found no source. */
#define LEAST_REST .01
/* Of the time, when steps follow, the first fill's part: for progress. */
#define FIRST_SHARE .4
/* Pixels are sorted by w into bins, eight an octave, 1 in the middle: those of a float's first
 * mantissa bits, so of 1.07 to 1.13 times each. */
#define BIN_SHIFT 20
#define BINS 192
/* A step goes as far as there are sources no more than so many bins, about 1.7 times, nearer. At
 * twice, joints break off. */
#define REACH_BINS 6
/* Sources, of the targets as far away: beside most holes there are more. */
#define ENOUGH .25
/* What found no source is tried again where by then there is source enough no more than so many
 * bins away; if that is such a part of all, and as long as a step fills such a part. Boards are
 * such that lie to the sides of where the texture ends. */
#define NEAR_BINS 2
#define LEAST_AGAIN .01
#define LEAST_FILLED .02
/* What is left is done at once when it is less than this part of all: a strip along the horizon,
 * thinner than a patch. */
#define LAST_PART .03
/* A step looks at what is up to so many bins, three times, nearer than what it fills. */
#define BINS_LOOKED_AT 13
#define LEAST_MARGIN_PX 16

typedef struct tally {
  uint64_t target[BINS], source[BINS];
} tally;

typedef struct steps {
  const rc_problem *problem;
  const recede_params *params;
  rc_image *filled;
  rc_mask flags; /* of all: what has been filled is a source */
  rc_mask bins;  /* the bin of each pixel */
  rc_shortfall shortfall;
  rc_known_rails rails; /* in a chart of all */
  uint64_t targets, done;
} steps;

static uint8_t bin_of(const rc_line *line, int x, int y) {
  const uint32_t one = 0x3f800000;
  float w = (float)rc_w(line, x, y);
  uint32_t bits;
  if (!(w > 0)) return 0;
  memcpy(&bits, &w, sizeof bits);
  int bin = (int)(bits >> BIN_SHIFT) - (int)(one >> BIN_SHIFT) + BINS / 2;
  return (uint8_t)(bin < 0 ? 0 : bin < BINS ? bin : BINS - 1);
}

/* Of a problem, before there are bins of each pixel. */
typedef struct tallying {
  const rc_problem *problem;
  tally *of_thread;
} tallying;

/* So many pixels of a row at once: w only grows along it, or only falls. */
#define COLUMNS 64

static void tally_row(void *user, int y, int thread) {
  const tallying *c = user;
  const rc_line *line = &c->problem->line;
  const uint8_t *flags = rc_flag(&c->problem->flags, 0, y);
  tally *t = &c->of_thread[thread];
  int width = c->problem->flags.width;
  for (int first = 0; first < width; first += COLUMNS) {
    int end = first + COLUMNS < width ? first + COLUMNS : width, targets = 0, sources = 0;
    uint8_t bin = bin_of(line, first, y);
    bool same = bin == bin_of(line, end - 1, y);
    for (int x = first; x < end && same; x++)
      targets += (flags[x] & RC_TARGET) != 0, sources += (flags[x] & RC_SOURCE) != 0;
    t->target[bin] += (uint64_t)targets, t->source[bin] += (uint64_t)sources;
    for (int x = first; x < end && !same; x++) {
      bin = bin_of(line, x, y);
      t->target[bin] += (flags[x] & RC_TARGET) != 0, t->source[bin] += (flags[x] & RC_SOURCE) != 0;
    }
  }
}

static recede_status tally_all(rc_context *context, const rc_problem *problem, tally *t) {
  tallying c = {.problem = problem};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, context->threads, &c.of_thread));
  RC_TRY(rc_parallel(context, problem->flags.height, tally_row, &c));
  memset(t, 0, sizeof *t);
  for (int n = 0; n < context->threads; n++)
    for (int i = 0; i < BINS; i++) {
      t->target[i] += c.of_thread[n].target[i];
      t->source[i] += c.of_thread[n].source[i];
    }
  rc_release(context, mark);
  return RECEDE_OK;
}

static void sort_row(void *user, int y, int thread) {
  steps *s = user;
  (void)thread;
  for (int x = 0; x < s->flags.width; x++)
    *rc_flag(&s->bins, x, y) = bin_of(&s->problem->line, x, y);
}

static void count(const steps *s, tally *t) {
  memset(t, 0, sizeof *t);
  for (int y = 0; y < s->flags.height; y++)
    for (int x = 0; x < s->flags.width; x++) {
      uint8_t flag = *rc_flag(&s->flags, x, y);
      if (!(flag & (RC_TARGET | RC_SOURCE))) continue;
      (flag & RC_TARGET ? t->target : t->source)[*rc_flag(&s->bins, x, y)]++;
    }
}

/* From bin first up to, not with, last. */
static uint64_t sum(const uint64_t bins[BINS], int first, int last) {
  uint64_t all = 0;
  for (int i = first; i < last && i < BINS; i++) all += bins[i];
  return all;
}

/* The farthest bin of the next step: beyond it all sources are much nearer than the target. */
static int farthest(const tally *t) {
  int bin = BINS - 1;
  for (; bin >= 0; bin--) {
    int reach = bin + REACH_BINS + 1;
    double targets = (double)sum(t->target, bin, reach);
    if (t->target[bin] && (double)sum(t->source, 0, reach) < ENOUGH * targets &&
        sum(t->source, reach, BINS))
      break;
  }
  return bin + 1;
}

static int nearest(const tally *t) {
  int bin = BINS - 1;
  while (bin > 0 && !t->target[bin]) bin--;
  return bin;
}

/* What is looked at to fill the nearest targets: up to some times nearer than they are, and so far
 * that there is source. */
static rc_box box_of_step(const steps *s, const tally *t) {
  const rc_mask *flags = &s->flags;
  rc_box box = {flags->width, flags->height, 0, 0};
  int source = 0;
  while (source < BINS - 1 && !t->source[source]) source++;
  int most = (nearest(t) > source ? nearest(t) : source) + BINS_LOOKED_AT;
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      if (!*rc_flag(flags, x, y) || *rc_flag(&s->bins, x, y) > most) continue;
      if (x < box.x0) box.x0 = x;
      if (x >= box.x1) box.x1 = x + 1;
      if (y < box.y0) box.y0 = y;
      box.y1 = y + 1;
    }
  return rc_box_grown(box, LEAST_MARGIN_PX, flags->width, flags->height);
}

/* The part of the whole in the box, with its own target. */
static recede_status cut_out(rc_context *context, const steps *s, rc_box box, int first,
                             rc_problem *part) {
  int width = box.x1 - box.x0, height = box.y1 - box.y0, channels = s->filled->channels;
  double sum_x = 0, sum_y = 0, targets = 0;
  *part = *s->problem;
  part->origin_x += box.x0, part->origin_y += box.y0;
  part->cut_x = part->cut_y = 0, part->shorter_px = rc_shorter_side(box);
  part->line.c = rc_w(&part->line, box.x0, box.y0);
  RC_TRY(rc_image_new(context, width, height, channels, &part->image));
  RC_TRY(rc_mask_new(context, width, height, &part->flags));
  for (int y = 0; y < height; y++) {
    memcpy(rc_flag(&part->flags, 0, y), rc_flag(&s->flags, box.x0, box.y0 + y), (size_t)width);
    for (int x = 0; x < width; x++) {
      uint8_t *flag = rc_flag(&part->flags, x, y);
      if (*flag & RC_KNOWN)
        memcpy(rc_pixel(&part->image, x, y), rc_pixel(s->filled, box.x0 + x, box.y0 + y),
               (size_t)channels * sizeof(float));
      if (!(*flag & RC_TARGET)) continue;
      if (*rc_flag(&s->bins, box.x0 + x, box.y0 + y) < first)
        *flag = 0; /* a later step's */
      else
        sum_x += x, sum_y += y, targets++;
    }
  }
  double unit = rc_w(&part->line, sum_x / targets, sum_y / targets);
  part->line = (rc_line){part->line.a / unit, part->line.b / unit, part->line.c / unit};
  part->target = rc_box_of(&part->flags, RC_TARGET);
  return RECEDE_OK;
}

static uint8_t *rest_at(const steps *s, int x, int y) {
  return &s->shortfall.rest[(size_t)y * (size_t)s->flags.width + (size_t)x];
}

/* What was filled, the bins from first on, stays, and is source. What found none remains a target.
 */
static void take_filled(steps *s, int first) {
  const rc_mask *flags = &s->flags;
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      if (!(*rc_flag(flags, x, y) & RC_TARGET) || *rc_flag(&s->bins, x, y) < first ||
          *rest_at(s, x, y))
        continue;
      *rc_flag(flags, x, y) = RC_KNOWN | RC_SOURCE;
      s->done++;
    }
}

/* Bins from first on where by now there is source enough to try again what found none. */
static void find_again(const steps *s, int first, bool again[BINS]) {
  tally t;
  uint64_t tried = 0;
  count(s, &t);
  for (int i = first < 0 ? 0 : first; i < BINS; i++) {
    int from = i < NEAR_BINS ? 0 : i - NEAR_BINS, end = i + NEAR_BINS + 1;
    again[i] = (double)sum(t.source, from, end) > ENOUGH * (double)sum(t.target, from, end);
    tried += again[i] ? t.target[i] : 0;
  }
  if ((double)tried < LEAST_AGAIN * (double)s->targets) memset(again, 0, BINS * sizeof *again);
}

/* What found no source and is not tried again: what continues what is beside it gets these flags.
 */
static void settle(steps *s, int first, const bool again[BINS], uint8_t continued) {
  const rc_mask *flags = &s->flags;
  for (int y = 0; y < flags->height; y++)
    for (int x = 0; x < flags->width; x++) {
      int bin = *rc_flag(&s->bins, x, y);
      if (!(*rc_flag(flags, x, y) & RC_TARGET) || bin < first || again[bin]) continue;
      bool missing = *rest_at(s, x, y) == 2;
      *rc_flag(flags, x, y) = missing ? RC_KNOWN : continued;
      s->shortfall.missing += missing;
      s->shortfall.continued += !missing;
      s->done++;
    }
}

/* After a fill of the bins from first on: what it filled is kept, of what found no source is
 * settled what no later step may fill. */
static void keep(steps *s, int first, uint8_t continued) {
  bool again[BINS] = {false};
  take_filled(s, first);
  find_again(s, first, again);
  settle(s, first, again, continued);
}

/* Fills the bins of the target from first on. */
static recede_status fill_step(rc_context *context, steps *s, const tally *t, int first) {
  rc_problem part;
  recede_params params = *s->params;
  rc_shortfall shortfall = {NULL, 0, 0};
  rc_known_rails rails = s->rails;
  rc_box box = box_of_step(s, t);
  size_t bytes = (size_t)s->filled->channels * sizeof(float);
  rc_block *mark = rc_mark(context);
  RC_TRY(cut_out(context, s, box, first, &part));
  RC_TRY(
      RC_NEW_ZERO(context, (size_t)part.flags.width * (size_t)part.flags.height, &shortfall.rest));
  params.surface = context->report.surface; /* one for all */
  rails.chart.x0 -= (float)box.x0, rails.chart.y0 -= (float)box.y0;
  RC_TRY(rc_fill_plane(context, &part, &params, false, &part.image, &shortfall, &rails));
  for (int y = part.target.y0; y < part.target.y1; y++)
    for (int x = part.target.x0; x < part.target.x1; x++) {
      if (!(*rc_flag(&part.flags, x, y) & RC_TARGET)) continue;
      uint8_t rest = shortfall.rest[(size_t)y * (size_t)part.flags.width + (size_t)x];
      if (rest == 2) continue; /* it has an earlier fill's */
      memcpy(rc_pixel(s->filled, box.x0 + x, box.y0 + y), rc_pixel(&part.image, x, y), bytes);
      *rest_at(s, box.x0 + x, box.y0 + y) = rest;
    }
  rc_release(context, mark);
  return RECEDE_OK;
}

/* Of progress, for so many pixels. */
static void share_of_step(rc_context *context, const steps *s, uint64_t pixels) {
  double each = (1 - FIRST_SHARE) / (double)s->targets;
  double from = FIRST_SHARE + each * (double)s->done;
  rc_span(context, from, from + each * (double)pixels);
}

static recede_status fill_rest(rc_context *context, steps *s) {
  static const bool none[BINS];
  tally t;
  RC_TRY(rc_mask_new(context, s->flags.width, s->flags.height, &s->bins));
  RC_TRY(rc_parallel(context, s->flags.height, sort_row, s));
  RC_TRY(rc_mask_new(context, s->flags.width, s->flags.height, &s->flags));
  memcpy(s->flags.data, s->problem->flags.data, (size_t)s->flags.width * (size_t)s->flags.height);
  s->shortfall.continued = s->shortfall.missing = 0;
  count(s, &t);
  int first = farthest(&t);
  /* Large parts that only continue would be seen again; the strips that steps leave would not. */
  keep(s, first, RC_KNOWN);
  while (s->done < s->targets) {
    uint64_t before = s->done;
    RC_TRY(rc_poll(context));
    count(s, &t);
    if (!sum(t.target, first, BINS)) { /* nothing is tried again */
      first = farthest(&t);
      if (!sum(t.target, first, BINS)) first = nearest(&t) - REACH_BINS; /* as far as one can */
      if ((double)sum(t.target, 0, first) < LAST_PART * (double)s->targets) first = 0;
    }
    share_of_step(context, s, sum(t.target, first, BINS));
    RC_TRY(rc_poll(context));
    RC_TRY(fill_step(context, s, &t, first));
    keep(s, first, RC_KNOWN | RC_SOURCE);
    if ((double)(s->done - before) < LEAST_FILLED * (double)s->targets)
      settle(s, first, none, RC_KNOWN | RC_SOURCE);
  }
  return RECEDE_OK;
}

static void tell(rc_context *context, const rc_shortfall *shortfall) {
  const recede_report *report = &context->report;
  if (report->magnified_pixels)
    rc_warn(context,
            "%llu px had to be magnified (up to %.1f times): no source of their size exists.",
            (unsigned long long)report->magnified_pixels, report->largest_magnification);
  if (shortfall->continued)
    rc_warn(context,
            "%llu px are too small or too large for any source and continue what is beside "
            "them.",
            (unsigned long long)shortfall->continued);
  if (shortfall->missing)
    rc_warn(context, "%llu px found no source and got the smooth tone alone.",
            (unsigned long long)shortfall->missing);
}

recede_status rc_fill_in_steps(rc_context *context, const rc_problem *problem,
                               const recede_params *params, rc_image *filled) {
  steps s = {.problem = problem, .params = params, .filled = filled, .flags = problem->flags};
  int width = problem->flags.width, height = problem->flags.height;
  bool frontal = problem->line.a == 0 && problem->line.b == 0;
  tally t;
  RC_TRY(RC_NEW_ZERO(context, (size_t)width * (size_t)height, &s.shortfall.rest));
  RC_TRY(tally_all(context, problem, &t));
  s.targets = sum(t.target, 0, BINS);
  double least = LEAST_REST * (double)s.targets;
  bool far = params->engine_steps && !frontal && (double)sum(t.target, 0, farthest(&t)) >= least;
  rc_span(context, 0, far ? FIRST_SHARE : 1);
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_fill_plane(context, problem, params, far || problem->synthesis, filled, &s.shortfall,
                       &s.rails));
  rc_release(context, mark);
  if (far && (double)(s.shortfall.continued + s.shortfall.missing) >= least)
    RC_TRY(fill_rest(context, &s));
  rc_span(context, 0, 1);
  tell(context, &s.shortfall);
  return RECEDE_OK;
}
