/* The steps of the paper's synthesis, each against a slow, obvious reference. They cannot be
 * reached one by one through recede.h, so their own headers are used. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "synthesis/paper/cluster_tree.h"
#include "synthesis/paper/level.h"
#include "synthesis/paper/neighbourhood.h"
#include "synthesis/paper/pca.h"
#include "synthesis/paper/scale_channel.h"
#include "synthesis/paper/update.h"

static rc_context *context_new(void) {
  recede_host host;
  rc_context *context = g_new0(rc_context, 1);
  recede_host_init(&host);
  host.threads = 2;
  rc_context_init(context, &host);
  return context;
}
static void context_free(rc_context *context) {
  rc_context_clear(context);
  g_free(context);
}
static float noise(GRand *random) { return (float)g_rand_double(random); }

/* ------------------------------------------------------------------------------ nearest z_p -- */

typedef struct set {
  float *vectors;
  int dims;
} set;
static const float *read_point(const void *user, int index, float *scratch) {
  const set *s = user;
  (void)scratch;
  return s->vectors + (size_t)index * (size_t)s->dims;
}
static int brute_force(const set *s, int count, const float *vector) {
  int best = 0;
  double least = HUGE_VAL;
  for (int i = 0; i < count; i++) {
    double sum = 0;
    for (int k = 0; k < s->dims; k++) {
      double d = (double)s->vectors[i * s->dims + k] - (double)vector[k];
      sum += d * d;
    }
    if (sum < least) least = sum, best = i;
  }
  return best;
}

/* Clusters, clusters of clusters, and queries a little off a member. */
static void tree_against_brute_force(void) {
  enum { CLUSTERS = 25, EACH = 80, DIMS = 24, QUERIES = 1000 };
  rc_context *context = context_new();
  GRand *random = g_rand_new_with_seed(7);
  set s = {g_new(float, CLUSTERS *EACH *DIMS), DIMS};
  float query[DIMS], scratch[DIMS], distance;
  int agreed = 0;
  for (int c = 0; c < CLUSTERS; c++) {
    float centre[DIMS];
    for (int k = 0; k < DIMS; k++) centre[k] = 10 * noise(random);
    for (int i = 0; i < EACH; i++)
      for (int k = 0; k < DIMS; k++)
        s.vectors[(c * EACH + i) * DIMS + k] = centre[k] + noise(random);
  }
  rc_points points = {&s, read_point, CLUSTERS * EACH, DIMS};
  rc_tree tree;
  g_assert_cmpint(rc_tree_build(context, &points, 4, 1, &tree), ==, RECEDE_OK);
  for (int q = 0; q < QUERIES; q++) {
    int of = g_rand_int_range(random, 0, CLUSTERS * EACH);
    for (int k = 0; k < DIMS; k++) query[k] = s.vectors[of * DIMS + k] + .2f * noise(random);
    agreed +=
        rc_tree_search(&tree, query, scratch, &distance) == brute_force(&s, CLUSTERS * EACH, query);
  }
  g_test_message("%d of %d queries agree", agreed, QUERIES);
  g_assert_cmpint(agreed, >=, QUERIES * 9 / 10);
  g_free(s.vectors);
  g_rand_free(random);
  context_free(context);
}

/* Every member is in one leaf, every leaf has fewer than k, no node of one child. */
static void tree_holds_all_members(void) {
  enum { COUNT = 3000, DIMS = 8 };
  rc_context *context = context_new();
  GRand *random = g_rand_new_with_seed(3);
  set s = {g_new(float, COUNT *DIMS), DIMS};
  int seen[COUNT] = {0};
  for (int i = 0; i < COUNT * DIMS; i++) s.vectors[i] = noise(random);
  rc_points points = {&s, read_point, COUNT, DIMS};
  rc_tree tree;
  g_assert_cmpint(rc_tree_build(context, &points, 4, 1, &tree), ==, RECEDE_OK);
  for (int n = 0; n < tree.node_count; n++) {
    const rc_tree_node *node = &tree.nodes[n];
    if (node->child) {
      g_assert_cmpint(node->children, >=, 2);
      continue;
    }
    g_assert_cmpint(node->end - node->first, <, 4);
    for (int i = node->first; i < node->end; i++) seen[tree.order[i]]++;
  }
  for (int i = 0; i < COUNT; i++) g_assert_cmpint(seen[i], ==, 1);
  g_free(s.vectors);
  g_rand_free(random);
  context_free(context);
}

