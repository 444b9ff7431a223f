#include "synthesis/structure/regions.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "image/distance.h"
#include "synthesis/structure/chords.h"

/* What is so far from the hole, in its widths, says what two textures there are. */
#define BESIDE_OF_HOLE .6
#define LEAST_BESIDE_PX 8
/* Of thin holes the coarsest level is large, and patches see across. */
#define MOST_PIXELS (1 << 17)
/* How much two groups must explain where there is one chord: a pier's light and dark end have .84,
 * and boards were cut between; a roof and a wall .87. Two chords hardly come by chance. */
#define LEAST_OF_ONE_CHORD .86
/* And where it turns from the edges by no more than this, as the pier's do (.17), but a ridge's and
 * roofs' do not: */
#define STRAIGHT_TURN .08f
#define LEAST_OF_ONE_STRAIGHT .8
/* A chord's pixels; and so near to it, or to any change, the border's are in doubt: a chord may run
 * along the border, just outside the hole, and keeps nothing apart there. */
#define CHORD_PX .75f
#define DOUBTFUL_PX 4.f
/* Where an edge is ragged labels change to and fro; they are smoothed so many times for two chords
 * or more to be told. */
#define MOST_SMOOTHED 4

typedef struct finder {
  rc_context *context;
  rc_chart chart; /* of the level */
  rc_around around;
  int8_t *label;
} finder;

static bool near_a_chord(const rc_chords *c, float x, float y, float px) {
  for (int i = 0; i < c->piece_count; i++) {
    const rc_change *from = &c->end[i][0], *to = &c->end[i][1];
    float ux = to->x - from->x, uy = to->y - from->y;
    float t = ((x - from->x) * ux + (y - from->y) * uy) / fmaxf(ux * ux + uy * uy, 1e-6f);
    t = fminf(fmaxf(t, 0.f), 1.f);
    rc_change nearest = {from->x + t * ux, from->y + t * uy, 0, 0}, here = {x, y, 0, 0};
    if (rc_apart(&nearest, &here) <= px) return true;
  }
  return false;
}

static bool is_doubtful(const rc_chords *c, float x, float y) {
  rc_change here = {x, y, 0, 0};
  for (int i = 0; i < c->change_count; i++)
    if (rc_apart(&c->changes[i], &here) <= DOUBTFUL_PX) return true;
  return near_a_chord(c, x, y, DOUBTFUL_PX);
}

/* Spreads the labels of the border's pixels, those in doubt or the others, into what has none yet
 * of the hole, up to the chords. */
static void spread(const finder *f, const rc_chords *c, bool doubtful, int32_t *queue,
                   bool *kept_apart) {
  static const int dx[4] = {1, -1, 0, 0}, dy[4] = {0, 0, 1, -1};
  const rc_around *a = &f->around;
  const rc_labels labels = {a, f->label};
  size_t first = 0, last = 0;
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++)
      if (rc_on_border(&labels, x, y) && is_doubtful(c, (float)x, (float)y) == doubtful)
        queue[last++] = y * a->width + x;
  *kept_apart = true;
  size_t seeds = last;
  while (first < last) {
    int here = queue[first++];
    for (int k = 0; k < 4; k++) {
      int x = here % a->width + dx[k], y = here / a->width + dy[k], next = y * a->width + x;
      if (!rc_inside(a->width, a->height, x, y) || a->from_hole[next] ||
          near_a_chord(c, (float)x, (float)y, CHORD_PX))
        continue;
      if (f->label[next] == -f->label[here]) *kept_apart = false;
      if (f->label[next]) continue;
      f->label[next] = f->label[here];
      queue[last++] = next;
    }
  }
  if (last == seeds) *kept_apart = false; /* nobody was asked */
}

/* Labels the hole. kept_apart: no two labels meet but at chords. Those in doubt are asked last,
 * for what only they lead to. Where they do meet the hole's labels are taken away again. */
static recede_status label_hole(const finder *f, const rc_chords *c, bool *kept_apart) {
  int32_t *queue;
  bool unused;
  rc_block *mark = rc_mark(f->context);
  RC_TRY(RC_NEW(f->context, f->around.pixels, &queue));
  spread(f, c, false, queue, kept_apart);
  spread(f, c, true, queue, &unused);
  for (size_t i = 0; !*kept_apart && i < f->around.pixels; i++)
    if (!f->around.from_hole[i]) f->label[i] = 0;
  rc_release(f->context, mark);
  return rc_poll(f->context);
}

/* From the nearest chord or pixel of the other label, positive where the first is; what is not
 * known has none. */
