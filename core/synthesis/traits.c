#include "synthesis/traits.h"

#include <math.h>
#include <string.h>

#include "base/eigen.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "image/pyramid.h"

/* Detail is told by three numbers: how strong it is along the plane's two axes, which copies within
 * the plane keep, and how much stronger along one diagonal than the other. Of every finer level,
 * all weighing the same. */
#define DETAILS 3
/* A colour's difference of 1 counts as much as detail's of .5. With 1 fewer squares of parquet get
 * their strips right, with 3 the real textures lose a point or two. */
#define WEIGHT_OF_DETAIL 2.f
/* Bytes span this many deviations of the first component to each side. */
#define DEVIATIONS 3.
#define MOST_INPUTS (3 + DETAILS)
/* More say no more of what varies most. */
#define SAMPLES 50000
/* Half pixels made at once, and the detail that takes. */
#define STRIP_PX 256
#define SCRATCH (4 * DETAILS * (2 * STRIP_PX + 2))

/* A level's detail, from that of the level before and what is lost between them. */
typedef struct pooling {
  const rc_image *image;
  const rc_mask *flags;
  const rc_image *before; /* data NULL: there is none */
  rc_chart chart;
  rc_image *pooled;
  int strips;     /* of each row */
  float *scratch; /* SCRATCH for each thread */
} pooling;

/* To the next pixel, or where that is not known from the one before; else 0. */
static float difference(const pooling *p, int x, int y, int dx, int dy) {
  const rc_image *image = p->image;
  for (int sign = 1; sign >= -1; sign -= 2) {
    int nx = x + sign * dx, ny = y + sign * dy;
    if (rc_inside(image->width, image->height, nx, ny) && *rc_flag(p->flags, nx, ny) & RC_KNOWN)
      return (float)sign * (rc_brightness_at(image, nx, ny) - rc_brightness_at(image, x, y));
  }
  return 0;
}

/* Of the columns from first to before end. */
static void detail_row(const pooling *p, int y, int first, int end, float *row) {
  const rc_chart *chart = &p->chart;
  const uint8_t *flags = rc_flag(p->flags, 0, y);
  float at_y = (float)y - chart->y0;
  for (int x = first; x < end; x++) {
    float *detail = row + DETAILS * (x - first), at_x = (float)x - chart->x0;
    if (!(flags[x] & RC_KNOWN)) continue; /* nobody looks */
    float gx = difference(p, x, y, 1, 0), gy = difference(p, x, y, 0, 1);
    float outward = at_x * gx + at_y * gy;
    float along_x = gx + chart->lx * outward, along_y = gy + chart->ly * outward;
    detail[0] = fabsf(along_x), detail[1] = fabsf(along_y);
    detail[2] = .7071f * (fabsf(along_x + along_y) - fabsf(along_x - along_y));
    if (!p->before->data) continue;
    const float *before = rc_pixel(p->before, x, y);
    for (int k = 0; k < DETAILS; k++) detail[k] += before[k];
  }
}

static void pool_strip(void *user, int item, int thread) {
  const pooling *p = user;
  int width = p->image->width, y = item / p->strips, x0 = item % p->strips * STRIP_PX;
  int x1 = x0 + STRIP_PX < p->pooled->width ? x0 + STRIP_PX : p->pooled->width;
  int first = rc_half_from(x0, 0, width), end = rc_half_from(x1 - 1, 3, width) + 1;
  float *scratch = p->scratch + (size_t)thread * SCRATCH;
  const float *rows[4];
  const uint8_t *flags[4];
  for (int j = 0; j < 4; j++) {
    int from = rc_half_from(y, j, p->image->height);
    float *row = scratch + j * SCRATCH / 4;
    detail_row(p, from, first, end, row);
    rows[j] = row, flags[j] = rc_flag(p->flags, 0, from);
  }
  for (int x = x0; x < x1; x++)
    rc_half_pixel(rows, first, flags, width, DETAILS, x, rc_pixel(p->pooled, x, y));
}

/* The inputs of a level and their principal axes. */
typedef struct projection {
  const rc_image *image, *detail;
  const rc_mask *flags;
  int inputs;
  double mean[MOST_INPUTS], covariance[MOST_INPUTS * MOST_INPUTS];
  double axes[MOST_INPUTS * MOST_INPUTS]; /* the i-th in column i */
  double gain;
  rc_traits *traits;
} projection;