/* ------------------------------------------------------------------------------------- PCA -- */

static void pca_keeps_the_variance(void) {
  enum { COUNT = 700, INPUTS = 50, FACTORS = 12 };
  rc_context *context = context_new();
  GRand *random = g_rand_new_with_seed(5);
  int stride = rc_padded(INPUTS);
  float *vectors = g_new0(float, COUNT *stride), mixing[FACTORS][INPUTS], reduced[INPUTS];
  for (int f = 0; f < FACTORS; f++)
    for (int k = 0; k < INPUTS; k++) mixing[f][k] = (noise(random) - .5f) / (float)(1 + f);
  for (int i = 0; i < COUNT; i++)
    for (int f = 0; f < FACTORS; f++) {
      float factor = noise(random);
      for (int k = 0; k < INPUTS; k++) vectors[i * stride + k] += factor * mixing[f][k];
    }
  rc_pca pca;
  g_assert_cmpint(rc_pca_find(context, vectors, COUNT, INPUTS, .95, &pca), ==, RECEDE_OK);
  g_assert_cmpint(pca.components, <, FACTORS);
  double all = 0, lost = 0;
  for (int i = 0; i < COUNT; i++) {
    rc_pca_project(&pca, vectors + i * stride, reduced);
    for (int k = 0; k < INPUTS; k++) {
      double value = (double)vectors[i * stride + k] - (double)pca.mean[k], rest = value;
      for (int c = 0; c < pca.components; c++)
        rest -= (double)reduced[c] * (double)pca.basis[c * pca.stride + k];
      all += value * value;
      lost += rest * rest;
    }
  }
  g_test_message("%d components keep %.4f", pca.components, 1 - lost / all);
  g_assert_cmpfloat(1 - lost / all, >=, .95);
  g_assert_cmpfloat(fabs(pca.kept - (1 - lost / all)), <, 1e-4);
  for (int a = 0; a < pca.components; a++)
    for (int b = 0; b <= a; b++) {
      double dot =
          (double)rc_dot(pca.basis + a * pca.stride, pca.basis + b * pca.stride, pca.stride);
      g_assert_cmpfloat(fabs(dot - (a == b)), <, 1e-4);
    }
  g_free(vectors);
  g_rand_free(random);
  context_free(context);
}

static void pca_of_equal_vectors(void) {
  enum { INPUTS = 12 };
  rc_context *context = context_new();
  float vectors[40][16] = {{0}}, reduced[INPUTS];
  rc_pca pca;
  for (int i = 0; i < 40; i++)
    for (int k = 0; k < INPUTS; k++) vectors[i][k] = .25f;
  g_assert_cmpint(rc_pca_find(context, vectors[0], 40, INPUTS, .95, &pca), ==, RECEDE_OK);
  g_assert_cmpint(pca.components, ==, 1);
  rc_pca_project(&pca, vectors[0], reduced);
  g_assert_cmpfloat(fabs((double)reduced[0]), <, 1e-6);
  context_free(context);
}

/* ------------------------------------------------------------------------ windows and start -- */

static rc_side side_new(rc_context *context, int width, int height, int channels, uint8_t flag) {
  rc_side side = {.scale = {0, 0, 1}};
  g_assert_cmpint(rc_image_new(context, width, height, channels, &side.image), ==, RECEDE_OK);
  g_assert_cmpint(rc_mask_new(context, width, height, &side.flags), ==, RECEDE_OK);
  memset(side.flags.data, flag, (size_t)width * (size_t)height);
  return side;
}

