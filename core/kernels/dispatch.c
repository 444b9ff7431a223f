#include "kernels/kernels.h"

static int runs(int index) {
#if defined(__x86_64__)
  if (index == 2) return __builtin_cpu_supports("avx2");
  if (index == 3)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
#endif
  return index < 2;
}

const rc_kernels *rc_kernels_select(int index) {
  static const rc_kernels *const all[] = {
    &rc_kernels_reference,
    &rc_kernels_baseline,
#if defined(__x86_64__)
    &rc_kernels_avx2,
    &rc_kernels_avx512
#endif
  };
  int count = (int)(sizeof all / sizeof *all);
  if (index >= count || (index >= 0 && !runs(index))) return 0;
  if (index >= 0) return all[index];
  for (index = count - 1; !runs(index);) index--;
  return all[index];
}
