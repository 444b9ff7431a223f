/* Every patch distance against the reference, its pixels between guard pages; --bench times them.
 */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/random.h"
#include "kernels/kernels.h"

#define CASES 6000
#define MOST_KERNELS 16
#define KEY 20140610u

/* Pixels with a page before and after them that may not be touched. */
typedef struct guarded {
  unsigned char *map, *inside;
  size_t map_bytes, bytes;
} guarded;

static guarded guarded_new(size_t bytes) {
  size_t page = (size_t)sysconf(_SC_PAGESIZE), rounded = (bytes + page - 1) / page * page;
  guarded g = {.map_bytes = rounded + 2 * page, .bytes = rounded};
  g.map = mmap(NULL, g.map_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (g.map == MAP_FAILED) exit(1);
  g.inside = g.map + page;
  if (mprotect(g.map, page, PROT_NONE) || mprotect(g.inside + rounded, page, PROT_NONE)) exit(1);
  return g;
}

static uint32_t draw(uint32_t item, uint32_t n) { return (uint32_t)rc_random(KEY, item, n, 0); }

/* What a test of a kernel is about: a patch, where its candidate lies, and the pixels that takes.
 */
typedef struct trial {
  rc_patch patch;
  rc_footprint footprint;
  int left, top, width, height; /* the box of the footprint's pixels, relative to its origin */
} trial;

/* Every tenth patch is as far from its pixels as can be: the largest sum. */
static bool is_extreme(uint32_t item) { return item % 10 == 0; }

static void fill_patch(uint32_t item, rc_patch *patch) {
  bool extreme = is_extreme(item);
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    uint32_t bits = draw(item, 100u + (uint32_t)i);
    bool padding = i % RC_PATCH_CHUNK >= RC_PATCH_PIXELS / 3;
    patch->pixel[i] = extreme ? UINT32_MAX : bits;
    bits = draw(item, 300u + (uint32_t)i);
    int16_t weight = extreme ? RC_WEIGHT_ONE : (int16_t)(bits % (RC_WEIGHT_ONE + 1));
    for (int k = 0; k < RC_COMPONENTS; k++) patch->weight[i][k] = padding ? 0 : weight;
  }
}

/* A Jacobian's term: mostly near the identity, at times anything. */
static int32_t term(uint32_t item, uint32_t n, int32_t middle) {
  int32_t spread = item % 3 == 0 ? 4 * 65536 : item % 3 == 1 ? 20000 : 0;
  return middle + (spread ? (int32_t)(draw(item, n) % (2u * (uint32_t)spread)) - spread : 0);
}

static void find_box(trial *t) {
  const rc_footprint *f = &t->footprint;
  int right = -(1 << 20), bottom = -(1 << 20);
  t->left = t->top = 1 << 20;
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    int x = (f->x + f->xx * rc_lane_x[i] + f->xy * rc_lane_y[i]) >> 16;
    int y = (f->y + f->yx * rc_lane_x[i] + f->yy * rc_lane_y[i]) >> 16;
    t->left = x < t->left ? x : t->left;
    t->top = y < t->top ? y : t->top;
    right = x > right ? x : right;
    bottom = y > bottom ? y : bottom;
  }
  t->width = right - t->left + 1;
  t->height = bottom - t->top + 1;
}

static void trial_make(uint32_t item, trial *t) {
  rc_footprint *f = &t->footprint;
  fill_patch(item, &t->patch);
  f->x = (int32_t)(draw(item, 1) % 65536u) + 32768;
  f->y = (int32_t)(draw(item, 2) % 65536u) + 32768;
  f->xx = term(item, 3, 65536), f->xy = term(item, 4, 0);
  f->yx = term(item, 5, 0), f->yy = term(item, 6, 65536);
  find_box(t);
  f->stride = t->width + (int32_t)(draw(item, 7) % 4u);
}

/* The picture ends where the footprint ends: at_end, its last pixel is the last before the guard;
 * else its first is the first after it. */
static void place(uint32_t item, const guarded *g, bool at_end, trial *t) {
  size_t stride = (size_t)t->footprint.stride;
  size_t count = stride * (size_t)(t->height - 1) + (size_t)t->width;
  uint32_t *pixels = (uint32_t *)(void *)g->inside;
  if (at_end) pixels += g->bytes / sizeof *pixels - count;
  for (size_t i = 0; i < count; i++)
    pixels[i] = is_extreme(item) ? 0 : draw(item, 1000u + (uint32_t)i);
  t->footprint.origin = pixels - (ptrdiff_t)t->top * t->footprint.stride - t->left;
}

static bool keeps_limit(const rc_kernels *k, const trial *t, uint32_t exact, uint32_t limit) {
  uint32_t got = k->distance(&t->patch, &t->footprint, limit);
  if (exact < limit ? got == exact : got >= limit && got <= exact) return true;
  printf("# %s: %u with limit %u, the reference says %u\n", k->name, got, limit, exact);
  return false;
}

static bool check_trial(const rc_kernels *k, uint32_t item, const trial *t) {
  uint32_t exact = rc_kernels_reference.distance(&t->patch, &t->footprint, UINT32_MAX);
  uint32_t below = exact ? draw(item, 8) % exact : 0;
  return keeps_limit(k, t, exact, UINT32_MAX) && keeps_limit(k, t, exact, exact + 1) &&
         keeps_limit(k, t, exact, exact) && keeps_limit(k, t, exact, below) &&
         keeps_limit(k, t, exact, 0);
}