static void windows_lie_in_the_source(void) {
  rc_context *context = context_new();
  GRand *random = g_rand_new_with_seed(11);
  for (int width = 1; width <= 9; width += 4) {
    rc_side side = side_new(context, 37, 23, 1, RC_SOURCE);
    for (int i = 0; i < 8; i++) side.flags.data[g_rand_int_range(random, 0, 37 * 23)] = 0;
    rc_windows windows;
    size_t count = 0;
    g_assert_cmpint(rc_windows_find(context, &side.image, &side.flags, width, &windows), ==,
                    RECEDE_OK);
    for (int y = 0; y + width <= 23; y++)
      for (int x = 0; x + width <= 37; x++) {
        bool whole = true;
        for (int i = 0; i < width * width; i++)
          whole &= *rc_flag(&side.flags, x + i % width, y + i / width) == RC_SOURCE;
        g_assert_cmpint(rc_window_valid(&windows, x, y), ==, whole);
        count += whole;
      }
    g_assert_cmpuint(windows.count, ==, count);
    g_assert_false(rc_window_valid(&windows, 38 - width, 0));
  }
  g_rand_free(random);
  context_free(context);
}

/* The exemplar's pixels tell their own scale, so the output tells which was picked. */
static void start_picks_equal_scale(void) {
  recede_plane plane;
  rc_context *context = context_new();
  rc_paper_level level = {.colours = 1};
  g_assert_cmpint(recede_plane_from_angles(105, 105, 60, 20, 50, &plane), ==, RECEDE_OK);
  level.exemplar = side_new(context, 105, 105, 1, RC_KNOWN | RC_SOURCE);
  level.output = side_new(context, 256, 200, 1, RC_TARGET);
  level.exemplar.scale = rc_scale_channel(&plane);
  level.output.scale = rc_scale_resampled(&level.exemplar.scale, 105, 105, 256, 200);
  for (int y = 0; y < 105; y++)
    for (int x = 0; x < 105; x++) {
      float scale = rc_scale(&level.exemplar.scale, x, y);
      g_assert_cmpfloat(
          fabs((double)scale - recede_scale_at(&plane, RECEDE_SCALE_PAPER, 0, 0, x, y)), <, 1e-6);
      *rc_pixel(&level.exemplar.image, x, y) = scale;
    }
  g_assert_cmpint(rc_paper_start(context, &level, 1), ==, RECEDE_OK);
  int beyond = 0, repeated = 0;
  for (int y = 0; y < 200; y++)
    for (int x = 0; x < 256; x++) {
      float picked = *rc_pixel(&level.output.image, x, y);
      float wanted = rc_scale(&level.output.scale, x, y);
      beyond += fabsf(picked / wanted - 1) > RC_SCALE_TOLERANCE * 1.0001f;
      repeated += x > 0 && picked == *rc_pixel(&level.output.image, x - 1, y);
    }
  /* Only the two corners have fewer candidates than RC_SCALE_CANDIDATES within the tolerance. */
  g_test_message("%d beyond the tolerance, %d repeated", beyond, repeated);
  g_assert_cmpint(beyond, <, 256 * 200 / 200);
  g_assert_cmpint(repeated, <, 256 * 200 / 10);
  context_free(context);
}

/* ----------------------------------------------------------------------------------- update -- */

/* The minimum of eq. 8 over one patch, as Figure 6 has it: all neighbourhoods that wholly hold it.
 */
static void reference_pixel(const rc_matches *m, const rc_image *exemplar,
                            const rc_histogram_weight *histogram, int x0, int y0, int x1, int y1,
                            int x, int y, double *value, int *holding) {
  double sum[3] = {0}, total = 0;
  *holding = 0;
  for (int r = 0; r < m->grid.rows; r++)
    for (int c = 0; c < m->grid.columns; c++) {
      int wx = rc_grid_x(&m->grid, c), wy = rc_grid_y(&m->grid, r), w = m->grid.width;
      if (wx > x0 || wy > y0 || wx + w <= x1 || wy + w <= y1) continue;
      int i = r * m->grid.columns + c;
      const float *z = rc_pixel(exemplar, m->corner[i].x + x - wx, m->corner[i].y + y - wy);
      double weight = (double)m->weight[i], excess = 1;
      for (int k = 0; k < 3; k++) {
        int bin = (int)((z[k] - histogram->low[k]) * histogram->per_bin[k]);
        excess += (double)histogram->excess[k][MIN(bin, RC_HISTOGRAM_BINS - 1)];
      }
      weight /= excess;
      for (int k = 0; k < 3; k++) sum[k] += weight * (double)z[k];
      total += weight;
      ++*holding;
    }
  for (int k = 0; k < 3; k++) value[k] = sum[k] / total;
}

