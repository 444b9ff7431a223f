#include "base/machine.h"

#include <inttypes.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#define UNKNOWN_MEMORY ((uint64_t)2 << 30)

int rc_machine_processors(void) {
#ifdef CPU_COUNT
  cpu_set_t allowed; /* of 1024 processors; a kernel that has more refuses, and all count */
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
#endif
  return (int)sysconf(_SC_NPROCESSORS_ONLN);
}

static uint64_t lesser(uint64_t a, uint64_t b) { return a < b ? a : b; }

/* The number that the file begins with; UINT64_MAX: there is none, as in "max". */
static uint64_t number_in(const char *path) {
  uint64_t number = UINT64_MAX;
  FILE *file = fopen(path, "re");
  if (!file) return UINT64_MAX;
  if (fscanf(file, "%" SCNu64, &number) != 1) number = UINT64_MAX;
  fclose(file);
  return number;
}

/* Of a control group and those that it lies in. In a container the group may bear the name that it
 * has outside: then only the root is found, which is the container's. */
static uint64_t least_of_groups(const char *root, char *group, const char *name) {
  char path[1200];
  uint64_t least = UINT64_MAX;
  for (;;) {
    snprintf(path, sizeof path, "%s%s/%s", root, group, name);
    least = lesser(least, number_in(path));
    char *last = strrchr(group, '/');
    if (!last) return least;
    *last = '\0';
  }
}

/* Lines are ID:KINDS:GROUP; version 2 has no kinds. */
static uint64_t memory_of_groups(void) {
  char line[1000];
  uint64_t least = UINT64_MAX;
  FILE *groups = fopen("/proc/self/cgroup", "re");
  if (!groups) return least;
  while (fgets(line, sizeof line, groups)) {
    char *kinds = strchr(line, ':'), *group = kinds ? strchr(kinds + 1, ':') : NULL;
    if (!group) continue;
    *group++ = '\0';
    group[strcspn(group, "\n")] = '\0';
    if (!kinds[1])
      least = lesser(least, least_of_groups("/sys/fs/cgroup", group, "memory.max"));
    else if (strstr(kinds, "memory"))
      least =
          lesser(least, least_of_groups("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
  }
  fclose(groups);
  return least;
}

/* What is left of the addresses, of which libraries have taken some. */
static uint64_t addresses_left(uint64_t page_bytes) {
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return UINT64_MAX;
  uint64_t pages = number_in("/proc/self/statm");
  uint64_t taken = pages == UINT64_MAX ? 0 : pages * page_bytes;
  return limit.rlim_cur > taken ? limit.rlim_cur - taken : 0;
}

uint64_t rc_machine_memory_bytes(void) {
  long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  uint64_t physical = pages > 0 && page > 0 ? (uint64_t)pages * (uint64_t)page : UNKNOWN_MEMORY;
  uint64_t left = addresses_left(page > 0 ? (uint64_t)page : 4096);
  return lesser(lesser(physical, left), memory_of_groups());
}
