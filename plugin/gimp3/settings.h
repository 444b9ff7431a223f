/* settings.h - GIMP 3: the shared arguments and values as a procedure's arguments and config. */
#ifndef RP_GIMP3_SETTINGS_H
#define RP_GIMP3_SETTINGS_H

#include <libgimp/gimp.h>

#include "../common/arguments.h"

void rp_add_arguments(GimpProcedure *procedure, rp_procedure which);
/* settings->procedure must be set. */
void rp_settings_from_config(rp_settings *settings, GimpProcedureConfig *config);
void rp_config_set(GimpProcedureConfig *config, rp_procedure procedure, const char *key,
                   double value);

#endif
