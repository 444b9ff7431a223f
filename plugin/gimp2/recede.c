/* The plug-in for GIMP 2.10: registers the procedures and runs them. */
#include <libgimp/gimp.h>
#include <string.h>

#include "../common/intl.h"
#include "../common/procedure.h"
#include "host.h"

/* run-mode, image, drawable come before ours. */
#define FIXED_ARGUMENTS 3

static char *choice_text(const rp_argument *row) {
  GString *text = g_string_new("{ ");
  for (int i = 0; i <= (int)row->maximum; i++)
    g_string_append_printf(text, "%s%s (%d)", i ? ", " : "", row->choices[i], i);
  return g_string_free(g_string_append(text, " }"), FALSE);
}

/* 2.10 registers neither ranges nor defaults: they stand in the description. */
static char *description(const rp_argument *row) {
  char low[G_ASCII_DTOSTR_BUF_SIZE], high[G_ASCII_DTOSTR_BUF_SIZE], value[G_ASCII_DTOSTR_BUF_SIZE];
  if (row->type == RP_DRAWABLE) return g_strdup_printf("%s (-1: none; default -1)", row->help);
  if (row->type == RP_CHOICE) {
    char *choices = choice_text(row);
    char *text = g_strdup_printf("%s %s (default %d)", row->help, choices, (int)row->default_value);
    g_free(choices);
    return text;
  }
  return g_strdup_printf("%s (%s <= %s <= %s; default %s)", row->help,
                         g_ascii_formatd(low, sizeof low, "%.15g", row->minimum), row->key,
                         g_ascii_formatd(high, sizeof high, "%.15g", row->maximum),
                         g_ascii_formatd(value, sizeof value, "%.15g", row->default_value));
}

static GimpPDBArgType type_of(const rp_argument *row) {
  switch (row->type) {
    case RP_DOUBLE: return GIMP_PDB_FLOAT;
    case RP_DRAWABLE: return GIMP_PDB_DRAWABLE;
    default: return GIMP_PDB_INT32;
  }
}

static void register_icon(const char *procedure) {
  char *icon = rp_own_file(gimp_get_progname(), "recede.svg");
  if (icon) gimp_plugin_icon_register(procedure, GIMP_ICON_TYPE_IMAGE_FILE, (const guint8 *)icon);
  g_free(icon);
}

/* What a script must give. Late ones stand at the end, and have their defaults then. */
static const rp_argument *in_scripts(rp_procedure procedure, int *count) {
  const rp_argument *rows = rp_arguments(procedure, count);
  while (*count > 0 && rows[*count - 1].late) --*count;
  return rows;
}

static void install(rp_procedure procedure) {
  GimpParamDef definitions[FIXED_ARGUMENTS + RP_MAX_ARGUMENTS] = {
      {GIMP_PDB_INT32, "run-mode",
       "The run mode { RUN-INTERACTIVE (0), RUN-NONINTERACTIVE (1), RUN-WITH-LAST-VALS (2) }"},
      {GIMP_PDB_IMAGE, "image", "Input image"},
      {GIMP_PDB_DRAWABLE, "drawable", "Input drawable"},
  };
  static const GimpParamDef new_image = {GIMP_PDB_IMAGE, "new-image", "The image that was made"};
  int count;
  const rp_argument *rows = in_scripts(procedure, &count);
  for (int i = 0; i < count; i++)
    definitions[FIXED_ARGUMENTS + i] =
        (GimpParamDef){type_of(&rows[i]), (gchar *)rows[i].key, description(&rows[i])};
  const char *name = rp_procedure_name(procedure);
  gimp_install_procedure(name, rp_procedure_blurb(procedure), rp_procedure_help(procedure),
                         "The Recede developers", "The Recede developers", "2026",
                         rp_procedure_label(procedure), "RGB*, GRAY*", GIMP_PLUGIN,
                         FIXED_ARGUMENTS + count, procedure == RP_SYNTHESIZE ? 1 : 0, definitions,
                         procedure == RP_SYNTHESIZE ? &new_image : NULL);
  gimp_plugin_menu_register(name, procedure == RP_FILL ? "<Image>/Filters/Enhance"
                                                       : "<Image>/Filters/Render/Pattern");
  register_icon(name);
  for (int i = 0; i < count; i++) g_free(definitions[FIXED_ARGUMENTS + i].description);
}

static void register_help(void) {
  char *folder = rp_own_file(gimp_get_progname(), "help");
  char *uri = folder ? g_filename_to_uri(folder, NULL, NULL) : NULL;
  if (uri) gimp_plugin_help_register("recede-help", uri);
  g_free(uri);
  g_free(folder);
}

