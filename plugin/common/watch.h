/* watch.h - a run that the dialog waits for: it lives on and shows the progress; its Cancel and
 * close button stop the run, not the dialog. Nothing else in it can be used meanwhile. */
#ifndef RP_WATCH_H
#define RP_WATCH_H

#include <gtk/gtk.h>

#include "worker.h"

typedef struct {
  GtkWidget *dialog, *status, *progress; /* a GtkDialog, a label, a progress bar */
  rp_worker *worker;                     /* NULL: nothing is running */
  gboolean cancelled;
  GSList *held; /* widgets that were made insensitive */
} rp_watch;

/* An rp_runner; watch: an rp_watch. */
void rp_watch_run(rp_request *request, gpointer watch);

#endif
