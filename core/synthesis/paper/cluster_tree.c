#include "synthesis/paper/cluster_tree.h"

#include <float.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "synthesis/paper/neighbourhood.h"
#include "synthesis/paper/settings.h"

/* Lloyd's iterations: the split only has to be fair, and the first few do nearly all of it. */
#define LLOYD_ITERATIONS 8
/* Members whose vectors are equal need not all be compared. */
#define ALIKE_COMPARED 4

typedef struct builder {
  rc_context *context;
  rc_tree *tree;
  int stop, most_nodes;
  uint64_t key;
  uint8_t *label; /* of the members, by place in order */
  int *swap;
  float *scratch;
  float *centroids, *sums; /* RC_TREE_BRANCHES x dims */
} builder;

static const float *point(const rc_tree *tree, int place, float *scratch) {
  return tree->points.read(tree->points.user, tree->order[place], scratch);
}

static float *centroid(float *centroids, int dims, int which) {
  return centroids + (size_t)which * (size_t)dims;
}

static int nearest(const float *centroids, int count, int dims, const float *vector) {
  int best = 0;
  float least = FLT_MAX;
  for (int c = 0; c < count; c++) {
    float distance = rc_squared_distance(centroids + (size_t)c * (size_t)dims, vector, dims);
    if (distance < least) least = distance, best = c;
  }
  return best;
}

/* Seeds: members drawn at random, one from each quarter of the node. */
static void seed_centroids(builder *b, const rc_tree_node *node, int index) {
  int dims = b->tree->points.dims, count = node->end - node->first;
  for (int c = 0; c < RC_TREE_BRANCHES; c++) {
    int from = (int)((int64_t)count * c / RC_TREE_BRANCHES);
    int to = (int)((int64_t)count * (c + 1) / RC_TREE_BRANCHES);
    uint32_t bits = (uint32_t)(rc_random(b->key, (uint32_t)index, (uint32_t)c, 0) >> 32);
    int place = node->first + from + (int)rc_below(bits, (uint32_t)(to > from ? to - from : 1));
    memcpy(centroid(b->centroids, dims, c), point(b->tree, place, b->scratch),
           (size_t)dims * sizeof(float));
  }
}

/* Labels every member with its nearest centroid and adds it to that cluster's sum; *changed: how
 * many labels did. */
static recede_status assign(builder *b, const rc_tree_node *node, int *changed,
                            int sizes[RC_TREE_BRANCHES]) {
  int dims = b->tree->points.dims;
  *changed = 0;
  memset(sizes, 0, RC_TREE_BRANCHES * sizeof *sizes);
  for (int i = node->first; i < node->end; i++) {
    const float *vector = point(b->tree, i, b->scratch);
    uint8_t label = (uint8_t)nearest(b->centroids, RC_TREE_BRANCHES, dims, vector);
    float *sum = centroid(b->sums, dims, label);
    *changed += label != b->label[i];
    b->label[i] = label;
    if (sizes[label]++ == 0)
      memcpy(sum, vector, (size_t)dims * sizeof *sum);
    else
      for (int k = 0; k < dims; k++) sum[k] += vector[k];
    if (i % 256 == 255) RC_TRY(rc_poll(b->context));
  }
  return RECEDE_OK;
}

/* Centroids of the labelled members; those of empty clusters stay. */
static void average(builder *b, const int sizes[RC_TREE_BRANCHES]) {
  int dims = b->tree->points.dims;
  for (int c = 0; c < RC_TREE_BRANCHES; c++) {
    const float *sum = centroid(b->sums, dims, c);
    float *mean = centroid(b->centroids, dims, c), part = 1.f / (float)sizes[c];
    for (int k = 0; k < dims && sizes[c]; k++) mean[k] = sum[k] * part;
  }
}

static recede_status k_means(builder *b, const rc_tree_node *node, int index,
                             int sizes[RC_TREE_BRANCHES]) {
  int changed = 1;
  memset(b->label + node->first, 255, (size_t)(node->end - node->first));
  seed_centroids(b, node, index);
  for (int i = 0; i < LLOYD_ITERATIONS && changed; i++) {
    RC_TRY(assign(b, node, &changed, sizes));
    average(b, sizes);
  }
  return RECEDE_OK;
}

