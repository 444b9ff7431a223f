#include "synthesis/search/traits.h"

#include <math.h>
#include <string.h>

#include "base/eigen.h"
#include "base/four.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "image/pyramid.h"

/* Detail is told by three numbers: how strong it is along the plane's two axes, and how much
 * stronger along one diagonal than the other. Of every finer level, all weighing the same. Copies
 * within the plane keep them. Raised ones keep the picture's axes instead, but upright things told
 * by those came out worse (order kept of strips .1 to .6 instead of .5 to .7). */
#define DETAILS 3
/* A colour's difference of 1 counts as much as detail's of .5. With more a parquet gets its squares
 * right more often, but other textures lose a point or two. */
#define WEIGHT_OF_DETAIL 2.f
/* Bytes span this many deviations of the first component to each side. */
#define DEVIATIONS 3.
/* With less, or with less of its own square, all is one colour and what differs is rounding. */
#define LEAST_VARIANCE 1e-18
#define LEAST_RELATIVE 1e-12
#define MOST_INPUTS (3 + DETAILS)
/* At the most: more say no more of what varies most. */
#define SAMPLES 50000
/* Half pixels made at once, each way, and the detail that takes. */
#define BLOCK_PX 32
#define SCRATCH_ROW (DETAILS * (2 * BLOCK_PX + 2))
#define SCRATCH (SCRATCH_ROW * (2 * BLOCK_PX + 2))

/* A level's detail, from that of the level before and what is lost between them. */
typedef struct pooling {
  const rc_image *image;
  const rc_mask *flags;
  const rc_image *before; /* data NULL: there is none */
  rc_chart chart;
  rc_image *pooled;
  rc_box half;    /* of pooled that is wanted; the rest is 0 */
  float *scratch; /* SCRATCH for each thread */
} pooling;

/* Of the columns from first to one beyond end, where there are any. */
static void brightness_row(const pooling *p, int y, int first, int end, float *bright) {
  if (y == p->image->height) return;
  for (int x = first; x <= end && x < p->image->width; x++)
    bright[x - first] = rc_brightness_at(p->image, x, y);
}

/* To here from the pixel before, 0 where that is not known. */
static float difference_before(const pooling *p, int x, int y, int dx, int dy, float here) {
  if (x < dx || y < dy || !(*rc_flag(p->flags, x - dx, y - dy) & RC_KNOWN)) return 0;
  return here - rc_brightness_at(p->image, x - dx, y - dy);
}

/* Of the columns from first to before end, from the brightness of the row and of the next. Differs
 * to the next pixel, or where that is not known from the one before. */
static void detail_row(const pooling *p, int y, int first, int end, const float *bright,
                       const float *below, float *row) {
  const rc_chart *chart = &p->chart;
  const uint8_t *flags = rc_flag(p->flags, 0, y), *next = flags + p->flags->width;
  int width = p->image->width;
  bool last = y + 1 == p->image->height;
  float at_y = (float)y - chart->y0;
  for (int x = first; x < end; x++, bright++, below++) {
    float *detail = row + DETAILS * (x - first), at_x = (float)x - chart->x0;
    if (!(flags[x] & RC_KNOWN)) continue; /* nobody looks */
    float gx = x + 1 < width && flags[x + 1] & RC_KNOWN
                   ? bright[1] - bright[0]
                   : difference_before(p, x, y, 1, 0, bright[0]);
    float gy = !last && next[x] & RC_KNOWN ? below[0] - bright[0]
                                           : difference_before(p, x, y, 0, 1, bright[0]);
    float outward = at_x * gx + at_y * gy;
    float along_x = gx + chart->lx * outward, along_y = gy + chart->ly * outward;
    detail[0] = fabsf(along_x), detail[1] = fabsf(along_y);
    detail[2] = .7071f * (fabsf(along_x + along_y) - fabsf(along_x - along_y));
    if (!p->before->data) continue;
    const float *before = rc_pixel(p->before, x, y);
    for (int k = 0; k < DETAILS; k++) detail[k] += before[k];
  }
}

