#include "options.h"

#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

/* Callbacks get only the option's name: one command line is read at a time. */
typedef struct parse {
  options *given;
} parse;

static gboolean refuse(GError **error, const char *format, ...) G_GNUC_PRINTF(2, 3);
static gboolean refuse(GError **error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  char *text = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  g_set_error_literal(error, G_OPTION_ERROR, G_OPTION_ERROR_BAD_VALUE, text);
  g_free(text);
  return FALSE;
}

static gboolean set_param(options *given, const char *start, const char *key, const char *value,
                          GError **error) {
  char message[400];
  if (recede_params_set(&given->params, key, value, message, sizeof message) == RECEDE_OK)
    return TRUE;
  return refuse(error, "%s%s", start, message);
}

static void note_orientation(options *given, const char *key) {
  if (strcmp(key, "slant") == 0) given->slant_given = true;
  if (strcmp(key, "tilt") == 0) given->tilt_given = true;
  if (strcmp(key, "horizon") == 0) given->horizon_given = true;
  if (strcmp(key, "quad") == 0) given->quad_given = true;
}

static gboolean on_param(const char *name, const char *value, gpointer data, GError **error) {
  options *given = ((parse *)data)->given;
  const char *key = name + strspn(name, "-");
  note_orientation(given, key);
  return set_param(given, "--", key, value ? value : "1", error);
}

static gboolean on_set(const char *name, const char *value, gpointer data, GError **error) {
  const char *equals = strchr(value, '=');
  (void)name;
  if (!equals) return refuse(error, "--set: '%s' is not KEY=VALUE", value);
  char *key = g_strndup(value, (gsize)(equals - value));
  note_orientation(((parse *)data)->given, key);
  gboolean good = set_param(((parse *)data)->given, "--set: ", key, equals + 1, error);
  g_free(key);
  return good;
}

/* ------------------------------------------------------------------------- what there is -- */

static bool is_switch(const recede_param_info *row) {
  return row->type == RECEDE_PARAM_INT && row->minimum == 0 && row->maximum == 1;
}

static char *placeholder(const recede_param_info *row) {
  if (row->type == RECEDE_PARAM_CHOICE) return g_strjoinv("|", (char **)row->choices);
  if (row->type == RECEDE_PARAM_POINTS)
    return g_strdup(row->count == 4 ? "X1,Y1,X2,Y2" : "X1,Y1,…,X4,Y4");
  return g_strdup_printf("%.10g..%.10g", row->minimum, row->maximum);
}

static char *explanation(const recede_param_info *row) {
  if (strcmp(row->key, "slant") == 0) return g_strdup_printf("%s (default: estimated)", row->help);
  if (strcmp(row->key, "tilt") == 0)
    return g_strdup_printf("%s (with --slant; default 0°)", row->help);
  if (is_switch(row) || row->type == RECEDE_PARAM_POINTS) return g_strdup(row->help);
  if (row->type == RECEDE_PARAM_CHOICE)
    return g_strdup_printf("%s (default %s)", row->help, row->choices[(int)row->default_value]);
  return g_strdup_printf("%s (default %g%s)", row->help, row->default_value, row->unit);
}

static const char *keep(GStringChunk *kept, char *text) {
  const char *copy = g_string_chunk_insert(kept, text);
  g_free(text);
  return copy;
}

/* The rows of the table that are options; the source of the orientation follows from which of them
 * are given. orientation: those of the orientation, or the others. GOption keeps pointers: kept
 * must live as long as the group. */
static void add_params(GOptionGroup *group, options_of command, bool orientation,
                       GStringChunk *kept) {
  static const char *const of_orientation[] = {"slant", "tilt", "fov", "horizon", "quad", NULL};
  size_t rows;
  const recede_param_info *table = recede_param_table(&rows);
  for (size_t i = 0; i < rows; i++) {
    const recede_param_info *row = &table[i];
    if (!(row->flags & RECEDE_PARAM_COMMAND) || strcmp(row->key, "orientation") == 0) continue;
    if (g_strv_contains(of_orientation, row->key) != orientation) continue;
    if (row->flags & RECEDE_PARAM_SYNTHESIS && command != SYNTHESIZE) continue;
    GOptionEntry entries[] = {{row->key, 0, is_switch(row) ? G_OPTION_FLAG_NO_ARG : 0,
                               G_OPTION_ARG_CALLBACK, (gpointer)on_param,
                               keep(kept, explanation(row)),
                               is_switch(row) ? NULL : keep(kept, placeholder(row))},
                              {NULL}};
    g_option_group_add_entries(group, entries);
  }
}

