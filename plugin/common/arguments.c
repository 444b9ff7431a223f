/* The procedures' arguments: rows of the core's table, and the few that only a host can have. */
#include "arguments.h"

#include <string.h>

#include "intl.h"

static const char *const result_nicks[] = {"in-place", "new-layer", NULL};
static const char *const result_labels[] = {N_("This layer"), N_("A new layer above it"), NULL};

/* A picture's orientation as a line or four points has no place among a procedure's arguments: the
 * dialog's handles turn them into angles. */
#define LAST_HOST_ORIENTATION RECEDE_ORIENTATION_FRONTAL

static const rp_argument width_row = {
    "width", N_("_Width"), N_("Width of the new image"), "px", RP_INT, 1, 262144, 1024, NULL,
    NULL,    FALSE};
static const rp_argument height_row = {
    "height", N_("Hei_ght"), N_("Height of the new image"), "px", RP_INT, 1, 262144, 768, NULL,
    NULL,     FALSE};
static const rp_argument source_row = {
    "source",
    N_("Cop_y from"),
    N_("Where to copy from: the light parts of a channel or layer; none: around the "
       "selection"),
    "",
    RP_DRAWABLE,
    -1,
    G_MAXINT32,
    -1,
    NULL,
    NULL,
    FALSE};
static const rp_argument result_row = {
    "result",
    N_("_Goes into"),
    N_("Whether the fill goes into the layer or into a new one above it"),
    "",
    RP_CHOICE,
    0,
    1,
    RP_IN_PLACE,
    result_nicks,
    result_labels,
    FALSE};

static rp_argument tables[RP_PROCEDURES][RP_MAX_ARGUMENTS];
static int counts[RP_PROCEDURES];

static rp_argument from_row(const recede_param_info *row) {
  rp_argument argument = {row->key,     row->label,         row->help,    row->unit,
                          RP_DOUBLE,    row->minimum,       row->maximum, row->default_value,
                          row->choices, row->choice_labels, FALSE};
  if (row->type == RECEDE_PARAM_INT) argument.type = RP_INT;
  if (row->type == RECEDE_PARAM_CHOICE) argument.type = RP_CHOICE;
  if (strcmp(row->key, "orientation") == 0) argument.maximum = LAST_HOST_ORIENTATION;
  argument.late = strcmp(row->key, "exemplar") == 0;
  return argument;
}

static void append(rp_procedure procedure, rp_argument argument) {
  g_assert(counts[procedure] < RP_MAX_ARGUMENTS);
  tables[procedure][counts[procedure]++] = argument;
}

static void build(rp_procedure procedure) {
  size_t rows;
  const recede_param_info *row = recede_param_table(&rows);
  if (procedure == RP_SYNTHESIZE) {
    append(procedure, width_row);
    append(procedure, height_row);
  }
  for (; rows > 0; row++, rows--) {
    if (!(row->flags & RECEDE_PARAM_HOST)) continue;
    if (row->flags & RECEDE_PARAM_SYNTHESIS && procedure != RP_SYNTHESIZE) continue;
    append(procedure, from_row(row));
    if (procedure == RP_FILL && strcmp(row->key, "surface") == 0) append(procedure, source_row);
  }
  if (procedure == RP_FILL) append(procedure, result_row);
}

const rp_argument *rp_arguments(rp_procedure procedure, int *count) {
  if (counts[procedure] == 0) build(procedure);
  *count = counts[procedure];
  return tables[procedure];
}

const char *rp_procedure_name(rp_procedure procedure) {
  return procedure == RP_FILL ? "plug-in-recede-fill" : "plug-in-recede-synthesize";
}

const char *rp_procedure_label(rp_procedure procedure) {
  return procedure == RP_FILL ? N_("_Perspective Fill…") : N_("Perspective _Texture…");
}

const char *rp_procedure_blurb(rp_procedure procedure) {
  return procedure == RP_FILL
             ? N_("Fill the selection with the texture of the receding plane around it")
             : N_("Make a new image of a receding plane from the texture of this one");
}

const char *rp_procedure_help(rp_procedure procedure) {
  return procedure == RP_FILL
             ? N_("Fills the selected part of a picture of a receding plane (a street, a floor, a "
                  "beach) from its surroundings, so that the texture gets smaller towards the "
                  "horizon and its lines run to the same vanishing point.")
             : N_("Synthesizes a picture of a receding plane, of any size, whose texture is that "
                  "of the layer or of its selected part.");
}

void rp_settings_init(rp_settings *settings, rp_procedure procedure) {
  int count;
  const rp_argument *rows = rp_arguments(procedure, &count);
  memset(settings, 0, sizeof *settings);
  settings->procedure = procedure;
  for (int i = 0; i < count; i++) settings->values[i] = rows[i].default_value;
}

int rp_settings_index(const rp_settings *settings, const char *key) {
  int count;
  const rp_argument *rows = rp_arguments(settings->procedure, &count);
  for (int i = 0; i < count; i++)
    if (strcmp(rows[i].key, key) == 0) return i;
  return -1;
}

double rp_settings_get(const rp_settings *settings, const char *key) {
  int index = rp_settings_index(settings, key);
  g_return_val_if_fail(index >= 0, 0);
  return settings->values[index];
}

void rp_settings_set(rp_settings *settings, const char *key, double value) {
  int index = rp_settings_index(settings, key);
  g_return_if_fail(index >= 0);
  settings->values[index] = value;
}

gboolean rp_settings_lay(const rp_settings *settings) {
  return settings->procedure == RP_SYNTHESIZE &&
         (int)rp_settings_get(settings, "exemplar") == RECEDE_EXEMPLAR_FRONTAL;
}

static gboolean in_range(const rp_argument *row, double value, char **message) {
  char text[G_ASCII_DTOSTR_BUF_SIZE], low[G_ASCII_DTOSTR_BUF_SIZE], high[G_ASCII_DTOSTR_BUF_SIZE];
  if (value >= row->minimum && value <= row->maximum) return TRUE;
  *message = g_strdup_printf(_("%s: %s is not within %s..%s."), row->key,
                             g_ascii_formatd(text, sizeof text, "%.15g", value),
                             g_ascii_formatd(low, sizeof low, "%.15g", row->minimum),
                             g_ascii_formatd(high, sizeof high, "%.15g", row->maximum));
  return FALSE;
}

static gboolean is_param(const char *key) {
  size_t rows;
  const recede_param_info *row = recede_param_table(&rows);
  for (; rows > 0; row++, rows--)
    if (strcmp(row->key, key) == 0) return TRUE;
  return FALSE;
}

static gboolean set_param(recede_params *params, const rp_argument *row, double value,
                          char **message) {
  char number[G_ASCII_DTOSTR_BUF_SIZE], reason[400];
  const char *text = row->type == RP_CHOICE ? row->choices[(int)value]
                                            : g_ascii_dtostr(number, sizeof number, value);
  if (recede_params_set(params, row->key, text, reason, sizeof reason) == RECEDE_OK) return TRUE;
  *message = g_strdup_printf("%s.", reason);
  return FALSE;
}

gboolean rp_settings_params(const rp_settings *settings, recede_params *params, char **message) {
  int count;
  const rp_argument *rows = rp_arguments(settings->procedure, &count);
  recede_params_init(params);
  for (int i = 0; i < count; i++) {
    if (!in_range(&rows[i], settings->values[i], message)) return FALSE;
    if (is_param(rows[i].key) && !set_param(params, &rows[i], settings->values[i], message))
      return FALSE;
  }
  return TRUE;
}