static bool check_kernel(const rc_kernels *k, const guarded *g) {
  trial t;
  for (uint32_t item = 0; item < CASES; item++) {
    trial_make(item, &t);
    place(item, g, item & 1, &t);
    if (!check_trial(k, item, &t)) return false;
  }
  return true;
}

/* The sum of an extreme patch is known without any kernel. */
static bool largest_sum(const guarded *g) {
  trial t;
  trial_make(0, &t);
  place(0, g, true, &t);
  return rc_kernels_reference.distance(&t.patch, &t.footprint, UINT32_MAX) ==
         255u * 255u * RC_COMPONENTS * RC_WEIGHT_ONE * RC_PATCH_PIXELS;
}

/* Every pixel of a patch is in exactly one lane that is no padding. */
static bool lanes_cover_the_patch(void) {
  int seen[RC_PATCH_PIXELS] = {0}, count = 0;
  for (int i = 0; i < RC_PATCH_LANES; i++) {
    if (i % RC_PATCH_CHUNK >= RC_PATCH_PIXELS / 3) continue;
    int x = rc_lane_x[i] + RC_PATCH_RADIUS, y = rc_lane_y[i] + RC_PATCH_RADIUS;
    if (x < 0 || y < 0 || x >= RC_PATCH_WIDTH || y >= RC_PATCH_WIDTH) return false;
    count += !seen[y * RC_PATCH_WIDTH + x]++;
  }
  return count == RC_PATCH_PIXELS;
}

/* The guards must stop a child that reads one byte too far. */
static bool guard_stops(const guarded *g, ptrdiff_t offset) {
  fflush(stdout);
  pid_t child = fork();
  if (child == 0) {
    if (!freopen("/dev/null", "w", stderr)) _exit(0);
    _exit(*(volatile unsigned char *)(g->inside + offset) & 0);
  }
  int status = 0;
  return waitpid(child, &status, 0) == child && !(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The least of several runs: the machine is shared. */
static double nanoseconds(const rc_kernels *k, const trial *trials, int count) {
  double best = 1e9;
  uint32_t sum = 0;
  for (int run = 0; run < 7; run++) {
    double start = seconds();
    for (int n = 0; n < 40; n++)
      for (int i = 0; i < count; i++)
        sum += k->distance(&trials[i].patch, &trials[i].footprint, UINT32_MAX);
    double took = (seconds() - start) / 40 / count * 1e9;
    best = took < best ? took : best;
  }
  return sum == 1 ? 0 : best;
}

/* Footprints near the identity, all over one picture of 512 x 512. */
static int bench(void) {
  enum { count = 500, edge = 512 };
  trial *trials = malloc(count * sizeof *trials);
  uint32_t *pixels = malloc(sizeof *pixels * edge * edge);
  if (!trials || !pixels) return 1;
  for (uint32_t i = 0; i < edge * edge; i++) pixels[i] = draw(i, 0) & 0xffffff;
  for (uint32_t i = 0; i < count; i++) {
    trial_make(10 * 3 * i + 1, &trials[i]);
    trials[i].footprint.stride = edge;
    trials[i].footprint.origin =
        pixels + (64 + draw(i, 50) % (edge - 128)) * edge + 64 + draw(i, 51) % (edge - 128);
  }
  double reference = nanoseconds(&rc_kernels_reference, trials, count);
  for (int i = 0; i < MOST_KERNELS; i++) {
    const rc_kernels *k = rc_kernels_select(i);
    if (!k) continue;
    double took = i ? nanoseconds(k, trials, count) : reference;
    printf("%-10s %7.1f ns a patch, %.2f x the reference's speed\n", k->name, took,
           reference / took);
  }
  free(trials);
  free(pixels);
  return 0;
}

static int tests;

static int say(bool passed, const char *name) {
  printf("%s %d - %s\n", passed ? "ok" : "not ok", ++tests, name);
  return !passed;
}

int main(int argc, char **argv) {
  if (argc > 1 && strcmp(argv[1], "--bench") == 0) return bench();
  /* A Jacobian's terms stay within 5: 4 (5 + 5) px to each side and the fraction. */
  guarded g = guarded_new(90 * 100 * sizeof(uint32_t));
  int failed = 0;
  failed += say(guard_stops(&g, -1) && guard_stops(&g, (ptrdiff_t)g.bytes), "guards");
  failed += say(!guard_stops(&g, 0), "inside the guards");
  failed += say(lanes_cover_the_patch(), "lanes");
  failed += say(largest_sum(&g), "largest sum");
  failed += say(rc_kernels_select(-1) != NULL && rc_kernels_select(MOST_KERNELS) == NULL &&
                    rc_kernels_select(0) == &rc_kernels_reference,
                "selection");
  for (int i = 0; i < MOST_KERNELS; i++) {
    const rc_kernels *k = rc_kernels_select(i);
    if (k) failed += say(check_kernel(k, &g), k->name);
  }
  printf("1..%d\n", tests);
  munmap(g.map, g.map_bytes);
  return failed != 0;
}
