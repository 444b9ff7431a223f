#include "synthesis/paper/pca.h"

#include <string.h>

#include "base/eigen.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "synthesis/paper/neighbourhood.h"

/* A row stride of a power of two puts a column's elements into the same few cache lines: 256 x 256
 * takes six times longer than with these elements of padding. */
#define EIGEN_PADDING 4

typedef struct covariance_job {
  const float *deviations; /* inputs x count_stride: one row for each input */
  int inputs, count_stride;
  double *matrix;
  int stride;
} covariance_job;

static void covariance_row(void *user, int i, int thread) {
  const covariance_job *job = user;
  (void)thread;
  const float *row = job->deviations + (size_t)i * (size_t)job->count_stride;
  for (int j = 0; j <= i; j++) {
    double sum = (double)rc_dot(row, job->deviations + (size_t)j * (size_t)job->count_stride,
                                job->count_stride);
    job->matrix[(size_t)i * (size_t)job->stride + j] = sum;
    job->matrix[(size_t)j * (size_t)job->stride + i] = sum;
  }
}

static recede_status covariance(rc_context *context, const float *vectors, int count,
                                const rc_pca *pca, double *matrix, int stride) {
  int count_stride = rc_padded(count);
  float *deviations;
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, (size_t)pca->inputs * (size_t)count_stride, &deviations));
  for (int v = 0; v < count; v++)
    for (int i = 0; i < pca->inputs; i++)
      deviations[(size_t)i * (size_t)count_stride + v] =
          vectors[(size_t)v * (size_t)pca->stride + i] - pca->mean[i];
  covariance_job job = {deviations, pca->inputs, count_stride, matrix, stride};
  RC_TRY(rc_parallel(context, pca->inputs, covariance_row, &job));
  rc_release(context, mark);
  return RECEDE_OK;
}

/* Takes eigenvectors, the largest values first, until they hold the part of the variance. */
static void keep(rc_pca *pca, const double *values, const double *vectors, int stride,
                 double part) {
  double all = 0, held = 0;
  for (int i = 0; i < pca->inputs; i++) all += values[i] > 0 ? values[i] : 0;
  pca->components = 0;
  do {
    float *row = pca->basis + (size_t)pca->components * (size_t)pca->stride;
    int column = pca->components;
    for (int i = 0; i < pca->inputs; i++)
      row[i] = (float)vectors[(size_t)i * (size_t)stride + column];
    pca->shift[pca->components] = rc_dot(row, pca->mean, pca->stride);
    pca->components++;
    held += values[column] > 0 ? values[column] : 0;
  } while (held < part * all && pca->components < pca->inputs);
  pca->kept = all > 0 ? held / all : 1;
}

static void find_mean(const float *vectors, int count, rc_pca *pca) {
  for (int i = 0; i < pca->inputs; i++) {
    double sum = 0;
    for (int v = 0; v < count; v++) sum += (double)vectors[(size_t)v * (size_t)pca->stride + i];
    pca->mean[i] = (float)(sum / count);
  }
}

recede_status rc_pca_find(rc_context *context, const float *vectors, int count, int inputs,
                          double part, rc_pca *pca) {
  int stride = inputs + EIGEN_PADDING;
  double *matrix, *columns, *values;
  *pca = (rc_pca){.inputs = inputs, .stride = rc_padded(inputs)};
  RC_TRY(RC_NEW_ZERO(context, (size_t)inputs * (size_t)pca->stride, &pca->basis));
  RC_TRY(RC_NEW_ZERO(context, inputs, &pca->shift));
  RC_TRY(RC_NEW_ZERO(context, pca->stride, &pca->mean));
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW_ZERO(context, (size_t)inputs * (size_t)stride, &matrix));
  RC_TRY(RC_NEW_ZERO(context, (size_t)inputs * (size_t)stride, &columns));
  RC_TRY(RC_NEW(context, inputs, &values));
  find_mean(vectors, count, pca);
  RC_TRY(covariance(context, vectors, count, pca, matrix, stride));
  RC_TRY(rc_eigen(context, matrix, inputs, stride, values, columns));
  keep(pca, values, columns, stride, part);
  rc_release(context, mark);
  return RECEDE_OK;
}

void rc_pca_project(const rc_pca *pca, const float *vector, float *components) {
  for (int i = 0; i < pca->components; i++)
    components[i] =
        rc_dot(pca->basis + (size_t)i * (size_t)pca->stride, vector, pca->stride) - pca->shift[i];
}
