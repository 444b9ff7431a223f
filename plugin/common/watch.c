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
  watch->worker = rp_worker_start(request);
  show_state(watch);
  guint ticks = g_timeout_add(RP_TELL_EVERY_MS, show_state, watch);
  while (!rp_worker_state(watch->worker).finished) {
    gtk_main_iteration(); /* waits for the next tick at the longest */
    if (watch->cancelled) rp_worker_cancel(watch->worker);
  }
  g_source_remove(ticks);
  rp_worker_finish(&watch->worker);
  gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(watch->progress), 0);
  g_signal_handler_disconnect(watch->dialog, response);
  g_signal_handler_disconnect(watch->dialog, closing);
}