/* Grey counts as three equal colours do. */
static double weight_of_colour(const projection *p) {
  return p->image->channels == 1 ? sqrt(3) : 1;
}

static void inputs_at(const projection *p, int x, int y, double *inputs) {
  const float *colour = rc_pixel(p->image, x, y), *detail = rc_pixel(p->detail, x, y);
  int colours = p->image->channels;
  for (int k = 0; k < colours; k++) inputs[k] = weight_of_colour(p) * (double)colour[k];
  for (int k = 0; k < DETAILS; k++) inputs[colours + k] = (double)(WEIGHT_OF_DETAIL * detail[k]);
}

/* Of every so many sources. */
static void measure(projection *p) {
  int n = p->inputs, pixels = p->image->width * p->image->height, sources = 0;
  int step = pixels / SAMPLES + 1;
  double count = 0, inputs[MOST_INPUTS];
  for (int at = 0; at < pixels; at++) {
    if (!(p->flags->data[at] & RC_SOURCE) || sources++ % step) continue;
    inputs_at(p, at % p->image->width, at / p->image->width, inputs);
    for (int i = 0; i < n; i++) {
      p->mean[i] += inputs[i];
      for (int j = 0; j < n; j++) p->covariance[i * n + j] += inputs[i] * inputs[j];
    }
    count++;
  }
  for (int i = 0; i < n && count > 0; i++) p->mean[i] /= count;
  for (int i = 0; i < n && count > 0; i++)
    for (int j = 0; j < n; j++)
      p->covariance[i * n + j] = p->covariance[i * n + j] / count - p->mean[i] * p->mean[j];
}

static void project_row(void *user, int y, int thread) {
  const projection *p = user;
  int n = p->inputs;
  double inputs[MOST_INPUTS];
  uint32_t *pixels = p->traits->pixels + (size_t)y * (size_t)p->image->width;
  (void)thread;
  for (int x = 0; x < p->image->width; x++) {
    pixels[x] = 0;
    inputs_at(p, x, y, inputs);
    for (int k = 0; k < RC_COMPONENTS; k++) {
      double sum = 0;
      for (int i = 0; i < n; i++) sum += p->axes[i * n + k] * (inputs[i] - p->mean[i]);
      double byte = fmin(fmax(sum * p->gain + 128.5, 0), 255);
      pixels[x] |= (uint32_t)byte << 8 * k;
    }
  }
}

static recede_status project(rc_context *context, const rc_image *image, const rc_mask *flags,
                             const rc_image *detail, rc_traits *traits) {
  projection p = {.image = image, .detail = detail, .flags = flags, .traits = traits};
  double values[MOST_INPUTS];
  p.inputs = image->channels + DETAILS;
  measure(&p);
  RC_TRY(rc_eigen(context, p.covariance, p.inputs, p.inputs, values, p.axes));
  p.gain = values[0] > 1e-18 ? 127 / (DEVIATIONS * sqrt(values[0])) : 1;
  for (int k = 0; k < RC_COMPONENTS; k++)
    for (int i = 0; i < 3; i++) {
      int colour = image->channels == 1 ? 0 : i;
      traits->colours[k][i] = (float)(p.axes[colour * p.inputs + k] / weight_of_colour(&p));
    }
  return rc_parallel(context, image->height, project_row, &p);
}

recede_status rc_traits_find(rc_context *context, const rc_image *images, const rc_mask *flags,
                             int levels, const rc_chart *chart, rc_traits *traits) {
  rc_image before = {0}, detail;
  float *scratch;
  for (int n = 1; n < levels; n++)
    RC_TRY(RC_NEW(context, (size_t)images[n].width * (size_t)images[n].height, &traits[n].pixels));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, (size_t)context->threads * SCRATCH, &scratch));
  for (int n = 1; n < levels; n++) {
    int strips = (images[n].width + STRIP_PX - 1) / STRIP_PX;
    RC_TRY(rc_image_new(context, images[n].width, images[n].height, DETAILS, &detail));
    rc_chart finer = rc_chart_coarser(*chart, n - 1);
    pooling p = {&images[n - 1], &flags[n - 1], &before, finer, &detail, strips, scratch};
    RC_TRY(rc_parallel(context, detail.height * strips, pool_strip, &p));
    RC_TRY(project(context, &images[n], &flags[n], &detail, &traits[n]));
    before = detail;
  }
  rc_release(context, mark);
  return RECEDE_OK;
}
