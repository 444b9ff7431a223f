/* Principal components of a set of vectors (the paper's section 2.2). */
#ifndef RECEDE_SYNTHESIS_PAPER_PCA_H
#define RECEDE_SYNTHESIS_PAPER_PCA_H

#include "base/context.h"

typedef struct rc_pca {
  int inputs;     /* numbers of a vector */
  int stride;     /* inputs padded to whole lanes; the padding is 0 */
  int components; /* kept */
  float *basis;   /* components x stride, orthonormal rows, largest variance first */
  float *shift;   /* components: basis . mean, to be subtracted */
  float *mean;    /* stride */
  double kept;    /* part of the variance that the components hold */
} rc_pca;

/* vectors: count x stride floats (rows padded with 0); as many components as hold part of the
 * variance. Vectors without any variance have one component. */
recede_status rc_pca_find(rc_context *context, const float *vectors, int count, int inputs,
                          double part, rc_pca *pca);
/* vector (stride floats) to its components. */
void rc_pca_project(const rc_pca *pca, const float *vector, float *components);

#endif
