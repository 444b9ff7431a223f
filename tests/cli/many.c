/* Runs the command many times without starting it as often: the dynamic linker takes longer for its
 * libraries than the command takes for a small picture. Every run is a child of its own, which
 * lives from the command's main() to its return.
 *
 * From standard input, each ended by a zero byte: the path of a file for the run's standard error,
 * the arguments, an empty one. To standard output, a line for each run: its exit code, or the
 * signal that ended it, negative. Resource limits are those it is started with. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#define MOST_ARGUMENTS 64

int recede_main(int argc, char **argv); /* the command's main() */

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

static void become_command(int count, char **words) {
  int null = open("/dev/null", O_RDWR);
  int said = open(words[0], O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (null < 0 || said < 0) _exit(126);
  dup2(null, STDIN_FILENO);
  dup2(null, STDOUT_FILENO);
  dup2(said, STDERR_FILENO);
  close(null);
  close(said);
  static char name[] = "recede";
  words[0] = name;
  words[count] = NULL;
  int code = recede_main(count, words);
  fflush(NULL);
  /* Not exit(): one of the libraries has threads from the start, which a fork does not copy, and
   * waits for them at the end. */
  _exit(code);
}

int main(void) {
  char *words[MOST_ARGUMENTS];
  int count, status;
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
