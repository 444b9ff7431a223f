#include "synthesis/sources/kin.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/real.h"
#include "image/distance.h"
#include "synthesis/sources/places.h"

/* What is beside the hole, so near to it as RC_TOUCHING_PX, is every n-th pixel of that; of fewer
 * than the least nothing is told. */
#define LEAST_SAMPLES 32
#define MOST_SAMPLES 256
/* The square that is looked at, to each side: a hen's tail is 5 px at the coarsest level. */
#define HALF_PX 2
/* What looks like a part differs from one of its samples by no more than these do, 90 of 100, from
 * the most similar other, at most so far away, that shares no pixel with them: beside a wood all is
 * alike, beside a road little. A part has few samples: it gets at least what textures that fill the
 * picture have, 13 in units of what places differ by, unless all samples have less, and these at
 * least 1. Up to 1.5 times that hens and grass were alike, and water and stone. */
#define OWN_PERCENTILE 90
#define OWN_PX 15
#define LEAST_OWN 1.f
#define OF_A_TEXTURE 13.f
/* What a sample says of a target pixel falls with the square of its distance, and this. */
#define NEAR_SQUARE_PX 4
/* A copy is the more foreign the less it has of what is usual; from so much on it is not, for what
 * lies beside the hole varies. What crosses it, a groove, is little of what is beside it: so what
 * the parts on opposite sides both look like counts, too, half: more let in a carved stone.
 */
#define ENOUGH .3f
#define OF_CROSSING .5f
/* There are several things where so many of all pairs of a source and a target pixel have less than
 * so much of what is usual. Of 30 drawn textures 26 have less, seen at a grazing angle up to .47,
 * pebbles .05 to .25; paths beside grass, walls, water and animals .3 to .7. */
#define FOREIGN .1f
#define LEAST_FOREIGN .27
/* Of so many sources and target pixels each, at the most. */
#define MOST_EACH 256

typedef struct rc_kin_sample {
  int x, y, part;
  rc_material material;
} sample;

static int64_t square_px(const sample *p, int x, int y) {
  int64_t dx = p->x - x, dy = p->y - y;
  return dx * dx + dy * dy;
}

static recede_status take_samples(rc_context *context, rc_kin *f) {
  int width = f->flags->width, height = f->flags->height, found = 0, seen = 0;
  size_t pixels = (size_t)width * (size_t)height;
  uint8_t *outside, *from_hole; /* px */
  RC_TRY(RC_NEW(context, MOST_SAMPLES, &f->samples));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, pixels, &outside));
  RC_TRY(RC_NEW(context, pixels, &from_hole));
  for (size_t i = 0; i < pixels; i++) outside[i] = !(f->flags->data[i] & RC_TARGET);
  rc_distance_inside(outside, 1, width, height, false, from_hole);
  for (size_t i = 0; i < pixels; i++) {
    outside[i] = from_hole[i] && from_hole[i] <= RC_TOUCHING_PX && f->flags->data[i] & RC_SOURCE &&
                 !isnan(f->materials[i].value[0]);
    found += outside[i];
  }
  int step = found / MOST_SAMPLES + 1;
  for (size_t i = 0; i < pixels; i++)
    if (outside[i] && seen++ % step == 0)
      f->samples[f->count++] =
          (sample){(int)(i % (size_t)width), (int)(i / (size_t)width), 0, f->materials[i]};
  rc_release(context, mark);
  return rc_poll(context);
}

/* Each part has a sample far from all others' for its middle, and what is nearest to that. */
static void divide(rc_kin *f) {
  int64_t nearest[MOST_SAMPLES];
  int middle = 0;
  for (int i = 0; i < f->count; i++) nearest[i] = INT64_MAX;
  for (int part = 0; part < RC_KIN_PARTS; part++) {
    int next = 0;
    for (int i = 0; i < f->count; i++) {
      int64_t here = square_px(&f->samples[middle], f->samples[i].x, f->samples[i].y);
      if (here < nearest[i]) nearest[i] = here, f->samples[i].part = part;
      if (nearest[i] > nearest[next]) next = i;
    }
    middle = next;
  }
}

