/* arguments.h - the procedures' arguments, made from the core's one table.
 *
 * Both hosts register them from here, in this order, after run-mode, image and drawable; so the
 * command, GIMP 2.10 and GIMP 3 cannot drift apart. */
#ifndef RP_ARGUMENTS_H
#define RP_ARGUMENTS_H

#include <glib.h>

#include "recede.h"

typedef enum { RP_FILL, RP_SYNTHESIZE, RP_PROCEDURES } rp_procedure;

typedef enum { RP_DOUBLE, RP_INT, RP_CHOICE, RP_DRAWABLE } rp_argument_type;

typedef struct {
  const char *key;
  const char *label, *help; /* to be translated */
  const char *unit;
  rp_argument_type type;
  double minimum, maximum, default_value; /* a choice: its index; a drawable: -1 is none */
  const char *const *choices;             /* maximum + 1 nicks */
  const char *const *choice_labels;       /* to be translated */
  gboolean late; /* came after the order of 2.10's arguments was fixed: its scripts lack it */
} rp_argument;

#define RP_MAX_ARGUMENTS 16

enum { RP_IN_PLACE, RP_NEW_LAYER }; /* of "result" */

const char *rp_procedure_name(rp_procedure procedure);
const char *rp_procedure_label(rp_procedure procedure); /* menu label, to be translated */
const char *rp_procedure_blurb(rp_procedure procedure);
const char *rp_procedure_help(rp_procedure procedure);
const rp_argument *rp_arguments(rp_procedure procedure, int *count);

/* One value an argument, in the arguments' order: a plain block that a host may keep as it is. */
typedef struct {
  rp_procedure procedure;
  double values[RP_MAX_ARGUMENTS];
} rp_settings;

void rp_settings_init(rp_settings *settings, rp_procedure procedure);
/* -1 when the procedure has no such argument. */
int rp_settings_index(const rp_settings *settings, const char *key);
double rp_settings_get(const rp_settings *settings, const char *key);
void rp_settings_set(rp_settings *settings, const char *key, double value);
/* Whether a texture seen from the front is to be laid onto the new image's plane. */
gboolean rp_settings_lay(const rp_settings *settings);
/* Checks every value and fills params. FALSE: *message says which is wrong (free it). */
gboolean rp_settings_params(const rp_settings *settings, recede_params *params, char **message);

#endif
