/* options.h - the command line of a subcommand, read by GOption from the core's table. */
#ifndef RECEDE_OPTIONS_H
#define RECEDE_OPTIONS_H

#include <glib.h>
#include <stdbool.h>

#include "recede.h"

typedef struct options {
  char *input; /* IMAGE or EXEMPLAR; NULL: none given */
  char *mask, *output, *source, *json;
  int width, height; /* --size; 0: not given */
  recede_scale_kind kind;
  int threads;
  uint64_t memory_bytes; /* 0: not given */
  gboolean force, quiet;
  recede_params params;
  /* While parsing: */
  bool slant_given, tilt_given, horizon_given, quad_given, kind_given;
  gboolean frontal;
  char *size_text, *kind_text, *memory_text, *threads_text;
  char **inputs;
} options;

typedef enum options_of { FILL, SYNTHESIZE, SCALE_MAP, ORIENT } options_of;

/* argv[0] is the subcommand's name. Returns false after having said what is wrong; --help prints
 * and ends the process with 0. */
bool options_parse(options_of command, int argc, char **argv, options *given);
void options_clear(options *given);

#endif
