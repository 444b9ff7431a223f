/* Local power spectra by windowed Fourier transforms on a pyramid: every octave is read with the
 * same window at the level where it lies between .18 and .36 cycles/px. What the picture's pixels
 * and the pyramid's filter do to each frequency is divided out exactly: left in, it would be a
 * pattern fixed to the picture, and the estimate would lean towards frontal by half. */
#include "plane/spectra.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "plane/approximate.h"
#include "plane/fft.h"

#define LEVELS RC_SPECTRA_OCTAVES
#define BANDS (RC_SPECTRA_PER_OCTAVE * RC_SPECTRA_DIRECTIONS)
/* Narrower windows blur the spectrum, wider ones the place: 24 and 32 px were worse by a quarter.
 */
#define WINDOW 48
/* Cells along the long side. */
#define CELLS 16
/* A window counts from this share of known weight on. */
#define WINDOW_KNOWN .75f
/* Power below four times that of rounding to 8 bits is noise. */
#define NOISE_FLOOR 5e-6f
/* Share of a cell's values that must be known. */
#define CELL_KNOWN .3f

/* One band's value is a weighted sum over few Fourier coefficients. */
typedef struct band {
  int first, count;
} band;

typedef struct tap {
  uint16_t at; /* in the transposed square */
  float weight;
} tap;

typedef struct level {
  int width, height, scale;
  float *gray;
  uint8_t *known;
} level;

typedef struct gather {
  rc_context *context;
  rc_fft fft;
  float window[WINDOW][WINDOW];
  level levels[LEVELS];
  int level_count, width, height, columns, rows;
  band bands[LEVELS][BANDS];
  tap *taps;
  rc_fft_square *squares; /* one a thread */
  float *sums;            /* a thread: [columns][BANDS] and [columns] counts */
  rc_spectrum *power;     /* all cells */
} gather;

/* -------------------------------------------------------------------------------- pyramid -- */

static recede_status new_level(rc_context *context, int width, int height, int scale, level *made) {
  *made = (level){width, height, scale, NULL, NULL};
  RC_TRY(RC_NEW_ZERO(context, (size_t)width * (size_t)height, &made->gray));
  return RC_NEW_ZERO(context, (size_t)width * (size_t)height, &made->known);
}

static void read_gray(const rc_image *image, const rc_mask *flags, level *to) {
  size_t pixels = (size_t)image->width * (size_t)image->height;
  for (size_t i = 0; i < pixels; i++) {
    if (!(flags->data[i] & RC_SOURCE)) continue;
    const float *pixel = image->data + i * (size_t)image->channels;
    float sum = 0;
    for (int k = 0; k < image->channels; k++) sum += pixel[k];
    to->gray[i] = sum / (float)image->channels;
    to->known[i] = 1;
  }
}

/* [1 3 3 1] / 8 each way over what is known; known where most of it is. */
static void halve_pixel(const level *from, const level *to, int x, int y) {
  static const float filter[4] = {.125f, .375f, .375f, .125f};
  float sum = 0, weight = 0;
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++) {
      int fx = 2 * x + i - 1, fy = 2 * y + j - 1;
      if (!rc_inside(from->width, from->height, fx, fy)) continue;
      size_t at = (size_t)fy * (size_t)from->width + (size_t)fx;
      if (!from->known[at]) continue;
      weight += filter[i] * filter[j];
      sum += filter[i] * filter[j] * from->gray[at];
    }
  size_t at = (size_t)y * (size_t)to->width + (size_t)x;
  to->known[at] = weight > .7f;
  to->gray[at] = weight > .7f ? sum / weight : 0;
}

static recede_status build_pyramid(gather *g, const rc_image *image, const rc_mask *flags) {
  RC_TRY(new_level(g->context, image->width, image->height, 1, &g->levels[0]));
  read_gray(image, flags, &g->levels[0]);
  for (g->level_count = 1; g->level_count < LEVELS; g->level_count++) {
    const level *from = &g->levels[g->level_count - 1];
    level *to = &g->levels[g->level_count];
    if (from->width / 2 < WINDOW || from->height / 2 < WINDOW) break;
    RC_TRY(new_level(g->context, from->width / 2, from->height / 2, from->scale * 2, to));
    for (int y = 0; y < to->height; y++) {
      for (int x = 0; x < to->width; x++) halve_pixel(from, to, x, y);
      RC_TRY(rc_poll(g->context));
    }
  }
  return RECEDE_OK;
}

/* ---------------------------------------------------------------------------------- bands -- */

static double sinc(double x) { return fabs(x) < 1e-9 ? 1 : sin(M_PI * x) / (M_PI * x); }

/* Power that a level keeps of frequency (fx, fy), in cycles per its own px: the picture's pixels
 * average over a square, each halving filters by cos^3(pi f) along both axes. */
static double kept_power(int level_index, double fx, double fy) {
  double kept = 1;
  for (int i = 1; i <= level_index; i++) {
    double cosines = cos(M_PI * fx / (1 << i)) * cos(M_PI * fy / (1 << i));
    kept *= cosines * cosines * cosines;
  }
  kept *= sinc(fx / (1 << level_index)) * sinc(fy / (1 << level_index));
  return kept * kept;
}

