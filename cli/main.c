/* recede - perspective texture synthesis from the command line. */
#include <locale.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "command.h"

static const struct {
  const char *name;
  options_of command;
  command_exit (*run)(options *given);
} commands[] = {
    {"fill", FILL, command_fill},
    {"synthesize", SYNTHESIZE, command_synthesize},
    {"scale-map", SCALE_MAP, command_scale_map},
    {"orient", ORIENT, command_orient},
};

static const char usage[] =
    "Usage: recede COMMAND [OPTION…]\n"
    "\n"
    "  recede fill IMAGE --mask MASK -o OUT          fill a region of a receding plane\n"
    "  recede synthesize EXEMPLAR --size WxH -o OUT  make a larger picture of such a plane\n"
    "  recede scale-map IMAGE|--size WxH -o OUT      write the scale at every pixel\n"
    "  recede orient IMAGE                           estimate slant, tilt and horizon\n"
    "\n"
    "  recede COMMAND --help   the options of a command\n"
    "  recede --version        the version\n";

/* The image library starts as many as it is told, and gains nothing from more. */
#define MOST_CODEC_THREADS 64

static int run(size_t index, int argc, char **argv) {
  options given;
  command_exit code = EXIT_USAGE;
  if (options_parse(commands[index].command, argc, argv, &given)) {
    image_codec_init(given.threads > MOST_CODEC_THREADS ? MOST_CODEC_THREADS : given.threads);
    code = commands[index].run(&given);
  }
  options_clear(&given);
  if (!image_codec_broken()) return (int)code;
  fflush(NULL);
  _exit((int)code);
}

int main(int argc, char **argv) {
  /* Only the alphabet and the language: numbers must read and print alike everywhere. */
  setlocale(LC_CTYPE, "");
  setlocale(LC_MESSAGES, "");
  command_signals_init();
  if (argc < 2) {
    fputs(usage, stderr);
    return EXIT_USAGE;
  }
  if (strcmp(argv[1], "--version") == 0) {
    printf("recede %s\n", RECEDE_VERSION);
    return command_end_output();
  }
  if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
      strcmp(argv[1], "help") == 0) {
    fputs(usage, stdout);
    return command_end_output();
  }
  for (size_t i = 0; i < sizeof commands / sizeof *commands; i++)
    if (strcmp(argv[1], commands[i].name) == 0) return run(i, argc - 1, argv + 1);
  char text[200];
  snprintf(text, sizeof text, "there is no command '%s'; see `recede --help`", argv[1]);
  command_complain(NULL, text);
  return EXIT_USAGE;
}