static recede_status measure_distances(const finder *f, float *distance) {
  const rc_around *a = &f->around;
  uint8_t *own, *depth;
  rc_block *mark = rc_mark(f->context);
  RC_TRY(RC_NEW(f->context, a->pixels, &own));
  RC_TRY(RC_NEW(f->context, a->pixels, &depth));
  for (int label = -1; label <= 1; label += 2) {
    for (size_t i = 0; i < a->pixels; i++)
      own[i] = f->label[i] == label || (!f->label[i] && a->from_hole[i]);
    rc_distance_inside(own, 1, a->width, a->height, false, depth);
    for (size_t i = 0; i < a->pixels; i++)
      if (f->label[i] == label) distance[i] = (float)label * ((float)depth[i] - .5f);
  }
  rc_release(f->context, mark);
  return rc_poll(f->context);
}

/* beside_px: how far from the hole its textures are looked at. */
static recede_status measure_from_hole(finder *f, int *beside_px) {
  rc_around *a = &f->around;
  uint8_t *hole;
  int deepest = 0;
  RC_TRY(RC_NEW(f->context, a->pixels, &a->from_hole));
  RC_TRY(RC_NEW(f->context, a->pixels, &hole));
  for (size_t i = 0; i < a->pixels; i++) {
    int x = a->box.x0 + (int)(i % (size_t)a->width), y = a->box.y0 + (int)(i / (size_t)a->width);
    hole[i] = (*rc_flag(a->flags, x, y) & RC_TARGET) != 0;
  }
  rc_distance_inside(hole, 1, a->width, a->height, false, a->from_hole);
  for (size_t i = 0; i < a->pixels; i++) {
    deepest = a->from_hole[i] > deepest ? a->from_hole[i] : deepest;
    hole[i] = !hole[i];
  }
  rc_distance_inside(hole, 1, a->width, a->height, false, a->from_hole);
  *beside_px = (int)(BESIDE_OF_HOLE * 2 * deepest);
  if (*beside_px < LEAST_BESIDE_PX) *beside_px = LEAST_BESIDE_PX;
  return rc_poll(f->context);
}

static bool trusted(const rc_chords *c, const rc_way *way) {
  if (c->count != 1) return c->count > 0;
  return way->explained >= (c->turn > STRAIGHT_TURN ? LEAST_OF_ONE_CHORD : LEAST_OF_ONE_STRAIGHT);
}

/* Asks one way to tell two things apart. */
static recede_status find_chords(finder *f, const rc_groups *groups, const rc_way *way, bool *two,
                                 int *count) {
  rc_chords chords;
  bool kept_apart = false;
  RC_TRY(rc_groups_label(f->context, &f->around, groups, way, f->label));
  for (int smoothed = 0; smoothed <= MOST_SMOOTHED && !kept_apart; smoothed++) {
    if (smoothed) RC_TRY(rc_groups_smooth(f->context, &f->around, f->label));
    RC_TRY(rc_chords_find(f->context, &f->around, &f->chart, f->label, &chords));
    *two = *two || chords.change_count > 0;
    if (!trusted(&chords, way) || (smoothed && chords.count == 1)) continue;
    RC_TRY(label_hole(f, &chords, &kept_apart));
  }
  *count = kept_apart ? chords.count : 0;
  return RECEDE_OK;
}

static recede_status find(finder *f, float *distance, bool *two, int *count) {
  rc_groups groups;
  int beside_px;
  RC_TRY(measure_from_hole(f, &beside_px));
  RC_TRY(RC_NEW_ZERO(f->context, f->around.pixels, &f->label));
  RC_TRY(rc_groups_find(f->context, &f->around, beside_px, &groups));
  for (int i = 0; i < groups.count && !*count; i++)
    RC_TRY(find_chords(f, &groups, &groups.ways[i], two, count));
  return *count ? measure_distances(f, distance) : RECEDE_OK;
}

recede_status rc_regions_find(rc_context *context, const rc_image *image, const rc_mask *flags,
                              const rc_chart *chart, rc_regions *regions, bool *two,
                              int *chord_count) {
  rc_box box = rc_box_of(flags, RC_SOURCE | RC_TARGET);
  finder f = {.context = context,
              .chart = *chart,
              .around = {.image = image,
                         .flags = flags,
                         .box = box,
                         .width = box.x1 - box.x0,
                         .height = box.y1 - box.y0}};
  float *distance;
  f.around.pixels = (size_t)f.around.width * (size_t)f.around.height;
  *regions = (rc_regions){NULL, box.x0, box.y0, f.around.width, f.around.height, 1};
  *two = false, *chord_count = 0;
  if (f.around.pixels > MOST_PIXELS) return RECEDE_OK;
  RC_TRY(RC_NEW_ZERO(context, f.around.pixels, &distance));
  rc_block *mark = rc_mark(context);
  RC_TRY(find(&f, distance, two, chord_count));
  rc_release(context, mark);
  if (*chord_count)
    regions->distance = distance;
  else
    RC_FREE(context, &distance);
  return RECEDE_OK;
}