/* Half a step wide in both: neighbouring bands overlap. */
static double band_weight(int step, int direction, double fx, double fy) {
  double centre = RC_SPECTRA_HIGHEST / 2 * exp2((step + .5) / RC_SPECTRA_PER_OCTAVE);
  double dr = log2(hypot(fx, fy) / centre) * RC_SPECTRA_PER_OCTAVE;
  double dt = remainder(atan2(fy, fx) - direction * M_PI / RC_SPECTRA_DIRECTIONS, M_PI) *
              RC_SPECTRA_DIRECTIONS / M_PI;
  double exponent = .5 * (dr / .5 * (dr / .5) + dt / .6 * (dt / .6));
  return exponent < 6 ? exp(-exponent) : 0;
}

static int add_taps(int level_index, int step, int direction, tap *taps) {
  int side = RC_FFT_SIDE, count = 0;
  double sum = 0;
  for (int ky = -side / 2 + 1; ky < side / 2; ky++)
    for (int kx = -side / 2 + 1; kx < side / 2; kx++) {
      if (ky < 0 || (ky == 0 && kx <= 0)) continue;
      double fx = (double)kx / side, fy = (double)ky / side;
      double weight = band_weight(step, direction, fx, fy);
      if (weight == 0) continue;
      sum += weight;
      if (!taps) {
        count++;
        continue;
      }
      taps[count++] = (tap){(uint16_t)((kx + side) % side * side + ky),
                            (float)(weight / kept_power(level_index, fx, fy))};
    }
  for (int i = 0; taps && i < count; i++) taps[i].weight /= (float)sum;
  return count;
}

static recede_status make_bands(gather *g) {
  int total = 0, per_level = 0;
  for (int i = 0; i < BANDS; i++)
    per_level += add_taps(0, i / RC_SPECTRA_DIRECTIONS, i % RC_SPECTRA_DIRECTIONS, NULL);
  RC_TRY(RC_NEW(g->context, per_level * g->level_count, &g->taps));
  for (int l = 0; l < g->level_count; l++) {
    for (int i = 0; i < BANDS; i++) {
      int count =
          add_taps(l, i / RC_SPECTRA_DIRECTIONS, i % RC_SPECTRA_DIRECTIONS, g->taps + total);
      g->bands[l][i] = (band){total, count};
      total += count;
    }
    RC_TRY(rc_poll(g->context));
  }
  return RECEDE_OK;
}

static void make_window(gather *g) {
  for (int y = 0; y < WINDOW; y++)
    for (int x = 0; x < WINDOW; x++)
      g->window[y][x] = (float)((.5 - .5 * cos(2 * M_PI * (x + .5) / WINDOW)) *
                                (.5 - .5 * cos(2 * M_PI * (y + .5) / WINDOW)));
}

/* -------------------------------------------------------------------------------- windows -- */

/* Copies a window's pixels, less their mean, under the window; 0 where unknown. Returns the sum of
 * the squared weights, 0 when too little is known. */
static float load_window(const gather *g, const level *from, int x0, int y0,
                         float to[RC_FFT_SIDE][RC_FFT_SIDE]) {
  float sum = 0, weight = 0, square = 0;
  for (int y = 0; y < WINDOW; y++)
    for (int x = 0; x < WINDOW; x++) {
      size_t at = (size_t)(y0 + y) * (size_t)from->width + (size_t)(x0 + x);
      float w = from->known[at] ? g->window[y][x] : 0;
      weight += w;
      sum += w * from->gray[at];
      square += w * w;
    }
  if (weight < WINDOW_KNOWN * WINDOW * WINDOW / 4) return 0;
  float mean = sum / weight;
  for (int y = 0; y < WINDOW; y++)
    for (int x = 0; x < WINDOW; x++) {
      size_t at = (size_t)(y0 + y) * (size_t)from->width + (size_t)(x0 + x);
      to[y][x] = from->known[at] ? g->window[y][x] * (from->gray[at] - mean) : 0;
    }
  return square;
}

/* The window's pixels are real and so is nothing imaginary: F(-k) is F(k)'s conjugate. */
static void add_bands(const gather *g, int level_index, const rc_fft_square *square, float energy,
                      float *sums) {
  const float *re = square->re[0], *im = square->im[0];
  for (int i = 0; i < BANDS; i++) {
    band b = g->bands[level_index][i];
    float sum = 0;
    for (int k = b.first; k < b.first + b.count; k++) {
      int at = g->taps[k].at;
      sum += g->taps[k].weight * (re[at] * re[at] + im[at] * im[at]);
    }
    sums[i] += sum / energy;
  }
}

static int cell_of(int position, int window_scale, int length, int cells) {
  int middle = position * window_scale + WINDOW * window_scale / 2;
  int cell = (int)((int64_t)middle * cells / length);
  return cell < cells ? cell : cells - 1;
}

