/* A run that the dialog waits for. */
#include "watch.h"

#include <string.h>

#include "messages.h"

static gboolean show_state(gpointer user) {
  rp_watch *watch = user;
  rp_state state = rp_worker_state(watch->worker);
  const char *label = rp_stage_label(state.stage);
  if (strcmp(label, gtk_label_get_text(GTK_LABEL(watch->status))) != 0)
    gtk_label_set_text(GTK_LABEL(watch->status), label);
  gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(watch->progress), CLAMP(state.fraction, 0, 1));
  return G_SOURCE_CONTINUE;
}

/* ------------------------------------------------------------------------------------- hold -- */

static gboolean stays(rp_watch *watch, GtkWidget *widget) {
  gint response = gtk_dialog_get_response_for_widget(GTK_DIALOG(watch->dialog), widget);
  return widget == watch->status || widget == watch->progress || response == GTK_RESPONSE_CANCEL ||
         response == GTK_RESPONSE_HELP;
}

static gboolean has_what_stays(rp_watch *watch, GtkWidget *widget) {
  GtkWidget *cancel =
      gtk_dialog_get_widget_for_response(GTK_DIALOG(watch->dialog), GTK_RESPONSE_CANCEL);
  return gtk_widget_is_ancestor(watch->status, widget) ||
         gtk_widget_is_ancestor(watch->progress, widget) || gtk_widget_is_ancestor(cancel, widget);
}

/* Whatever the host's dialog is made of, GIMP 3's buttons for saved settings among it. */
static void hold(GtkWidget *widget, gpointer user) {
  rp_watch *watch = user;
  if (stays(watch, widget)) return;
  if (has_what_stays(watch, widget)) {
    gtk_container_foreach(GTK_CONTAINER(widget), hold, watch);
  } else if (gtk_widget_get_sensitive(widget)) {
    gtk_widget_set_sensitive(widget, FALSE);
    watch->held = g_slist_prepend(watch->held, widget);
  }
}

static void let_go(rp_watch *watch) {
  for (GSList *each = watch->held; each; each = each->next)
    gtk_widget_set_sensitive(each->data, TRUE);
  g_clear_pointer(&watch->held, g_slist_free);
}

/* -------------------------------------------------------------------------------------- run -- */

static void on_response(GtkDialog *dialog, gint response, gpointer user) {
  (void)dialog;
  if (response == GTK_RESPONSE_CANCEL || response == GTK_RESPONSE_DELETE_EVENT)
    ((rp_watch *)user)->cancelled = TRUE;
}

static gboolean keep_open(GtkWidget *dialog, GdkEvent *event, gpointer user) {
  (void)dialog, (void)event;
  ((rp_watch *)user)->cancelled = TRUE;
  return TRUE;
}

void rp_watch_run(rp_request *request, gpointer user) {
  rp_watch *watch = user;
  gulong response = g_signal_connect(watch->dialog, "response", G_CALLBACK(on_response), watch);
  gulong closing = g_signal_connect(watch->dialog, "delete-event", G_CALLBACK(keep_open), watch);
  watch->cancelled = FALSE;
  /* A header bar, too, which is no child of the window but a part. */
  gtk_container_forall(GTK_CONTAINER(watch->dialog), hold, watch);
  watch->worker = rp_worker_start(request);
  show_state(watch);
  guint ticks = g_timeout_add(RP_TELL_EVERY_MS, show_state, watch);
  while (!rp_worker_state(watch->worker).finished) {
    gtk_main_iteration(); /* waits for the next tick at the longest */
    if (watch->cancelled) rp_worker_cancel(watch->worker);
  }
  g_source_remove(ticks);
  rp_worker_finish(&watch->worker);
  let_go(watch);
  gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(watch->progress), 0);
  g_signal_handler_disconnect(watch->dialog, response);
  g_signal_handler_disconnect(watch->dialog, closing);
}
