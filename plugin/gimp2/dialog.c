/* GIMP 2.10's dialog: a control for every argument beside the shared panel. */
#include <libgimp/gimp.h>
#include <libgimp/gimpui.h>
#include <string.h>

#include "../common/intl.h"
#include "../common/panel.h"
#include "host.h"
#include "presets.h"

#define SCALE_WIDTH 160
#define SPIN_DIGITS 6

typedef struct {
  rp_host *host;
  rp_settings *settings;
  rp_panel *panel;
  GtkWidget *dialog, *table;
  gboolean showing; /* all settings are being shown: no control's change is told */
  GObject *controls[RP_MAX_ARGUMENTS]; /* adjustments of numbers, combo boxes of choices */
} dialog;

static const rp_argument *row_of(const dialog *d, int index) {
  int count;
  return &rp_arguments(d->settings->procedure, &count)[index];
}

static void changed(dialog *d, int index, double value) {
  if (d->settings->values[index] == value) return;
  d->settings->values[index] = value;
  if (d->panel && !d->showing) rp_panel_changed(d->panel, row_of(d, index)->key);
}

static int index_of(const dialog *d, const void *control) {
  int i = 0;
  while (d->controls[i] != control) i++;
  return i;
}

static void on_number(GtkAdjustment *adjustment, gpointer user) {
  changed(user, index_of(user, adjustment), gtk_adjustment_get_value(adjustment));
}

static void on_choice(GtkWidget *combo, gpointer user) {
  gint value;
  if (gimp_int_combo_box_get_active(GIMP_INT_COMBO_BOX(combo), &value))
    changed(user, index_of(user, combo), value);
}

static void set_control(dialog *d, int index, double value) {
  if (GTK_IS_ADJUSTMENT(d->controls[index]))
    gtk_adjustment_set_value(GTK_ADJUSTMENT(d->controls[index]), value);
  else
    gimp_int_combo_box_set_active(GIMP_INT_COMBO_BOX(d->controls[index]), (gint)value);
}

static void set_by_key(gpointer user, const char *key, double value) {
  dialog *d = user;
  set_control(d, rp_settings_index(d->settings, key), value);
}

static void show_settings(gpointer user, const rp_settings *settings) {
  dialog *d = user;
  int count;
  rp_arguments(settings->procedure, &count);
  d->showing = TRUE;
  for (int i = 0; i < count; i++) set_control(d, i, settings->values[i]);
  d->showing = FALSE;
  rp_panel_changed_all(d->panel);
}

/* --------------------------------------------------------------------------------- controls -- */

static void add_number(dialog *d, int index) {
  const rp_argument *row = row_of(d, index);
  char *label = g_strdup_printf(row->unit[0] ? "%s (%s):" : "%s:", _(row->label), row->unit);
  GtkObject *adjustment = gimp_scale_entry_new(
      GTK_TABLE(d->table), 0, index, label, SCALE_WIDTH, SPIN_DIGITS, d->settings->values[index],
      row->minimum, row->maximum, .5, 5, 1, TRUE, 0, 0, _(row->help), NULL);
  g_signal_connect(adjustment, "value-changed", G_CALLBACK(on_number), d);
  d->controls[index] = G_OBJECT(adjustment);
  g_free(label);
}

static GtkWidget *attach(dialog *d, int index, const char *label_text, GtkWidget *widget) {
  const rp_argument *row = row_of(d, index);
  char *text = g_strdup_printf("%s:", label_text);
  GtkWidget *label =
      gimp_table_attach_aligned(GTK_TABLE(d->table), 0, index, text, 0, .5, widget, 2, FALSE);
  gimp_help_set_help_data(widget, _(row->help), NULL);
  g_free(text);
  return label;
}

static void add_choice(dialog *d, int index) {
  const rp_argument *row = row_of(d, index);
  GtkWidget *combo = g_object_new(GIMP_TYPE_INT_COMBO_BOX, NULL);
  for (int i = 0; i <= (int)row->maximum; i++)
    gimp_int_combo_box_append(GIMP_INT_COMBO_BOX(combo), GIMP_INT_STORE_VALUE, i,
                              GIMP_INT_STORE_LABEL, _(row->choice_labels[i]), -1);
  attach(d, index, _(row->label), combo);
  d->controls[index] = G_OBJECT(combo);
  gimp_int_combo_box_connect(GIMP_INT_COMBO_BOX(combo), (gint)d->settings->values[index],
                             G_CALLBACK(on_choice), d);
}

static gboolean of_this_image(gint32 image, gint32 item, gpointer user) {
  const dialog *d = user;
  return image == d->host->image && item != d->host->drawable;
}

static void add_drawable(dialog *d, int index) {
  GtkWidget *combo = gimp_drawable_combo_box_new(of_this_image, d);
  gimp_int_combo_box_prepend(GIMP_INT_COMBO_BOX(combo), GIMP_INT_STORE_VALUE, -1,
                             GIMP_INT_STORE_LABEL, _("Around the selection"), -1);
  attach(d, index, _(row_of(d, index)->label), combo);
  d->controls[index] = G_OBJECT(combo);
  gimp_int_combo_box_connect(GIMP_INT_COMBO_BOX(combo), (gint)d->settings->values[index],
                             G_CALLBACK(on_choice), d);
}

static void on_new_seed(GtkButton *button, gpointer user) {
  dialog *d = user;
  (void)button;
  set_by_key(d, "seed", g_random_int_range(1, G_MAXINT32));
}

