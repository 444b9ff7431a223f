#include "command.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mask_file.h"
#include "pixels.h"
#include "safe_file.h"

/* Pixels of a picture, without --memory: 350 megapixels of 8-bit RGB, 64 of float with alpha. The
 * largest photographs have a third of that; what claims more is more likely a trap. */
#define DEFAULT_PICTURE_BYTES ((uint64_t)1 << 30)

/* -------------------------------------------------------------------------------- messages -- */

static void print_escaped(const char *text) {
  for (; *text; text++) {
    if (*text == '\n')
      fputs("\\n", stderr);
    else if ((unsigned char)*text < ' ' || *text == 127)
      fprintf(stderr, "\\x%02x", (unsigned char)*text);
    else
      fputc(*text, stderr);
  }
}

void command_complain(const char *name, const char *text) {
  command_progress_clear();
  fputs("recede: ", stderr);
  if (name) {
    print_escaped(name);
    fputs(": ", stderr);
  }
  print_escaped(text);
  fputc('\n', stderr);
}

void command_warn(const options *given, const char *name, const char *text) {
  if (!given->quiet && text[0]) command_complain(name, text);
}

command_exit command_refuse_image(const char *name, image_status status,
                                  const image_message *message) {
  command_complain(name, message->text);
  switch (status) {
    case IMAGE_TOO_LARGE:
    case IMAGE_NO_MEMORY: return EXIT_LIMIT;
    case IMAGE_OUTPUT: return EXIT_OUTPUT;
    default: return EXIT_INPUT;
  }
}

/* -------------------------------------------------------------------------------- progress -- */

static bool progress_shown;

int command_progress(void *user, const char *stage, double fraction) {
  (void)user;
  fprintf(stderr, "\r\033[K%3.0f %% %s", fraction * 100, stage ? stage : "");
  fflush(stderr);
  progress_shown = true;
  return 0;
}

void command_progress_clear(void) {
  if (progress_shown) fputs("\r\033[K", stderr);
  progress_shown = false;
}

/* --------------------------------------------------------------------------------- signals -- */

static recede_job *volatile running;
static volatile sig_atomic_t received;
static pthread_t main_thread;

/* The libraries' threads take signals too; the main thread blocks them while it names a temporary,
 * so it alone may act on one. */
static void on_signal(int number) {
  if (!pthread_equal(pthread_self(), main_thread)) {
    pthread_kill(main_thread, number);
    return;
  }
  recede_job *job = running;
  if (job && !received) {
    received = number;
    recede_job_cancel(job);
    return;
  }
  safe_file_abandon();
  _exit(128 + number);
}

void command_signals_init(void) {
  struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
  /* All that a shell, a batch system or a limit of time ends a process with. */
  static const int ending[] = {SIGINT,  SIGTERM, SIGHUP,  SIGQUIT,
                               SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2};
  main_thread = pthread_self();
  for (size_t i = 0; i < sizeof ending / sizeof *ending; i++) {
    struct sigaction old;
    /* nohup's ignoring is respected. */
    if (sigaction(ending[i], NULL, &old) == 0 && old.sa_handler == SIG_IGN) continue;
    sigaction(ending[i], &action, NULL);
  }
  /* A closed pipe and a file-size limit are errors of write(), not ends of the process. */
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}

void command_signals_enter(recede_job *job) {
  received = 0;
  running = job;
}

int command_signals_leave(void) {
  running = NULL;
  return received;
}

/* ----------------------------------------------------------------------------------- input -- */

static uint64_t picture_limit(const options *given) {
  return given->memory_bytes ? given->memory_bytes : DEFAULT_PICTURE_BYTES;
}

command_exit command_open(const char *path, const options *given, image_file *file) {
  image_message message;
  image_status status = image_file_open(path, picture_limit(given), file, &message);
  return status == IMAGE_OK ? EXIT_DONE : command_refuse_image(path, status, &message);
}

static bool copy_of(const recede_view *view, recede_view *copy) {
  *copy = pixels_new(view->width, view->height, view->channels, view->type);
  if (copy->data) memcpy(copy->data, view->data, view->stride_bytes * (size_t)view->height);
  return copy->data != NULL;
}

command_exit command_read(image_file *file, recede_view *stored) {
  image_message message;
  image_status status = image_file_read(file, &message);
  if (stored) stored->data = NULL;
  if (status != IMAGE_OK) return command_refuse_image(file->path, status, &message);
  if (!file->info.premultiplied || pixels_opaque(&file->view)) return EXIT_DONE;
  if (stored && !copy_of(&file->view, stored)) {
    command_complain(file->path, "not enough memory for its pixels");
    return EXIT_LIMIT;
  }
  pixels_unpremultiply(&file->view);
  return EXIT_DONE;
}

command_exit command_read_mask(const char *path, const options *given, const image_file *picture,
                               recede_view *mask) {
  image_message message, note;
  image_status status = mask_file_read(path, picture, picture_limit(given), mask, &note, &message);
  if (status != IMAGE_OK) return command_refuse_image(path, status, &message);
  command_warn(given, path, note.text);
  return EXIT_DONE;
}

/* ----------------------------------------------------------------------------------- a run -- */

recede_job *command_job(const options *given) {
  recede_host host;
  recede_host_init(&host);
  host.threads = given->threads;
  host.memory_bytes = given->memory_bytes;
  if (!given->quiet && isatty(STDERR_FILENO)) host.progress = command_progress;
  recede_job *job = recede_job_new(&host);
  if (!job) command_complain(NULL, "not enough memory");
  return job;
}

