/* Principal axes. */
#ifndef RECEDE_BASE_EIGEN_H
#define RECEDE_BASE_EIGEN_H

#include "base/context.h"

/* Of a symmetric matrix of n rows, stride apart, which is overwritten: the eigenvalues, largest
 * first, and their unit vectors, the i-th in column i of rows stride apart, the greatest element of
 * each positive. */
recede_status rc_eigen(rc_context *context, double *matrix, int n, int stride, double *values,
                       double *vectors);

#endif
