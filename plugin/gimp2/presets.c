/* Presets: one key file a procedure, one group a preset, nicks and numbers as in scripts. */
#include "presets.h"

#include <libgimp/gimp.h>
#include <libgimp/gimpui.h>

#include "../common/intl.h"

typedef struct {
  const rp_settings *settings;
  void (*chosen)(gpointer user, const rp_settings *settings);
  gpointer user;
  GtkWidget *combo;
  GKeyFile *file;
  char *path;
} presets;

static void save_file(const presets *p) {
  GError *error = NULL;
  gsize length;
  char *text = g_key_file_to_data(p->file, &length, NULL);
  if (!g_file_set_contents(p->path, text, (gssize)length, &error)) {
    g_message(_("The presets could not be saved: %s"), error->message);
    g_error_free(error);
  }
  g_free(text);
}

static void write_preset(const presets *p, const char *name) {
  int count;
  const rp_argument *rows = rp_arguments(p->settings->procedure, &count);
  for (int i = 0; i < count; i++) {
    double value = p->settings->values[i];
    if (rows[i].type == RP_DRAWABLE) continue; /* belongs to one image */
    if (rows[i].type == RP_CHOICE)
      g_key_file_set_string(p->file, name, rows[i].key, rows[i].choices[(int)value]);
    else
      g_key_file_set_double(p->file, name, rows[i].key, value);
  }
}

static double read_value(const presets *p, const char *name, const rp_argument *row) {
  double value = row->default_value;
  if (!g_key_file_has_key(p->file, name, row->key, NULL)) return value;
  if (row->type != RP_CHOICE)
    value = g_key_file_get_double(p->file, name, row->key, NULL);
  else {
    char *nick = g_key_file_get_string(p->file, name, row->key, NULL);
    for (int i = 0; i <= (int)row->maximum; i++)
      if (g_strcmp0(row->choices[i], nick) == 0) value = i;
    g_free(nick);
  }
  return CLAMP(value, row->minimum, row->maximum);
}

/* Typing tells of a change with every key, also when what is there by then is a preset's name. */
static void on_chosen(GtkComboBox *combo, gpointer user) {
  presets *p = user;
  rp_settings settings = *p->settings;
  int count;
  const rp_argument *rows = rp_arguments(settings.procedure, &count);
  if (gtk_combo_box_get_active(combo) < 0) return;
  char *name = gtk_combo_box_get_active_text(combo);
  gtk_combo_box_set_active(combo, -1); /* or to choose it again would tell of no change */
  if (name && g_key_file_has_group(p->file, name)) {
    for (int i = 0; i < count; i++)
      if (rows[i].type != RP_DRAWABLE) settings.values[i] = read_value(p, name, &rows[i]);
    p->chosen(p->user, &settings);
  }
  g_free(name);
}

static void list_names(presets *p) {
  gtk_list_store_clear(GTK_LIST_STORE(gtk_combo_box_get_model(GTK_COMBO_BOX(p->combo))));
  char **names = g_key_file_get_groups(p->file, NULL);
  for (int i = 0; names[i]; i++) gtk_combo_box_append_text(GTK_COMBO_BOX(p->combo), names[i]);
  g_strfreev(names);
}

static char *typed_name(const presets *p) {
  GtkWidget *entry = gtk_bin_get_child(GTK_BIN(p->combo));
  char *name = g_strdelimit(g_strdup(gtk_entry_get_text(GTK_ENTRY(entry))), "[]\n", ' ');
  return g_strstrip(name);
}

static void on_save(GtkButton *button, gpointer user) {
  presets *p = user;
  (void)button;
  char *name = typed_name(p);
  if (name[0]) {
    write_preset(p, name);
    save_file(p);
    list_names(p);
  }
  g_free(name);
}

static void on_delete(GtkButton *button, gpointer user) {
  presets *p = user;
  (void)button;
  char *name = typed_name(p);
  if (g_key_file_remove_group(p->file, name, NULL)) {
    save_file(p);
    list_names(p);
    gtk_entry_set_text(GTK_ENTRY(gtk_bin_get_child(GTK_BIN(p->combo))), "");
  }
  g_free(name);
}

static void free_presets(gpointer data) {
  presets *p = data;
  g_key_file_free(p->file);
  g_free(p->path);
  g_free(p);
}

static GtkWidget *icon_button(const char *stock, const char *tooltip, GCallback clicked,
                              presets *p) {
  GtkWidget *button = gtk_button_new();
  gtk_container_add(GTK_CONTAINER(button), gtk_image_new_from_stock(stock, GTK_ICON_SIZE_MENU));
  gtk_widget_set_tooltip_text(button, tooltip);
  atk_object_set_name(gtk_widget_get_accessible(button), tooltip);
  g_signal_connect(button, "clicked", clicked, p);
  return button;
}

GtkWidget *rp_presets_new(const rp_settings *settings,
                          void (*chosen)(gpointer user, const rp_settings *settings),
                          gpointer user) {
  presets *p = g_new0(presets, 1);
  GtkWidget *row = gtk_hbox_new(FALSE, 6), *label = gtk_label_new_with_mnemonic(_("_Presets:"));
  *p = (presets){settings, chosen, user, gtk_combo_box_entry_new_text(), g_key_file_new(), NULL};
  char *name = g_strconcat(rp_procedure_name(settings->procedure), "-presets", NULL);
  p->path = gimp_personal_rc_file(name);
  g_key_file_load_from_file(p->file, p->path, G_KEY_FILE_NONE, NULL);
  g_free(name);
  list_names(p);
  gtk_widget_set_tooltip_text(p->combo, _("Choose a preset, or type a name and save"));
  gtk_label_set_mnemonic_widget(GTK_LABEL(label), gtk_bin_get_child(GTK_BIN(p->combo)));
  gtk_box_pack_start(GTK_BOX(row), label, FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(row), p->combo, TRUE, TRUE, 0);
  gtk_box_pack_start(GTK_BOX(row),
                     icon_button(GTK_STOCK_SAVE, _("Save preset"), G_CALLBACK(on_save), p), FALSE,
                     FALSE, 0);
  gtk_box_pack_start(GTK_BOX(row),
                     icon_button(GTK_STOCK_DELETE, _("Delete preset"), G_CALLBACK(on_delete), p),
                     FALSE, FALSE, 0);
  g_signal_connect(p->combo, "changed", G_CALLBACK(on_chosen), p);
  g_object_set_data_full(G_OBJECT(row), "recede-presets", p, free_presets);
  return row;
}
