/* panel.h - the part of the dialog that both hosts share: preview, what it shows, Estimate, what
 * happens in the background, and the run itself with its progress. */
#ifndef RP_PANEL_H
#define RP_PANEL_H

#include "host.h"
#include "toolkit.h"

typedef struct rp_panel rp_panel;

#define RP_RESPONSE_RESET 1 /* of the dialog's Reset; GIMP 3's own dialog has this number, too */

/* The panel wants a control to show another value. The host then calls rp_panel_changed() for it as
 * for any change. */
typedef void (*rp_set_func)(gpointer user, const char *key, double value);

/* settings and picture stay the caller's and must outlive the panel. NULL: no memory. */
rp_panel *rp_panel_new(rp_host *host, rp_settings *settings, rp_picture *picture, rp_set_func set,
                       gpointer user);
GtkWidget *rp_panel_widget(rp_panel *panel);
/* Once the dialog is put together: the panel looks after it. */
void rp_panel_attach(rp_panel *panel, GtkWidget *dialog);
/* A control has another value, and settings has it too. Not heeded during a run. */
void rp_panel_changed(rp_panel *panel, const char *key);
/* Several have, at once: Reset, presets. No angle among them was set by hand. */
void rp_panel_changed_all(rp_panel *panel);
/* The run that OK asks for: keeps the dialog alive, shows progress; the dialog's Cancel and close
 * button stop it. TRUE: done. FALSE: the panel says why not. */
gboolean rp_panel_compute(rp_panel *panel, rp_request *request);
void rp_panel_free(rp_panel *panel);

#endif
