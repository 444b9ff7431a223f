/* Vectors of four, as compilers of GNU C make them on any machine: the same bits as one by one. */
#ifndef RECEDE_BASE_FOUR_H
#define RECEDE_BASE_FOUR_H

#include <stdint.h>

typedef float rc_four __attribute__((vector_size(16)));
typedef int32_t rc_four_ints __attribute__((vector_size(16)));
typedef uint32_t rc_four_words __attribute__((vector_size(16)));

/* which: -1 or 0, as comparisons give. */
static inline rc_four rc_select(rc_four_ints which, rc_four yes, rc_four no) {
  return (rc_four)((which & (rc_four_ints)yes) | (~which & (rc_four_ints)no));
}

#endif
