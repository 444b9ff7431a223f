/* Runs the command many times without starting it as often: the dynamic linker takes longer for its
 * libraries than the command takes for a small picture. Every run is a child of its own, which
 * lives from the command's main() to its return.
 *
 * From standard input, each ended by a zero byte: the paths of files for the run's standard output
 * and error and for what is found of leaks, the arguments, an empty one. To standard output, a line
 * for each run: its exit code, or the signal that ended it, negative. Resource limits are those it
 * is started with. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_ARGUMENTS 64
#define PATHS 3
#define MOST_GROWTHS 4096

int recede_main(int argc, char **argv); /* the command's main() */

/* There under ASan alone. Says what is lost, as it does at an exit; how much is allocated. */
extern int __lsan_do_recoverable_leak_check(void) __attribute__((weak));
extern size_t __sanitizer_get_current_allocated_bytes(void) __attribute__((weak));

/* By how many bytes runs had grown at their end that were looked through for leaks: to look takes
 * as long as many runs do. What grew by as much as a run that lost nothing has lost nothing. */
static struct {
  size_t grown[MOST_GROWTHS];
  int count;
} * looked_at; /* shared with the children */

static void look_for_leaks(size_t before) {
  size_t grown = __sanitizer_get_current_allocated_bytes() - before;
  for (int i = 0; i < looked_at->count; i++)
    if (looked_at->grown[i] == grown) return;
  /* One that lost something is not kept: what grows as much has lost something, too. */
  if (!__lsan_do_recoverable_leak_check() && looked_at->count < MOST_GROWTHS)
    looked_at->grown[looked_at->count++] = grown;
}

/* How many before the empty one; 0 at the end of the input. */
static int read_words(char **words) {
  for (int count = 0; count < MOST_ARGUMENTS; count++) {
    size_t size = 0;
    words[count] = NULL;
    if (getdelim(&words[count], &size, 0, stdin) < 0) {
      free(words[count]);
      return 0;
    }
    if (words[count][0] == '\0') return count;
  }
  fputs("too many arguments\n", stderr);
  exit(EXIT_FAILURE);
}

static void replace(int descriptor, const char *path, int flags) {
  int opened = open(path, flags, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
  close(opened);
}

/* What is found of leaks is not the command's to write. */
static void lift_limit(void) {
  struct rlimit size;
  getrlimit(RLIMIT_FSIZE, &size);
  size.rlim_cur = size.rlim_max;
  setrlimit(RLIMIT_FSIZE, &size);
}

static void become_command(int count, char *const *words) {
  replace(STDIN_FILENO, "/dev/null", O_RDONLY);
  replace(STDOUT_FILENO, words[0], O_WRONLY | O_CREAT | O_TRUNC);
  replace(STDERR_FILENO, words[1], O_WRONLY | O_CREAT | O_TRUNC);
  size_t before = looked_at ? __sanitizer_get_current_allocated_bytes() : 0;
  char name[] = "recede", *arguments[MOST_ARGUMENTS] = {name};
  memcpy(arguments + 1, words + PATHS, (size_t)(count - PATHS) * sizeof *words);
  int code = recede_main(count - PATHS + 1, arguments);
  fflush(NULL);
  lift_limit();
  /* It also talks of threads that a fork lacks. */
  replace(STDERR_FILENO, words[2], O_WRONLY | O_CREAT | O_TRUNC);
  if (looked_at) look_for_leaks(before);
  /* Not exit(): one of the libraries has threads from the start, which a fork does not copy, and
   * waits for them at the end. */
  _exit(code);
}

int main(void) {
  static char *words[MOST_ARGUMENTS];
  int count, status;
  if (__lsan_do_recoverable_leak_check) {
    looked_at =
        mmap(NULL, sizeof *looked_at, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (looked_at == MAP_FAILED) return EXIT_FAILURE;
  }
  while ((count = read_words(words)) > 0) {
    pid_t child = fork();
    if (child == 0) become_command(count, words);
    if (child < 0 || waitpid(child, &status, 0) != child) return EXIT_FAILURE;
    printf("%d\n", WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
    fflush(stdout);
    for (int i = 0; i <= count; i++) free(words[i]);
  }
  return EXIT_SUCCESS;
}
