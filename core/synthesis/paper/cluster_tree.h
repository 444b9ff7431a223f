/* The k-means tree over the exemplar's neighbourhoods (the paper's section 2.2, after the 2005
 * baseline): the root holds all, each node's members are split into k = 4 clusters, its children.
 */
#ifndef RECEDE_SYNTHESIS_PAPER_CLUSTER_TREE_H
#define RECEDE_SYNTHESIS_PAPER_CLUSTER_TREE_H

#include "base/context.h"

/* The vectors: returns the index-th, dims floats (a multiple of 8); may make it in scratch, which
 * holds dims floats. */
typedef const float *rc_read_point(const void *user, int index, float *scratch);
typedef struct rc_points {
  const void *user;
  rc_read_point *read;
  int count, dims;
} rc_points;

typedef struct rc_tree_node {
  int first, end; /* members: order[first .. end) */
  int child;      /* the first of them; 0: a leaf */
  int children;
  bool alike; /* a leaf of equal vectors */
} rc_tree_node;

typedef struct rc_tree {
  rc_points points;
  int *order;
  rc_tree_node *nodes;
  float *centroids; /* nodes x dims */
  int node_count;
} rc_tree;

/* A node of fewer than stop members is a leaf. */
recede_status rc_tree_build(rc_context *context, const rc_points *points, int stop, uint64_t key,
                            rc_tree *tree);
/* Descends to the nearest centroid's child and compares the leaf's members: the index of the
 * nearest of them, its squared distance in *distance. scratch holds dims floats. */
int rc_tree_search(const rc_tree *tree, const float *vector, float *scratch, float *distance);

#endif