static command_exit exit_for(recede_status status, const options *given) {
  switch (status) {
    case RECEDE_OK: return EXIT_DONE;
    case RECEDE_ARGUMENT: return EXIT_USAGE;
    case RECEDE_TOO_LARGE:
    case RECEDE_NO_MEMORY: return EXIT_LIMIT;
    case RECEDE_EMPTY_TARGET:
    case RECEDE_EMPTY_SOURCE: return EXIT_INPUT;
    case RECEDE_NO_PLANE: /* a horizon or a quad that is no plane is a value out of range */
      return given->params.orientation == RECEDE_ORIENTATION_AUTO ? EXIT_FAILED : EXIT_USAGE;
    default: return EXIT_FAILED;
  }
}

command_exit command_finish(const recede_job *job, recede_status status, const options *given) {
  command_progress_clear();
  const char *message = recede_job_message(job);
  if (status != RECEDE_OK)
    command_complain(NULL, message[0] ? message : "it failed and gave no reason: please report it");
  return exit_for(status, given);
}

/* ---------------------------------------------------------------------------------- output -- */

command_exit command_check_format(const options *given, const image_file *file, int width,
                                  int height) {
  image_message message;
  if (!image_file_can_write(given->output, file, width, height, file->info.type, &message))
    return command_refuse_image(given->output, IMAGE_OUTPUT, &message);
  if (file->info.several && safe_file_same(given->output, given->input)) {
    command_complain(given->output,
                     "it holds several pictures, of which one would be left; give another name");
    return EXIT_OUTPUT;
  }
  command_warn(given, given->output, message.text);
  return EXIT_DONE;
}

static command_exit check_output(const char *path, const options *given) {
  char message[300];
  if (safe_file_check(path, given->force, message, sizeof message)) return EXIT_DONE;
  command_complain(path, message);
  return EXIT_OUTPUT;
}

static command_exit check_apart(const char *option, const char *path, const char *other,
                                const char *what) {
  char text[100];
  if (!path || !other || !safe_file_same(path, other)) return EXIT_DONE;
  snprintf(text, sizeof text, "%s names the same file as %s; give it another name", option, what);
  command_complain(path, text);
  return EXIT_USAGE;
}

/* Not even with --force a report replaces a picture, or a picture the mask that it was made with.
 * The picture itself may be replaced by its fill. */
static command_exit check_all_apart(const options *given, const char *json) {
  command_exit code = check_apart("-o", given->output, given->mask, "--mask");
  if (code == EXIT_DONE) code = check_apart("-o", given->output, given->source, "--source");
  if (code == EXIT_DONE) code = check_apart("--json", json, given->output, "-o");
  if (code == EXIT_DONE) code = check_apart("--json", json, given->input, "the picture");
  if (code == EXIT_DONE) code = check_apart("--json", json, given->mask, "--mask");
  if (code == EXIT_DONE) code = check_apart("--json", json, given->source, "--source");
  return code;
}

command_exit command_check_outputs(const options *given) {
  const char *json = given->json && strcmp(given->json, "-") != 0 ? given->json : NULL;
  command_exit code = check_all_apart(given, json);
  if (code == EXIT_DONE && json) code = check_output(json, given);
  if (code == EXIT_DONE && given->output) code = check_output(given->output, given);
  return code;
}

command_exit command_write(const options *given, const recede_view *result, const image_file *like,
                           bool keep) {
  image_message message;
  char reason[300];
  image_bytes bytes = {NULL, 0};
  image_status status = image_file_encode(given->output, result, like, keep, &bytes, &message);
  command_exit code = EXIT_DONE;
  if (status != IMAGE_OK) {
    code = command_refuse_image(given->output, status, &message);
  } else {
    command_warn(given, given->output, message.text);
    if (!safe_file_write(given->output, bytes.data, bytes.size, given->force, reason,
                         sizeof reason)) {
      command_complain(given->output, reason);
      code = EXIT_OUTPUT;
    }
  }
  image_bytes_free(&bytes);
  return code;
}

command_exit command_end_output(void) {
  char text[200];
  if (fflush(stdout) == 0 && !ferror(stdout)) return EXIT_DONE;
  snprintf(text, sizeof text, "standard output: %s", strerror(errno));
  command_complain(NULL, text);
  return EXIT_OUTPUT;
}

void command_doubt(const options *given, const recede_orientation *orientation) {
  char text[200];
  if (!orientation->estimated || orientation->confidence >= RECEDE_CONFIDENCE_LOW) return;
  snprintf(text, sizeof text,
           "the orientation was read from the picture with little confidence (%.2f): do not trust "
           "it; give --slant and --tilt, or --horizon",
           orientation->confidence);
  command_warn(given, NULL, text);
}

command_exit command_report(const options *given, const recede_report *report,
                            const report_scale *scale) {
  char message[300];
  command_warn(given, NULL, report->warning);
  if (report->nonfinite_pixels > 0) {
    snprintf(message, sizeof message,
             "%llu px are no numbers, infinite or beyond 1e9: nothing was copied from them.",
             (unsigned long long)report->nonfinite_pixels);
    command_warn(given, NULL, message);
  }
  if (!given->json) return EXIT_DONE;
  if (report_write(given->json, given->force, report, scale, message, sizeof message))
    return EXIT_DONE;
  command_complain(given->json, message);
  return EXIT_OUTPUT;
}
