/* presets.h - named settings that the user keeps, in GIMP's folder (2.10 has none for plug-ins). */
#ifndef RP_GIMP2_PRESETS_H
#define RP_GIMP2_PRESETS_H

#include <gtk/gtk.h>

#include "../common/arguments.h"

/* A row to choose, save and delete presets. settings: what is saved; chosen is called with the ones
 * of a preset. */
GtkWidget *rp_presets_new(const rp_settings *settings,
                          void (*chosen)(gpointer user, const rp_settings *settings),
                          gpointer user);

#endif