/* A whole number: too many of them for a slider. */
static GtkWidget *add_whole(dialog *d, int index) {
  const rp_argument *row = row_of(d, index);
  GtkWidget *box = rp_ui_box(GTK_ORIENTATION_HORIZONTAL, 6);
  GtkWidget *spin = gtk_spin_button_new_with_range(row->minimum, row->maximum, 1);
  GtkAdjustment *adjustment = gtk_spin_button_get_adjustment(GTK_SPIN_BUTTON(spin));
  gtk_adjustment_set_value(adjustment, d->settings->values[index]);
  gtk_box_pack_start(GTK_BOX(box), spin, TRUE, TRUE, 0);
  GtkWidget *label = attach(d, index, _(row->label), box);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), spin);
  g_signal_connect(adjustment, "value-changed", G_CALLBACK(on_number), d);
  d->controls[index] = G_OBJECT(adjustment);
  return box;
}

static void add_seed(dialog *d, int index) {
  GtkWidget *box = add_whole(d, index);
  GtkWidget *button = gtk_button_new_with_mnemonic(_("_New seed"));
  gtk_box_pack_start(GTK_BOX(box), button, FALSE, FALSE, 0);
  g_signal_connect(button, "clicked", G_CALLBACK(on_new_seed), d);
}

static void add_control(dialog *d, int index) {
  const rp_argument *row = row_of(d, index);
  if (strcmp(row->key, "seed") == 0)
    add_seed(d, index);
  else if (row->type == RP_INT)
    add_whole(d, index);
  else if (row->type == RP_CHOICE)
    add_choice(d, index);
  else if (row->type == RP_DRAWABLE)
    add_drawable(d, index);
  else
    add_number(d, index);
}

/* ----------------------------------------------------------------------------------- dialog -- */

static void build_dialog(dialog *d) {
  const char *name = rp_procedure_name(d->settings->procedure);
  d->dialog = gimp_dialog_new(
      d->settings->procedure == RP_FILL ? _("Perspective Fill") : _("Perspective Texture"),
      "recede", NULL, 0, gimp_standard_help_func, name, _("_Reset"), RP_RESPONSE_RESET,
      _("_Cancel"), GTK_RESPONSE_CANCEL, _("_OK"), GTK_RESPONSE_OK, NULL);
  gtk_dialog_set_default_response(GTK_DIALOG(d->dialog), GTK_RESPONSE_OK);
  gtk_dialog_set_alternative_button_order(GTK_DIALOG(d->dialog), GTK_RESPONSE_OK, RP_RESPONSE_RESET,
                                          GTK_RESPONSE_CANCEL, -1);
  gimp_window_set_transient(GTK_WINDOW(d->dialog));
}

static GtkWidget *build_controls(dialog *d) {
  int count;
  GtkWidget *column = rp_ui_box(GTK_ORIENTATION_VERTICAL, 12);
  rp_arguments(d->settings->procedure, &count);
  d->table = gtk_table_new(count, 3, FALSE);
  gtk_table_set_row_spacings(GTK_TABLE(d->table), 6);
  gtk_table_set_col_spacings(GTK_TABLE(d->table), 6);
  for (int i = 0; i < count; i++) add_control(d, i);
  gtk_box_pack_start(GTK_BOX(column), rp_presets_new(d->settings, show_settings, d), FALSE, FALSE,
                     0);
  gtk_box_pack_start(GTK_BOX(column), d->table, FALSE, FALSE, 0);
  gtk_widget_show_all(column);
  return column;
}

static void reset(dialog *d) {
  rp_settings defaults;
  rp_settings_init(&defaults, d->settings->procedure);
  show_settings(d, &defaults);
}

static gboolean ask(dialog *d, rp_request *request) {
  for (;;) {
    gint response = gimp_dialog_run(GIMP_DIALOG(d->dialog));
    if (response == RP_RESPONSE_RESET)
      reset(d);
    else if (response != GTK_RESPONSE_OK)
      return FALSE;
    else if (rp_panel_compute(d->panel, request))
      return TRUE;
  }
}

gboolean rp_host_dialog(rp_host *host, rp_settings *settings, rp_picture *picture,
                        rp_request *request) {
  dialog d = {.host = host, .settings = settings};
  gimp_ui_init("recede", FALSE);
  build_dialog(&d);
  GtkWidget *controls = build_controls(&d);
  d.panel = rp_panel_new(host, settings, picture, set_by_key, &d);
  if (!d.panel) {
    gimp_message(rp_no_memory());
    gtk_widget_destroy(d.dialog);
    return FALSE;
  }
  GtkWidget *row = rp_ui_box(GTK_ORIENTATION_HORIZONTAL, 12);
  gtk_container_set_border_width(GTK_CONTAINER(row), 12);
  gtk_box_pack_start(GTK_BOX(row), rp_panel_widget(d.panel), TRUE, TRUE, 0);
  gtk_box_pack_start(GTK_BOX(row), controls, FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(gtk_dialog_get_content_area(GTK_DIALOG(d.dialog))), row, TRUE, TRUE,
                     0);
  gtk_widget_show(row);
  rp_panel_attach(d.panel, d.dialog);
  gtk_widget_show(d.dialog);
  gboolean done = ask(&d, request);
  rp_panel_free(d.panel);
  gtk_widget_destroy(d.dialog);
  return done;
}