static int by_part(const void *a, const void *b) {
  const sample *p = a, *q = b;
  int place = p->y != q->y ? p->y - q->y : p->x - q->x;
  return p->part != q->part ? p->part - q->part : place;
}

static void order_by_part(rc_kin *f) {
  qsort(f->samples, (size_t)f->count, sizeof *f->samples, by_part);
  for (int i = 0; i < f->count; i++) {
    sample *s = &f->samples[i];
    f->first[s->part + 1]++;
    f->middle[s->part][0] += (float)s->x, f->middle[s->part][1] += (float)s->y;
  }
  for (int k = 0; k < RC_KIN_PARTS; k++) {
    float count = (float)f->first[k + 1];
    f->middle[k][0] /= count, f->middle[k][1] /= count;
    f->first[k + 1] += f->first[k];
  }
}

/* The percentile of the squares of samples from..to; infinite where fewer have others. */
static float own_spread(const rc_kin *f, int from, int to, int fewest) {
  float nearest[MOST_SAMPLES];
  int count = 0;
  for (int i = from; i < to; i++) {
    const sample *p = &f->samples[i];
    float least = INFINITY;
    for (int k = 0; k < f->count; k++) {
      const sample *q = &f->samples[k];
      bool shares = abs(p->x - q->x) <= 2 * HALF_PX && abs(p->y - q->y) <= 2 * HALF_PX;
      if (!shares && square_px(p, q->x, q->y) <= OWN_PX * OWN_PX)
        least = fminf(least, rc_material_square(&p->material, &q->material));
    }
    if (isfinite(least)) nearest[count++] = least;
  }
  if (count < fewest) return INFINITY;
  qsort(nearest, (size_t)count, sizeof *nearest, rc_by_value);
  return fmaxf(nearest[count * OWN_PERCENTILE / 100], LEAST_OWN);
}

/* What part of a part it looks like. */
static float looks_like(const rc_kin *f, const rc_material *material, int part) {
  int alike = 0, count = f->first[part + 1] - f->first[part];
  for (int i = f->first[part]; i < f->first[part + 1]; i++)
    alike += rc_material_square(material, &f->samples[i].material) <= f->most[part];
  return (float)alike / (float)count;
}

static void compare_parts(rc_kin *f) {
  for (int i = 0; i < f->count; i++) {
    const sample *s = &f->samples[i];
    float share = 1 / (float)(f->first[s->part + 1] - f->first[s->part]);
    for (int k = 0; k < RC_KIN_PARTS; k++)
      f->among[s->part][k] += share * looks_like(f, &s->material, k);
  }
}

rc_likeness rc_likeness_at(const rc_kin *f, int x, int y) {
  const rc_material *material = &f->materials[(size_t)y * (size_t)f->flags->width + (size_t)x];
  rc_likeness to;
  bool known = !isnan(material->value[0]);
  for (int k = 0; k < RC_KIN_PARTS; k++)
    to.part[k] = known ? (uint8_t)(255 * looks_like(f, material, k) + .5f) : 255;
  return to;
}