/* Sorts the node's members by cluster and appends a child for each that has any. */
static void add_children(builder *b, int index, const int sizes[RC_TREE_BRANCHES]) {
  rc_tree *tree = b->tree;
  rc_tree_node *node = &tree->nodes[index];
  int dims = tree->points.dims, place[RC_TREE_BRANCHES], next = node->first;
  node->child = tree->node_count;
  for (int c = 0; c < RC_TREE_BRANCHES; c++) {
    place[c] = next;
    if (!sizes[c]) continue;
    tree->nodes[tree->node_count] = (rc_tree_node){.first = next, .end = next + sizes[c]};
    memcpy(centroid(tree->centroids, dims, tree->node_count), centroid(b->centroids, dims, c),
           (size_t)dims * sizeof(float));
    tree->node_count++;
    next += sizes[c];
  }
  node->children = tree->node_count - node->child;
  for (int i = node->first; i < node->end; i++) b->swap[place[b->label[i]]++] = tree->order[i];
  memcpy(tree->order + node->first, b->swap + node->first,
         (size_t)(node->end - node->first) * sizeof *tree->order);
}

static recede_status split(builder *b, int index) {
  rc_tree_node *node = &b->tree->nodes[index];
  int sizes[RC_TREE_BRANCHES], filled = 0;
  if (node->end - node->first < b->stop || b->tree->node_count + RC_TREE_BRANCHES > b->most_nodes)
    return RECEDE_OK;
  RC_TRY(k_means(b, node, index, sizes));
  for (int c = 0; c < RC_TREE_BRANCHES; c++) filled += sizes[c] > 0;
  node->alike = filled == 1;
  if (filled > 1) add_children(b, index, sizes);
  return RECEDE_OK;
}

/* Every split makes at least two nodes of one, so twice the points always suffices; with large
 * leaves far fewer do, and a centroid of a 32 x 32 neighbourhood takes 12 KiB. */
static int node_bound(int count, int stop) {
  int64_t all = 2 * (int64_t)count + RC_TREE_BRANCHES, by_leaf = 32 * (int64_t)count / stop + 64;
  return (int)(all < by_leaf ? all : by_leaf);
}

recede_status rc_tree_build(rc_context *context, const rc_points *points, int stop, uint64_t key,
                            rc_tree *tree) {
  int dims = points->dims, bound = node_bound(points->count, stop);
  builder b = {.context = context, .tree = tree, .stop = stop, .most_nodes = bound, .key = key};
  *tree = (rc_tree){.points = *points, .node_count = 1};
  RC_TRY(RC_NEW(context, points->count, &tree->order));
  RC_TRY(RC_NEW(context, bound, &tree->nodes));
  RC_TRY(RC_NEW(context, (size_t)bound * (size_t)dims, &tree->centroids));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, points->count, &b.label));
  RC_TRY(RC_NEW(context, points->count, &b.swap));
  RC_TRY(RC_NEW(context, dims, &b.scratch));
  RC_TRY(RC_NEW(context, (size_t)RC_TREE_BRANCHES * (size_t)dims, &b.centroids));
  RC_TRY(RC_NEW(context, (size_t)RC_TREE_BRANCHES * (size_t)dims, &b.sums));
  for (int i = 0; i < points->count; i++) tree->order[i] = i;
  tree->nodes[0] = (rc_tree_node){.first = 0, .end = points->count};
  for (int i = 0; i < tree->node_count; i++) RC_TRY(split(&b, i));
  rc_release(context, mark);
  return RECEDE_OK;
}

int rc_tree_search(const rc_tree *tree, const float *vector, float *scratch, float *distance) {
  int dims = tree->points.dims, best = 0;
  const rc_tree_node *node = &tree->nodes[0];
  while (node->child)
    node = &tree->nodes[node->child + nearest(centroid(tree->centroids, dims, node->child),
                                              node->children, dims, vector)];
  int end = node->alike && node->end - node->first > ALIKE_COMPARED ? node->first + ALIKE_COMPARED
                                                                    : node->end;
  *distance = FLT_MAX;
  for (int i = node->first; i < end; i++) {
    float d = rc_squared_distance(point(tree, i, scratch), vector, dims);
    if (d < *distance) *distance = d, best = tree->order[i];
  }
  return best;
}