static void store_bands(const gather *g, int row, int level_index, const float *sums,
                        const float *counts) {
  const float density = (float)(1 << (2 * level_index)); /* power per px^2 of the picture */
  int first = (LEVELS - 1 - level_index) * RC_SPECTRA_PER_OCTAVE;
  for (int c = 0; c < g->columns; c++) {
    if (counts[c] == 0) continue;
    rc_spectrum *cell = &g->power[row * g->columns + c];
    for (int i = 0; i < BANDS; i++) {
      float power = sums[c * BANDS + i] / counts[c];
      if (power > NOISE_FLOOR)
        (*cell)[first + i / RC_SPECTRA_DIRECTIONS][i % RC_SPECTRA_DIRECTIONS] =
            rc_log2(power * density);
    }
  }
}

static void gather_level(const gather *g, int row, int level_index, int thread) {
  const level *from = &g->levels[level_index];
  rc_fft_square *square = &g->squares[thread];
  float *sums = g->sums + (size_t)thread * (size_t)g->columns * (BANDS + 1);
  float *counts = sums + (size_t)g->columns * BANDS;
  int stride = level_index ? WINDOW / 4 : WINDOW / 2; /* few windows fit the coarse levels */
  memset(sums, 0, (size_t)g->columns * (BANDS + 1) * sizeof *sums);
  for (int y = 0; y + WINDOW <= from->height; y += stride) {
    if (cell_of(y, from->scale, g->height, g->rows) != row) continue;
    for (int x = 0; x + WINDOW <= from->width; x += stride) {
      memset(square, 0, sizeof *square);
      float energy = load_window(g, from, x, y, square->re);
      if (energy == 0) continue;
      rc_fft_forward(&g->fft, square);
      int column = cell_of(x, from->scale, g->width, g->columns);
      add_bands(g, level_index, square, energy, sums + column * BANDS);
      counts[column]++;
    }
  }
  store_bands(g, row, level_index, sums, counts);
}

static void gather_row(void *user, int row, int thread) {
  const gather *g = user;
  for (int l = 0; l < g->level_count; l++) gather_level(g, row, l, thread);
}

/* ---------------------------------------------------------------------------------- cells -- */

static bool enough_known(rc_spectrum *cell) {
  int known = 0;
  for (int s = 0; s < RC_SPECTRA_STEPS; s++) {
    for (int t = 0; t < RC_SPECTRA_DIRECTIONS; t++) known += isfinite((*cell)[s][t]) ? 1 : 0;
    (*cell)[s][RC_SPECTRA_DIRECTIONS] = (*cell)[s][0];
  }
  return (float)known > CELL_KNOWN * RC_SPECTRA_STEPS * RC_SPECTRA_DIRECTIONS;
}

static void keep_known_cells(const gather *g, rc_spectra *spectra) {
  spectra->count = 0;
  for (int i = 0; i < g->columns * g->rows; i++) {
    if (!enough_known(&g->power[i])) continue;
    int to = spectra->count++;
    if (to != i) memcpy(&g->power[to], &g->power[i], sizeof g->power[0]);
    spectra->x[to] = ((float)(i % g->columns) + .5f) * (float)g->width / (float)g->columns - .5f;
    spectra->y[to] = ((float)(i / g->columns) + .5f) * (float)g->height / (float)g->rows - .5f;
  }
  spectra->power = g->power;
}

static int cells_along(int length, int longest) {
  int cells = (int)lrint((double)CELLS * length / longest);
  return cells < 4 ? 4 : cells;
}

static recede_status prepare(gather *g, const rc_image *image, const rc_mask *flags) {
  size_t threads = (size_t)g->context->threads;
  rc_fft_init(&g->fft);
  make_window(g);
  RC_TRY(build_pyramid(g, image, flags));
  RC_TRY(make_bands(g));
  RC_TRY(RC_NEW(g->context, threads, &g->squares));
  return RC_NEW(g->context, threads * (size_t)g->columns * (BANDS + 1), &g->sums);
}

recede_status rc_spectra_gather(rc_context *context, const rc_image *image, const rc_mask *flags,
                                rc_spectra *spectra) {
  int longest = image->width > image->height ? image->width : image->height;
  int columns = cells_along(image->width, longest), rows = cells_along(image->height, longest);
  size_t cells = (size_t)columns * (size_t)rows;
  gather *g;
  RC_TRY(RC_NEW(context, cells, &spectra->x));
  RC_TRY(RC_NEW(context, cells, &spectra->y));
  RC_TRY(RC_NEW(context, cells, &spectra->power));
  for (size_t i = 0; i < cells; i++)
    for (int s = 0; s < RC_SPECTRA_STEPS; s++)
      for (int t = 0; t <= RC_SPECTRA_DIRECTIONS; t++) spectra->power[i][s][t] = NAN;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, 1, &g));
  g->context = context;
  g->width = image->width, g->height = image->height;
  g->columns = columns, g->rows = rows;
  g->power = spectra->power;
  RC_TRY(prepare(g, image, flags));
  RC_TRY(rc_parallel(context, rows, gather_row, g));
  keep_known_cells(g, spectra);
  rc_release(context, mark);
  return RECEDE_OK;
}
