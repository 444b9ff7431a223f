/* Tests that judge what many fills or readings look like, or count their bytes. */
#ifndef RECEDE_TESTS_JUDGED_H
#define RECEDE_TESTS_JUDGED_H

#include <glib.h>

/* Under sanitizers there is none: they watch the same code in the tests of single fills. */
static inline void test_add_judged(const char *path, GTestFunc judge) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  (void)path, (void)judge;
#else
  g_test_add_func(path, judge);
#endif
}

#endif