static void pool_block(void *user, int item, int thread) {
  const pooling *p = user;
  int width = p->image->width, height = p->image->height, columns = p->half.x1 - p->half.x0;
  int across = (columns + BLOCK_PX - 1) / BLOCK_PX;
  int x0 = p->half.x0 + item % across * BLOCK_PX, y0 = p->half.y0 + item / across * BLOCK_PX;
  int x1 = x0 + BLOCK_PX < p->half.x1 ? x0 + BLOCK_PX : p->half.x1;
  int y1 = y0 + BLOCK_PX < p->half.y1 ? y0 + BLOCK_PX : p->half.y1;
  rc_box from = {rc_half_from(x0, 0, width), rc_half_from(y0, 0, height),
                 rc_half_from(x1 - 1, 3, width) + 1, rc_half_from(y1 - 1, 3, height) + 1};
  float *scratch = p->scratch + (size_t)thread * SCRATCH;
  float bright[2][2 * BLOCK_PX + 3];
  brightness_row(p, from.y0, from.x0, from.x1, bright[from.y0 & 1]);
  for (int y = from.y0; y < from.y1; y++) {
    brightness_row(p, y + 1, from.x0, from.x1, bright[(y + 1) & 1]);
    detail_row(p, y, from.x0, from.x1, bright[y & 1], bright[(y + 1) & 1],
               scratch + (y - from.y0) * SCRATCH_ROW);
  }
  for (int y = y0; y < y1; y++) {
    const float *rows[4];
    const uint8_t *flags[4];
    for (int j = 0; j < 4; j++) {
      int row = rc_half_from(y, j, height);
      rows[j] = scratch + (row - from.y0) * SCRATCH_ROW, flags[j] = rc_flag(p->flags, 0, row);
    }
    for (int x = x0; x < x1; x++)
      rc_half_pixel(rows, from.x0, flags, width, DETAILS, x, rc_pixel(p->pooled, x, y));
  }
}

/* What may be compared at any level, in px of the finest: the sources, the target and some more,
 * for a coarse pixel's detail is that of many fine ones, and a patch reaches over the border. */
static rc_box box_that_matters(const rc_mask *flags, int levels) {
  rc_box box = rc_box_of(flags, RC_SOURCE | RC_TARGET);
  int around = (RC_PATCH_RADIUS + 2) << (levels - 1);
  box.x0 = box.x0 > around ? box.x0 - around : 0;
  box.y0 = box.y0 > around ? box.y0 - around : 0;
  box.x1 = box.x1 < flags->width - around ? box.x1 + around : flags->width;
  box.y1 = box.y1 < flags->height - around ? box.y1 + around : flags->height;
  return box;
}

static rc_box half_of(rc_box box) {
  return (rc_box){box.x0 / 2, box.y0 / 2, (box.x1 + 1) / 2, (box.y1 + 1) / 2};
}

static recede_status pool(rc_context *context, pooling *p) {
  int columns = p->half.x1 - p->half.x0, rows = p->half.y1 - p->half.y0;
  int blocks = (columns + BLOCK_PX - 1) / BLOCK_PX * ((rows + BLOCK_PX - 1) / BLOCK_PX);
  return rc_parallel(context, blocks, pool_block, p);
}

/* The inputs of a level and their principal axes. */
typedef struct projection {
  const rc_image *image, *detail;
  const rc_mask *flags;
  rc_box box;
  int inputs;
  double mean[MOST_INPUTS], covariance[MOST_INPUTS * MOST_INPUTS];
  /* A component's byte is the sum of the inputs, each times its weight, and the offset. */
  rc_four weights[MOST_INPUTS], offset;
  rc_traits *traits;
} projection;

/* Grey counts as three equal colours do. */
static float weight_of_colour(const projection *p) {
  return p->image->channels == 1 ? 1.7320508f : 1.f;
}

static void inputs_at(const projection *p, int x, int y, float *inputs) {
  const float *colour = rc_pixel(p->image, x, y), *detail = rc_pixel(p->detail, x, y);
  int colours = p->image->channels;
  for (int k = 0; k < colours; k++) inputs[k] = weight_of_colour(p) * colour[k];
  for (int k = 0; k < DETAILS; k++) inputs[colours + k] = WEIGHT_OF_DETAIL * detail[k];
}

/* One of every so many sources, at random: regular steps would fall in with a texture's own. */
static int take_samples(const projection *p, int32_t *samples) {
  int sources = 0, taken = 0, run = 0, chosen = 0;
  for (int y = p->box.y0; y < p->box.y1; y++) {
    const uint8_t *flags = rc_flag(p->flags, 0, y);
    for (int x = p->box.x0; x < p->box.x1; x++) sources += flags[x] & RC_SOURCE ? 1 : 0;
  }
  int step = sources / SAMPLES + 1, n = step; /* of its run; the first begins with the first */
  for (int y = p->box.y0; y < p->box.y1; y++) {
    const uint8_t *flags = rc_flag(p->flags, 0, y);
    for (int x = p->box.x0; x < p->box.x1; x++) {
      if (!(flags[x] & RC_SOURCE)) continue;
      if (n == step) {
        int left = sources - run * step, last = left < step ? left : step;
        chosen = (int)rc_below((uint32_t)rc_mix((uint64_t)run), (uint32_t)last);
        run++, n = 0;
      }
      if (n++ == chosen) samples[taken++] = y * p->flags->width + x;
    }
  }
  return taken;
}

