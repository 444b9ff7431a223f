/* What is not done under sanitizers, which watch how the code runs and not what comes of it. */
#ifndef RECEDE_TESTS_JUDGED_H
#define RECEDE_TESTS_JUDGED_H

#include <glib.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

/* How many of so many tasks that run nearly the same code: the first alone under sanitizers. */
static inline int some_of(int count) { return SANITIZED ? 1 : count; }

/* A test that judges what many fills or readings look like, or counts their bytes: none under
 * sanitizers, for tests of single fills run the same code. */
static inline void test_add_judged(const char *path, GTestFunc judge) {
  if (!SANITIZED) g_test_add_func(path, judge);
}

#endif
