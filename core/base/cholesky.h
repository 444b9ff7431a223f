/* Small systems of linear equations whose matrix is symmetric: least squares' normal equations. */
#ifndef RECEDE_BASE_CHOLESKY_H
#define RECEDE_BASE_CHOLESKY_H

#include <math.h>
#include <stdbool.h>

/* Makes the lower triangle of an n x n matrix, row by row, its Cholesky factor. False: the
 * equations do not determine the unknowns. */
static inline bool rc_factor(int n, double *m) {
  double most = m[0];
  for (int i = 0; i < n; i++)
    for (int j = 0; j <= i; j++) {
      double v = m[i * n + j];
      for (int k = 0; k < j; k++) v -= m[i * n + k] * m[j * n + k];
      if (i == j && !(v > 1e-6 * most)) return false;
      m[i * n + j] = i == j ? sqrt(v) : v / m[j * n + j];
    }
  return true;
}

/* Makes the n values the unknowns, by such a factor. */
static inline void rc_substitute(int n, const double *m, double *values) {
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < i; k++) values[i] -= m[i * n + k] * values[k];
    values[i] /= m[i * n + i];
  }
  for (int i = n - 1; i >= 0; i--) {
    for (int k = i + 1; k < n; k++) values[i] -= m[k * n + i] * values[k];
    values[i] /= m[i * n + i];
  }
}

#endif