static void query(void) {
  rp_translations_start(gimp_get_progname());
  gimp_plugin_domain_register(RP_DOMAIN, bindtextdomain(RP_DOMAIN, NULL));
  register_help();
  for (int i = 0; i < RP_PROCEDURES; i++) install((rp_procedure)i);
}

static double number(const GimpParam *param) {
  switch (param->type) {
    case GIMP_PDB_FLOAT: return param->data.d_float;
    case GIMP_PDB_DRAWABLE: return param->data.d_drawable;
    default: return param->data.d_int32;
  }
}

/* FALSE: wrong number of arguments. */
static gboolean take_arguments(rp_settings *settings, GimpRunMode mode, int given,
                               const GimpParam *params) {
  int count;
  in_scripts(settings->procedure, &count);
  if (mode != GIMP_RUN_NONINTERACTIVE) {
    rp_settings last;
    const char *name = rp_procedure_name(settings->procedure);
    if (gimp_get_data_size(name) == (gint)sizeof last && gimp_get_data(name, &last))
      *settings = last;
    return TRUE;
  }
  if (given != FIXED_ARGUMENTS + count) return FALSE;
  for (int i = 0; i < count; i++) settings->values[i] = number(&params[FIXED_ARGUMENTS + i]);
  return TRUE;
}

/* A source chosen last time may belong to another image, be gone, or be what is filled now. */
static void forget_lost_source(rp_settings *settings, const rp_host *host) {
  if (settings->procedure != RP_FILL) return;
  gint32 source = (gint32)rp_settings_get(settings, "source");
  if (source >= 0 && (source == host->drawable || !gimp_item_is_valid(source) ||
                      gimp_item_get_image(source) != host->image))
    rp_settings_set(settings, "source", -1);
}

static void finish(const rp_host *host, const rp_settings *settings, GimpRunMode mode) {
  if (mode == GIMP_RUN_NONINTERACTIVE) return;
  if (host->new_image >= 0) gimp_display_new(host->new_image);
  gimp_displays_flush();
  if (mode == GIMP_RUN_INTERACTIVE)
    gimp_set_data(rp_procedure_name(settings->procedure), settings, sizeof *settings);
}

static GimpPDBStatusType status_of(rp_outcome outcome) {
  switch (outcome) {
    case RP_DONE: return GIMP_PDB_SUCCESS;
    case RP_CANCELLED: return GIMP_PDB_CANCEL;
    case RP_CALLING_ERROR: return GIMP_PDB_CALLING_ERROR;
    default: return GIMP_PDB_EXECUTION_ERROR;
  }
}

static rp_outcome run_with(rp_host *host, rp_procedure procedure, GimpRunMode mode, int given,
                           const GimpParam *params, char **message) {
  rp_settings settings;
  rp_settings_init(&settings, procedure);
  if (!take_arguments(&settings, mode, given, params)) {
    *message = g_strdup(_("Wrong number of arguments."));
    return RP_CALLING_ERROR;
  }
  if (mode != GIMP_RUN_NONINTERACTIVE) forget_lost_source(&settings, host);
  rp_outcome outcome = rp_procedure_run(host, &settings, mode == GIMP_RUN_INTERACTIVE, message);
  if (outcome == RP_DONE) finish(host, &settings, mode);
  return outcome;
}

static void run(const gchar *name, gint given, const GimpParam *params, gint *returned,
                GimpParam **values) {
  static GimpParam result[2];
  static char *message; /* GIMP reads it after we return */
  rp_host host = {params[1].data.d_image, params[2].data.d_drawable, -1, -1};
  rp_translations_start(gimp_get_progname());
  gegl_init(NULL, NULL);
  rp_procedure procedure = strcmp(name, rp_procedure_name(RP_FILL)) == 0 ? RP_FILL : RP_SYNTHESIZE;
  rp_outcome outcome =
      run_with(&host, procedure, (GimpRunMode)params[0].data.d_int32, given, params, &message);
  result[0].type = GIMP_PDB_STATUS;
  result[0].data.d_status = status_of(outcome);
  *values = result;
  *returned = 1;
  if (outcome == RP_DONE && procedure == RP_SYNTHESIZE) {
    result[1].type = GIMP_PDB_IMAGE;
    result[1].data.d_image = host.new_image;
    *returned = 2;
  } else if (message) {
    result[1].type = GIMP_PDB_STRING;
    result[1].data.d_string = message;
    *returned = 2;
  }
}

const GimpPlugInInfo PLUG_IN_INFO = {NULL, NULL, query, run};

MAIN()