static void set_covariance(projection *p, const int32_t *samples, int count) {
  int n = p->inputs, width = p->flags->width;
  float inputs[MOST_INPUTS];
  double off[MOST_INPUTS];
  for (int s = 0; s < count; s++) {
    inputs_at(p, samples[s] % width, samples[s] / width, inputs);
    for (int i = 0; i < n; i++) p->mean[i] += (double)inputs[i] / count;
  }
  for (int s = 0; s < count; s++) {
    inputs_at(p, samples[s] % width, samples[s] / width, inputs);
    for (int i = 0; i < n; i++) off[i] = (double)inputs[i] - p->mean[i];
    for (int i = 0; i < n; i++)
      for (int j = 0; j < n; j++) p->covariance[i * n + j] += off[i] * off[j] / count;
  }
}

static recede_status find_components(rc_context *context, projection *p) {
  int n = p->inputs;
  double values[MOST_INPUTS], axes[MOST_INPUTS * MOST_INPUTS]; /* the k-th in column k */
  int32_t *samples;
  RC_TRY(RC_NEW(context, SAMPLES, &samples));
  set_covariance(p, samples, take_samples(p, samples));
  RC_FREE(context, &samples);
  RC_TRY(rc_eigen(context, p->covariance, n, n, values, axes));
  double square = 0;
  for (int i = 0; i < n; i++) square += p->mean[i] * p->mean[i];
  bool even = values[0] < LEAST_VARIANCE + LEAST_RELATIVE * square;
  double gain = even ? 1 : 127 / (DEVIATIONS * sqrt(values[0]));
  for (int k = 0; k < RC_COMPONENTS; k++) {
    double offset = 128.5;
    for (int i = 0; i < n; i++) {
      p->weights[i][k] = (float)(gain * axes[i * n + k]);
      offset -= gain * axes[i * n + k] * p->mean[i];
    }
    p->offset[k] = (float)offset;
    for (int i = 0; i < 3; i++) {
      int colour = p->image->channels == 1 ? 0 : i;
      p->traits->colours[k][i] = (float)axes[colour * n + k] / weight_of_colour(p);
    }
  }
  return RECEDE_OK;
}

static void project_row(void *user, int row, int thread) {
  const projection *p = user;
  int y = p->box.y0 + row;
  uint32_t *pixels = p->traits->pixels + (size_t)y * (size_t)p->image->width;
  const rc_four least = {0.f}, most = {255.f, 255.f, 255.f, 255.f};
  float inputs[MOST_INPUTS];
  (void)thread;
  for (int x = p->box.x0; x < p->box.x1; x++) {
    rc_four bytes = p->offset;
    inputs_at(p, x, y, inputs);
    for (int i = 0; i < p->inputs; i++) bytes += p->weights[i] * inputs[i];
    bytes = rc_select(bytes > least, bytes, least);
    bytes = rc_select(bytes < most, bytes, most);
    rc_four_words whole = (rc_four_words) __builtin_convertvector(bytes, rc_four_ints);
    pixels[x] = whole[0] | whole[1] << 8 | whole[2] << 16 | whole[3] << 24;
  }
}

recede_status rc_traits_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                             int levels, const rc_chart *chart, rc_traits *traits) {
  rc_image before = {0}, detail;
  float *scratch;
  for (int n = 1; n < levels; n++)
    RC_TRY(RC_NEW_ZERO(context, (size_t)images[n].width * (size_t)images[n].height,
                       &traits[n].pixels));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)context->threads * SCRATCH, &scratch));
  rc_box box = levels > 1 ? box_that_matters(flags, levels) : (rc_box){0, 0, 0, 0};
  for (int n = 1; n < levels; n++) {
    box = half_of(box);
    RC_TRY(rc_image_new(context, images[n].width, images[n].height, DETAILS, &detail));
    rc_chart finer = rc_chart_coarser(*chart, n - 1);
    pooling p = {&images[n - 1], &flags[n - 1], &before, finer, &detail, box, scratch};
    RC_TRY(pool(context, &p));
    projection q = {.image = &images[n], .detail = &detail, .flags = &flags[n], .box = box};
    q.inputs = images[n].channels + DETAILS, q.traits = &traits[n];
    RC_TRY(find_components(context, &q));
    RC_TRY(rc_parallel(context, box.y1 - box.y0, project_row, &q));
    before = detail;
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