static void check_update(int width, int height, int window, int patch, double gain) {
  rc_context *context = context_new();
  GRand *random = g_rand_new_with_seed(13);
  rc_paper_settings settings = {.patch = patch, .exponent = .8};
  rc_paper_level level = {.colours = 3};
  rc_matches matches;
  rc_histogram_weight histogram;
  level.exemplar = side_new(context, 40, 40, 3, RC_KNOWN | RC_SOURCE);
  level.output = side_new(context, width, height, 3, RC_TARGET);
  for (int i = 0; i < 40 * 40 * 3; i++) level.exemplar.image.data[i] = noise(random);
  for (int i = 0; i < width * height * 3; i++)
    level.output.image.data[i] = noise(random) * noise(random);
  g_assert_cmpint(rc_matches_new(context, &level.output.flags, window, &matches), ==, RECEDE_OK);
  for (int i = 0; i < matches.grid.columns * matches.grid.rows; i++) {
    matches.corner[i].x = g_rand_int_range(random, 0, 41 - window);
    matches.corner[i].y = g_rand_int_range(random, 0, 41 - window);
    matches.distance[i] = noise(random) + .01f;
  }
  double energy = 0;
  double told = rc_energy_weights(&settings, .001f, &matches);
  for (int i = 0; i < matches.grid.columns * matches.grid.rows; i++) {
    g_assert_cmpfloat(fabs((double)matches.weight[i] / pow((double)matches.distance[i], -.6) - 1),
                      <, 1e-5);                     /* eq. 7: ||.||^(r - 2), r = .8 */
    energy += pow((double)matches.distance[i], .4); /* eq. 5 */
  }
  g_assert_cmpfloat(fabs(told / energy - 1), <, 1e-5);
  rc_histogram_compare(&level, gain, &histogram);
  g_assert_cmpint(rc_paper_update(context, &settings, &matches, &histogram, &level), ==, RECEDE_OK);
  int used = patch <= window / 4 ? patch : 1;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      double value[3];
      int holding, x0 = used == 2 ? (x - 1) | 1 : x, y0 = used == 2 ? (y - 1) | 1 : y;
      if (used == 2) x0 = x & 1 ? x : x - 1, y0 = y & 1 ? y : y - 1;
      reference_pixel(&matches, &level.exemplar.image, &histogram, MAX(x0, 0), MAX(y0, 0),
                      MIN(x0 + used, width) - 1, MIN(y0 + used, height) - 1, x, y, value, &holding);
      if (used == 2 && window == 8 && x > 8 && y > 8 && x < width - 9 && y < height - 9)
        g_assert_cmpint(holding, ==, 9); /* the paper's number */
      for (int k = 0; k < 3; k++)
        g_assert_cmpfloat(fabs(value[k] - (double)rc_pixel(&level.output.image, x, y)[k]), <, 1e-5);
    }
  g_rand_free(random);
  context_free(context);
}

static void update_against_reference(void) {
  check_update(48, 48, 8, 2, 0);
  check_update(48, 48, 8, 2, 10);
  check_update(47, 33, 8, 2, 10);
  check_update(47, 33, 16, 2, 1);
  check_update(47, 34, 8, 1, 0);
  check_update(19, 16, 5, 2, 0);
  check_update(8, 9, 8, 2, 0);
  check_update(3, 3, 1, 2, 0);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/paper/tree/brute-force", tree_against_brute_force);
  g_test_add_func("/paper/tree/members", tree_holds_all_members);
  g_test_add_func("/paper/pca/variance", pca_keeps_the_variance);
  g_test_add_func("/paper/pca/equal", pca_of_equal_vectors);
  g_test_add_func("/paper/windows", windows_lie_in_the_source);
  g_test_add_func("/paper/start", start_picks_equal_scale);
  g_test_add_func("/paper/update", update_against_reference);
  return g_test_run();
}
