/* GIMP 3's dialog: GimpProcedureDialog's controls beside the shared panel. */
#include <libgimp/gimp.h>
#include <libgimp/gimpui.h>
#include <string.h>

#include "../common/intl.h"
#include "../common/panel.h"
#include "host.h"
#include "settings.h"

typedef struct {
  rp_host *host;
  rp_settings *settings;
  rp_panel *panel;
  GimpProcedureDialog *dialog;
  GtkWidget *source; /* combo box, or NULL */
} dialog;

/* ---------------------------------------------------------------------------------- changes -- */

/* Reset and Load set all values before they tell the first: then others than that one differ. */
static void on_config(GObject *config, GParamSpec *spec, gpointer user) {
  dialog *d = user;
  rp_settings before = *d->settings;
  int index = rp_settings_index(&before, spec->name);
  rp_settings_from_config(d->settings, GIMP_PROCEDURE_CONFIG(config));
  if (memcmp(&before, d->settings, sizeof before) == 0) return;
  if (d->source)
    gimp_int_combo_box_set_active(GIMP_INT_COMBO_BOX(d->source),
                                  (gint)rp_settings_get(d->settings, "source"));
  if (index >= 0) before.values[index] = d->settings->values[index];
  if (memcmp(&before, d->settings, sizeof before) == 0)
    rp_panel_changed(d->panel, spec->name);
  else
    rp_panel_changed_all(d->panel);
}

static void set_by_key(gpointer user, const char *key, double value) {
  dialog *d = user;
  rp_config_set(d->host->config, d->settings->procedure, key, value);
}

/* --------------------------------------------------------------------------------- controls -- */

static gboolean of_this_image(GimpImage *image, GimpItem *item, gpointer user) {
  const dialog *d = user;
  return image == d->host->image && item != GIMP_ITEM(d->host->drawable);
}

static void on_source(GtkWidget *combo, gpointer user) {
  gint id;
  dialog *d = user;
  if (gimp_int_combo_box_get_active(GIMP_INT_COMBO_BOX(combo), &id) &&
      id != (gint)rp_settings_get(d->settings, "source"))
    set_by_key(d, "source", id);
}

/* GIMP's own chooser of drawables cannot be set to none. */
static GtkWidget *source_control(dialog *d) {
  int count;
  const rp_argument *row = &rp_arguments(RP_FILL, &count)[rp_settings_index(d->settings, "source")];
  GtkWidget *box = rp_ui_box(GTK_ORIENTATION_HORIZONTAL, 12);
  GtkWidget *label = gtk_label_new_with_mnemonic(_(row->label));
  d->source = gimp_drawable_combo_box_new(of_this_image, d, NULL);
  gimp_int_combo_box_prepend(GIMP_INT_COMBO_BOX(d->source), GIMP_INT_STORE_VALUE, -1,
                             GIMP_INT_STORE_LABEL, _("Around the selection"), -1);
  gimp_int_combo_box_connect(GIMP_INT_COMBO_BOX(d->source),
                             (gint)rp_settings_get(d->settings, "source"), G_CALLBACK(on_source), d,
                             NULL);
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), d->source);
  gtk_widget_set_tooltip_text(d->source, _(row->help));
  gtk_box_pack_start(GTK_BOX(box), label, FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(box), d->source, TRUE, TRUE, 0);
  gtk_widget_show_all(box);
  return box;
}

static void on_new_seed(GtkButton *button, gpointer user) {
  (void)button;
  set_by_key(user, "seed", g_random_int_range(1, G_MAXINT32));
}

static GtkWidget *new_seed_button(dialog *d) {
  GtkWidget *button = gtk_button_new_with_mnemonic(_("_New seed"));
  g_signal_connect(button, "clicked", G_CALLBACK(on_new_seed), d);
  gtk_widget_set_halign(button, GTK_ALIGN_END);
  gtk_widget_show(button);
  return button;
}

/* A slider for what is an angle; GIMP's own choice for the rest. */
static GList *control_names(const dialog *d) {
  int count;
  GList *names = NULL;
  const rp_argument *rows = rp_arguments(d->settings->procedure, &count);
  for (int i = 0; i < count; i++) {
    if (rows[i].type == RP_DRAWABLE) continue;
    if (rows[i].type == RP_DOUBLE) gimp_procedure_dialog_get_scale_entry(d->dialog, rows[i].key, 1);
    names = g_list_append(names, (gpointer)rows[i].key);
  }
  return names;
}

/* The button stands right of the number it changes. */
static void add_new_seed(dialog *d) {
  GtkWidget *seed = gimp_procedure_dialog_get_widget(d->dialog, "seed", G_TYPE_NONE);
  gtk_grid_attach(GTK_GRID(seed), new_seed_button(d), 2, 0, 1, 1);
}

static GtkWidget *build_controls(dialog *d) {
  GList *names = control_names(d);
  GtkWidget *box = gimp_procedure_dialog_fill_box_list(d->dialog, "recede-controls", names);
  g_list_free(names);
  if (d->settings->procedure == RP_FILL)
    gtk_box_pack_start(GTK_BOX(box), source_control(d), FALSE, FALSE, 0);
  add_new_seed(d);
  gtk_widget_set_valign(box, GTK_ALIGN_START);
  return box;
}

static void lay_out(dialog *d, GtkWidget *controls) {
  GtkWidget *row = gimp_procedure_dialog_fill_box(d->dialog, "recede-row", "recede-controls", NULL);
  gtk_orientable_set_orientation(GTK_ORIENTABLE(row), GTK_ORIENTATION_HORIZONTAL);
  gtk_box_set_spacing(GTK_BOX(row), 12);
  GtkWidget *panel = rp_panel_widget(d->panel);
  gtk_box_pack_start(GTK_BOX(row), panel, TRUE, TRUE, 0);
  gtk_box_reorder_child(GTK_BOX(row), panel, 0);
  /* What a larger dialog has more is the preview's. */
  gtk_widget_set_hexpand(controls, FALSE);
  gtk_box_set_child_packing(GTK_BOX(row), controls, FALSE, TRUE, 0, GTK_PACK_START);
  gimp_procedure_dialog_fill(d->dialog, "recede-row", NULL);
  gtk_widget_set_vexpand(row, TRUE);
}

static gboolean ask(dialog *d, rp_request *request) {
  while (gimp_procedure_dialog_run(d->dialog))
    if (rp_panel_compute(d->panel, request)) return TRUE;
  return FALSE;
}

gboolean rp_host_dialog(rp_host *host, rp_settings *settings, rp_picture *picture,
                        rp_request *request) {
  dialog d = {.host = host, .settings = settings};
  gimp_ui_init("recede");
  d.dialog = GIMP_PROCEDURE_DIALOG(gimp_procedure_dialog_new(
      host->procedure, host->config,
      settings->procedure == RP_FILL ? _("Perspective Fill") : _("Perspective Texture")));
  GtkWidget *controls = build_controls(&d);
  d.panel = rp_panel_new(host, settings, picture, set_by_key, &d);
  if (!d.panel) {
    gimp_message(rp_no_memory());
    gtk_widget_destroy(GTK_WIDGET(d.dialog));
    return FALSE;
  }
  lay_out(&d, controls);
  rp_panel_attach(d.panel, GTK_WIDGET(d.dialog));
  gulong notify = g_signal_connect(host->config, "notify", G_CALLBACK(on_config), &d);
  gboolean done = ask(&d, request);
  g_signal_handler_disconnect(host->config, notify);
  rp_panel_free(d.panel);
  gtk_widget_destroy(GTK_WIDGET(d.dialog));
  return done;
}
