#include "base/eigen.h"

#include <gsl/gsl_eigen.h>
#include <math.h>

#include "base/memory.h"

/* Of a vector and its opposite always the same one. */
static void point_up(double *vector, int n, int stride) {
  int greatest = 0;
  for (int i = 1; i < n; i++)
    if (fabs(vector[i * stride]) > fabs(vector[greatest * stride])) greatest = i;
  if (vector[greatest * stride] >= 0) return;
  for (int i = 0; i < n; i++) vector[i * stride] = -vector[i * stride];
}

/* GSL's own allocator would abort the process when memory is short, unless a handler global to the
 * process is changed; its workspace is four public arrays, so they are ours. The calls fail only
 * for sizes that do not match. */
recede_status rc_eigen(rc_context *context, double *matrix, int n, int stride, double *values,
                       double *vectors) {
  gsl_eigen_symmv_workspace work = {.size = (size_t)n};
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, n, &work.d));
  RC_TRY(RC_NEW(context, n, &work.sd));
  RC_TRY(RC_NEW(context, n, &work.gc));
  RC_TRY(RC_NEW(context, n, &work.gs));
  gsl_matrix_view a = gsl_matrix_view_array_with_tda(matrix, (size_t)n, (size_t)n, (size_t)stride);
  gsl_matrix_view v = gsl_matrix_view_array_with_tda(vectors, (size_t)n, (size_t)n, (size_t)stride);
  gsl_vector_view e = gsl_vector_view_array(values, (size_t)n);
  if (gsl_eigen_symmv(&a.matrix, &e.vector, &v.matrix, &work) != 0 ||
      gsl_eigen_symmv_sort(&e.vector, &v.matrix, GSL_EIGEN_SORT_VAL_DESC) != 0)
    return rc_fail(context, RECEDE_INTERNAL, "The principal components could not be found.");
  for (int i = 0; i < n; i++) point_up(vectors + i, n, stride);
  rc_release(context, mark);
  return rc_poll(context);
}
