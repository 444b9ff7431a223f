/* GIMP 3: the shared arguments as GParamSpecs, and their values in a procedure's config. */
#include "settings.h"

#include "../common/intl.h"

static GimpChoice *choice_of(const rp_argument *row) {
  GimpChoice *choice = gimp_choice_new();
  for (int i = 0; i <= (int)row->maximum; i++)
    gimp_choice_add(choice, row->choices[i], i, _(row->choice_labels[i]), NULL);
  return choice;
}

static void add_argument(GimpProcedure *procedure, const rp_argument *row) {
  const char *label = _(row->label), *help = _(row->help);
  switch (row->type) {
    case RP_DOUBLE:
      gimp_procedure_add_double_argument(procedure, row->key, label, help, row->minimum,
                                         row->maximum, row->default_value, G_PARAM_READWRITE);
      break;
    case RP_INT:
      gimp_procedure_add_int_argument(procedure, row->key, label, help, (int)row->minimum,
                                      (int)row->maximum, (int)row->default_value,
                                      G_PARAM_READWRITE);
      break;
    case RP_CHOICE:
      gimp_procedure_add_choice_argument(procedure, row->key, label, help, choice_of(row),
                                         row->choices[(int)row->default_value], G_PARAM_READWRITE);
      break;
    default:
      gimp_procedure_add_drawable_argument(procedure, row->key, label, help, TRUE,
                                           G_PARAM_READWRITE);
  }
}

void rp_add_arguments(GimpProcedure *procedure, rp_procedure which) {
  int count;
  const rp_argument *rows = rp_arguments(which, &count);
  for (int i = 0; i < count; i++) add_argument(procedure, &rows[i]);
}

static double value_in(GimpProcedureConfig *config, const rp_argument *row) {
  GimpDrawable *drawable;
  double number;
  int whole;
  switch (row->type) {
    case RP_DOUBLE: return g_object_get(config, row->key, &number, NULL), number;
    case RP_INT: return g_object_get(config, row->key, &whole, NULL), whole;
    case RP_CHOICE: return gimp_procedure_config_get_choice_id(config, row->key);
    default:
      g_object_get(config, row->key, &drawable, NULL);
      number = drawable ? gimp_item_get_id(GIMP_ITEM(drawable)) : -1;
      g_clear_object(&drawable);
      return number;
  }
}

void rp_settings_from_config(rp_settings *settings, GimpProcedureConfig *config) {
  int count;
  const rp_argument *rows = rp_arguments(settings->procedure, &count);
  for (int i = 0; i < count; i++) settings->values[i] = value_in(config, &rows[i]);
}

void rp_config_set(GimpProcedureConfig *config, rp_procedure procedure, const char *key,
                   double value) {
  int count;
  const rp_argument *row = rp_arguments(procedure, &count);
  while (g_strcmp0(row->key, key) != 0) row++;
  switch (row->type) {
    case RP_DOUBLE: g_object_set(config, key, value, NULL); break;
    case RP_INT: g_object_set(config, key, (int)value, NULL); break;
    case RP_CHOICE: g_object_set(config, key, row->choices[(int)value], NULL); break;
    default:
      g_object_set(config, key, value < 0 ? NULL : gimp_drawable_get_by_id((int)value), NULL);
  }
}