rc_nearness rc_nearness_at(const rc_kin *f, int x, int y) {
  rc_nearness to;
  float near[RC_KIN_PARTS] = {0}, most = 0, sum = 0, usual = 0;
  for (int i = 0; i < f->count; i++)
    near[f->samples[i].part] += 1 / (float)(square_px(&f->samples[i], x, y) + NEAR_SQUARE_PX);
  for (int k = 0; k < RC_KIN_PARTS; k++) most = fmaxf(most, near[k]);
  for (int k = 0; k < RC_KIN_PARTS; k++) {
    to.part[k] = (uint8_t)(255 * near[k] / most + .5f);
    sum += to.part[k];
  }
  for (int k = 0; k < RC_KIN_PARTS; k++)
    for (int i = 0; i < RC_KIN_PARTS; i++) usual += to.part[k] * f->among[k][i] * to.part[i];
  to.unit = sum / (255 * usual);
  for (int k = 0; k < RC_KIN_PARTS; k++) {
    float least = INFINITY;
    for (int i = 0; i < RC_KIN_PARTS; i++) {
      float ix = f->middle[i][0] - (float)x, iy = f->middle[i][1] - (float)y;
      float kx = f->middle[k][0] - (float)x, ky = f->middle[k][1] - (float)y;
      float cosine = (ix * kx + iy * ky) / sqrtf(ix * ix + iy * iy + 1);
      if (cosine < least) least = cosine, to.across[k] = (uint8_t)i;
    }
  }
  return to;
}

static float usual_share(const rc_likeness *source, const rc_nearness *target) {
  int sum = 0;
  for (int k = 0; k < RC_KIN_PARTS; k++) sum += source->part[k] * target->part[k];
  return (float)sum * target->unit;
}

static float crossing_share(const rc_likeness *source, const rc_nearness *target) {
  int most = 0;
  for (int k = 0; k < RC_KIN_PARTS; k++) {
    int here = source->part[k], across = source->part[target->across[k]];
    int both = here < across ? here : across;
    if (both > most) most = both;
  }
  return (float)most / 255;
}

/* Of every n-th source and target pixel. */
static bool are_several(const rc_kin *f) {
  rc_likeness source[MOST_EACH];
  rc_nearness target[MOST_EACH];
  int width = f->flags->width, height = f->flags->height, sources = 0, targets = 0, foreign = 0;
  int all[2] = {0, 0}, seen[2] = {0, 0};
  for (int i = 0; i < width * height; i++) {
    all[0] += f->flags->data[i] & RC_SOURCE ? 1 : 0;
    all[1] += f->flags->data[i] & RC_TARGET ? 1 : 0;
  }
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      uint8_t flag = *rc_flag(f->flags, x, y);
      if (flag & RC_SOURCE && seen[0]++ % (all[0] / MOST_EACH + 1) == 0)
        source[sources++] = rc_likeness_at(f, x, y);
      if (flag & RC_TARGET && seen[1]++ % (all[1] / MOST_EACH + 1) == 0)
        target[targets++] = rc_nearness_at(f, x, y);
    }
  for (int i = 0; i < sources; i++)
    for (int k = 0; k < targets; k++) foreign += usual_share(&source[i], &target[k]) < FOREIGN;
  return foreign >= LEAST_FOREIGN * sources * targets;
}

recede_status rc_kin_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                          int levels, rc_kin *kin, bool *told) {
  const rc_mask *coarsest = &flags[levels - 1];
  rc_material *materials;
  *told = false;
  RC_TRY(RC_NEW(context, (size_t)coarsest->width * (size_t)coarsest->height, &materials));
  RC_TRY(rc_materials_find(context, images, flags, levels, HALF_PX, materials));
  *kin = (rc_kin){.flags = coarsest, .materials = materials};
  RC_TRY(take_samples(context, kin));
  float most = own_spread(kin, 0, kin->count, LEAST_SAMPLES);
  if (!isfinite(most)) return RECEDE_OK;
  divide(kin);
  order_by_part(kin);
  for (int k = 0; k < RC_KIN_PARTS; k++) {
    float own = own_spread(kin, kin->first[k], kin->first[k + 1], 1);
    kin->most[k] = fminf(most, fmaxf(own, OF_A_TEXTURE));
  }
  compare_parts(kin);
  *told = are_several(kin);
  return rc_poll(context);
}

float rc_kinship(const rc_likeness *source, const rc_nearness *target) {
  float share = target->unit > 0 ? usual_share(source, target) : ENOUGH;
  if (share < ENOUGH) share += OF_CROSSING * crossing_share(source, target);
  return fminf(share / ENOUGH, 1);
}