#define ENTRY(name, letter, type, field, help, value) \
  { name, letter, 0, G_OPTION_ARG_##type, &given->field, help, value }
#define END \
  { NULL }

static void add_files(GOptionGroup *group, options_of command, options *given) {
  GOptionEntry output[] = {ENTRY("output", 'o', FILENAME, output,
                                 "The picture to write; its suffix says the format", "OUT"),
                           END};
  GOptionEntry mask[] = {ENTRY("mask", 0, FILENAME, mask,
                               "White is to be filled, gray is blended, black stays", "MASK"),
                         END};
  GOptionEntry source[] = {ENTRY("source", 0, FILENAME, source,
                                 command == FILL
                                     ? "White may be copied from (default: what lies around MASK)"
                                     : "White may be copied from (default: all)",
                                 "MASK"),
                           END};
  GOptionEntry size[] = {ENTRY("size", 0, STRING, size_text, "Size of the output, px", "WxH"), END};
  GOptionEntry kind[] = {
      ENTRY("kind", 0, STRING, kind_text,
            "Which scale (default across, with --method paper paper: the paper's eqs 1-3)",
            "across|along|area|paper"),
      END};
  if (command != ORIENT) g_option_group_add_entries(group, output);
  if (command == FILL || command == ORIENT) g_option_group_add_entries(group, mask);
  if (command != SCALE_MAP) g_option_group_add_entries(group, source);
  if (command == SYNTHESIZE || command == SCALE_MAP) g_option_group_add_entries(group, size);
  if (command == SCALE_MAP) g_option_group_add_entries(group, kind);
}

static void add_common(GOptionGroup *group, options *given) {
  GOptionEntry entries[] = {
      ENTRY("threads", 0, STRING, threads_text, "0: all processors (default 0)", "N"),
      ENTRY("memory", 0, STRING, memory_text, "Limit (default: three quarters of what there is)",
            "MiB"),
      ENTRY("json", 0, FILENAME, json, "Write a report as JSON; -: to standard output", "FILE|-"),
      ENTRY("force", 0, NONE, force, "Replace files that exist", NULL),
      ENTRY("quiet", 'q', NONE, quiet, "No progress and no warnings", NULL),
      {"set", 0, 0, G_OPTION_ARG_CALLBACK, (gpointer)on_set,
       "Set any parameter, developers' ones too (once for each)", "KEY=VALUE"},
      {G_OPTION_REMAINING, 0, 0, G_OPTION_ARG_FILENAME_ARRAY, &given->inputs, NULL, NULL},
      END};
  g_option_group_add_entries(group, entries);
}

/* ----------------------------------------------------------------------- what was given -- */

static gboolean whole_number(const char *name, const char *text, gint64 low, gint64 high,
                             gint64 *value, GError **error) {
  if (g_ascii_string_to_signed(text, 10, low, high, value, NULL)) return TRUE;
  return refuse(error,
                "%s: '%s' is not a whole number within %" G_GINT64_FORMAT "..%" G_GINT64_FORMAT,
                name, text, low, high);
}

static gboolean read_numbers(options *given, GError **error) {
  gint64 value;
  if (given->threads_text) {
    if (!whole_number("--threads", given->threads_text, 0, G_MAXINT32, &value, error)) return FALSE;
    given->threads = (int)value;
  }
  if (given->memory_text) {
    if (!whole_number("--memory", given->memory_text, 1, (gint64)1 << 40, &value, error))
      return FALSE;
    given->memory_bytes = (uint64_t)value << 20;
  }
  return TRUE;
}

static gboolean read_size(options *given, GError **error) {
  char *end;
  if (!given->size_text) return TRUE;
  long width = strtol(given->size_text, &end, 10);
  if (*end == 'x' && g_ascii_isdigit(given->size_text[0]) && g_ascii_isdigit(end[1])) {
    long height = strtol(end + 1, &end, 10);
    if (!*end && width >= 1 && height >= 1 && width <= 1 << 20 && height <= 1 << 20) {
      given->width = (int)width;
      given->height = (int)height;
      return TRUE;
    }
  }
  return refuse(error, "--size: '%s' is not WxH, each within 1..1048576", given->size_text);
}

static gboolean read_kind(options *given, GError **error) {
  static const char *const names[] = {"across", "along", "area", "paper", NULL};
  if (given->params.method == RECEDE_METHOD_PAPER) given->kind = RECEDE_SCALE_PAPER;
  if (!given->kind_text) return TRUE;
  for (int i = 0; names[i]; i++)
    if (strcmp(names[i], given->kind_text) == 0) {
      given->kind = (recede_scale_kind)i;
      return TRUE;
    }
  return refuse(error, "--kind: '%s' is not one of across, along, area, paper", given->kind_text);
}

static gboolean read_orientation(options *given, GError **error) {
  bool angles = given->slant_given || given->tilt_given;
  int ways = angles + given->horizon_given + given->quad_given + (given->frontal ? 1 : 0);
  if (ways > 1)
    return refuse(error,
                  "The orientation was given in %d ways: use one of --slant with --tilt, "
                  "--horizon, --quad, --frontal",
                  ways);
  if (given->tilt_given && !given->slant_given)
    return refuse(error, "--tilt says where the plane recedes to; --slant must say how much");
  if (angles) given->params.orientation = RECEDE_ORIENTATION_ANGLES;
  if (given->horizon_given) given->params.orientation = RECEDE_ORIENTATION_HORIZON;
  if (given->quad_given) given->params.orientation = RECEDE_ORIENTATION_QUAD;
  if (given->frontal) given->params.orientation = RECEDE_ORIENTATION_FRONTAL;
  return TRUE;
}

/* "" would be found missing only after the work, and said without a name. */
static gboolean check_names(const options *given, GError **error) {
  const struct {
    const char *name, *what;
  } names[] = {{given->output, "-o"},
               {given->json, "--json"},
               {given->mask, "--mask"},
               {given->source, "--source"},
               {given->input, "The picture"}};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (names[i].name && !names[i].name[0])
      return refuse(error, "%s: the file's name is empty", names[i].what);
  return TRUE;
}

static gboolean read_inputs(options_of command, options *given, GError **error) {
  const char *what = command == SYNTHESIZE ? "EXEMPLAR" : "IMAGE";
  guint count = given->inputs ? g_strv_length(given->inputs) : 0;
  if (count > 1) return refuse(error, "One %s is expected, %u were given", what, count);
  if (count == 1) given->input = given->inputs[0];
  if (command == SCALE_MAP) {
    if ((count == 1) == (given->width > 0))
      return refuse(error, "Either IMAGE or --size WxH is expected");
    if (!given->input && given->params.orientation == RECEDE_ORIENTATION_AUTO)
      return refuse(error, "Without a picture the orientation must be given (--slant, --horizon, "
                           "--quad or --frontal)");
  } else if (count == 0) {
    return refuse(error, "%s is missing", what);
  }
  if (command == FILL && !given->mask) return refuse(error, "--mask MASK is missing");
  if (command != ORIENT && !given->output) return refuse(error, "-o OUT is missing");
  if (command == SYNTHESIZE && !given->width) return refuse(error, "--size WxH is missing");
  return TRUE;
}

static gboolean read_given(options_of command, options *given, GError **error) {
  return read_numbers(given, error) && read_size(given, error) && read_kind(given, error) &&
         read_orientation(given, error) && read_inputs(command, given, error) &&
         check_names(given, error);
}

static const struct {
  const char *line, *summary, *description;
} texts[] = {
    [FILL] =
        {"IMAGE --mask MASK -o OUT",
         "Fills the white region of MASK with texture of the picture's receding plane: it gets\n"
         "smaller towards the horizon, as what surrounds it does. Pixels outside stay as they are.",
         "Example:\n"
         "  recede fill street.jpg --mask van.png -o street-empty.png --slant 70\n\n"
         "The orientation is given by --slant and --tilt, by --horizon, by --quad or by\n"
         "--frontal; without any it is estimated from the picture.\n\n"
         "Pictures are taken as they are seen: turned by their Exif orientation. The mask may\n"
         "have the size seen or the size stored.\n"
         "Exit codes: 0 done, 1 failed, 2 usage, 3 input, 4 output, 5 memory or size,\n"
         "128 + signal."},
    [SYNTHESIZE] =
        {"EXEMPLAR --size WxH -o OUT",
         "Makes a picture of a receding plane, of any size, from an example of it.",
         "Example:\n"
         "  recede synthesize beach.png --size 1600x900 -o more-beach.png --slant 60\n"
         "A floor of tiles that are seen from the front:\n"
         "  recede synthesize tiles.png --size 1024x768 -o floor.png --slant 65 \\\n"
         "    --exemplar frontal\n\n"
         "EXEMPLAR is a picture of the receding plane and becomes the middle of OUT; or,\n"
         "with --exemplar frontal, it shows the texture from the front and is laid onto\n"
         "the plane. Slant, field of view, horizon and quad are those of OUT (of EXEMPLAR\n"
         "with --method paper or kwatra)."},
    [SCALE_MAP] =
        {"IMAGE|--size WxH -o OUT",
         "Writes how many px a texel of the plane takes at every pixel, for one that is 1 px wide\n"
         "at the centre. .exr and .tif hold the values (NaN beyond the horizon), formats of 8\n"
         "bits a picture: brighter is nearer, a line at every doubling, red beyond the horizon.",
         "Example:\n"
         "  recede scale-map --size 800x600 --slant 60 --tilt 20 -o scale.exr"},
    [ORIENT] = {"IMAGE",
                "Reads slant, tilt and horizon of the plane from the picture, with a confidence\n"
                "from 0 to 1.",
                "Example:\n"
                "  recede orient street.jpg --mask van.png --json -"},
};

bool options_parse(options_of command, int argc, char **argv, options *given) {
  GError *error = NULL;
  parse state = {given};
  memset(given, 0, sizeof *given);
  recede_params_init(&given->params);
  char *name = g_strdup_printf("recede %s", argv[0]);
  g_set_prgname(name);
  GOptionContext *context = g_option_context_new(texts[command].line);
  g_option_context_set_summary(context, texts[command].summary);
  g_option_context_set_description(context, texts[command].description);
  GOptionGroup *group = g_option_group_new("main", "", "", &state, NULL);
  add_files(group, command, given);
  GOptionEntry frontal[] = {
      ENTRY("frontal", 0, NONE, frontal, "The plane is seen from the front: no perspective", NULL),
      END};
  GStringChunk *kept = g_string_chunk_new(4096);
  add_params(group, command, true, kept);
  g_option_group_add_entries(group, frontal);
  if (command != ORIENT) add_params(group, command, false, kept);
  add_common(group, given);
  g_option_context_set_main_group(context, group);
  bool good =
      g_option_context_parse(context, &argc, &argv, &error) && read_given(command, given, &error);
  if (!good) {
    command_complain(NULL, error->message);
    fprintf(stderr, "Try `%s --help`.\n", name);
    g_error_free(error);
  }
  g_option_context_free(context);
  g_string_chunk_free(kept);
  g_free(name);
  return good;
}

void options_clear(options *given) {
  g_free(given->mask);
  g_free(given->output);
  g_free(given->source);
  g_free(given->json);
  g_free(given->size_text);
  g_free(given->kind_text);
  g_free(given->memory_text);
  g_free(given->threads_text);
  g_strfreev(given->inputs);
}
