/* The plug-in for GIMP 3: registers the procedures and runs them. */
#include <libgimp/gimp.h>

#include "../common/intl.h"
#include "../common/procedure.h"
#include "host.h"
#include "settings.h"

typedef struct {
  GimpPlugIn parent_instance;
} RpPlugIn;
typedef struct {
  GimpPlugInClass parent_class;
} RpPlugInClass;

GType rp_plug_in_get_type(void) G_GNUC_CONST;
G_DEFINE_TYPE(RpPlugIn, rp_plug_in, GIMP_TYPE_PLUG_IN)

/* We bind our catalogues ourselves: libgimp knows only those beside the executable, and says so on
 * every start when there are none. */
static gboolean set_i18n(GimpPlugIn *plug_in, const gchar *procedure_name, gchar **gettext_domain,
                         gchar **catalog_dir) {
  (void)plug_in, (void)procedure_name, (void)gettext_domain, (void)catalog_dir;
  rp_translations_start(gimp_get_progname());
  return FALSE;
}

static GFile *own_file(const char *name) {
  char *path = rp_own_file(gimp_get_progname(), name);
  GFile *file = path ? g_file_new_for_path(path) : NULL;
  g_free(path);
  return file;
}

static GList *query_procedures(GimpPlugIn *plug_in) {
  GList *names = NULL;
  GFile *help = own_file("help");
  if (help) gimp_plug_in_set_help_domain(plug_in, "recede-help", help);
  g_clear_object(&help);
  for (int i = 0; i < RP_PROCEDURES; i++)
    names = g_list_append(names, g_strdup(rp_procedure_name((rp_procedure)i)));
  return names;
}

static GimpPDBStatusType status_of(rp_outcome outcome) {
  switch (outcome) {
    case RP_DONE: return GIMP_PDB_SUCCESS;
    case RP_CANCELLED: return GIMP_PDB_CANCEL;
    case RP_CALLING_ERROR: return GIMP_PDB_CALLING_ERROR;
    default: return GIMP_PDB_EXECUTION_ERROR;
  }
}

static GimpValueArray *answer(const rp_host *host, rp_outcome outcome, const char *message) {
  GError *error = message ? g_error_new_literal(GIMP_PLUG_IN_ERROR, 0, message) : NULL;
  GimpValueArray *values =
      gimp_procedure_new_return_values(host->procedure, status_of(outcome), error);
  if (host->new_image) g_value_set_object(gimp_value_array_index(values, 1), host->new_image);
  return values;
}

static GimpValueArray *run(GimpProcedure *procedure, GimpRunMode mode, GimpImage *image,
                           GimpDrawable **drawables, GimpProcedureConfig *config, gpointer data) {
  rp_host host = {procedure, config, image, drawables ? drawables[0] : NULL, NULL, NULL};
  rp_settings settings;
  char *message = NULL;
  gegl_init(NULL, NULL);
  if (gimp_core_object_array_get_length((GObject **)drawables) != 1)
    return answer(&host, RP_FAILED, rp_one_layer_only());
  rp_settings_init(&settings, GPOINTER_TO_INT(data));
  rp_settings_from_config(&settings, config);
  rp_outcome outcome = rp_procedure_run(&host, &settings, mode == GIMP_RUN_INTERACTIVE, &message);
  if (outcome == RP_DONE && mode != GIMP_RUN_NONINTERACTIVE) {
    if (host.new_image) gimp_display_new(host.new_image);
    gimp_displays_flush();
  }
  GimpValueArray *values = answer(&host, outcome, message);
  g_free(message);
  return values;
}

static GimpProcedure *create_procedure(GimpPlugIn *plug_in, const gchar *name) {
  rp_procedure which = g_str_equal(name, rp_procedure_name(RP_FILL)) ? RP_FILL : RP_SYNTHESIZE;
  rp_translations_start(gimp_get_progname());
  GimpProcedure *procedure = gimp_image_procedure_new(plug_in, name, GIMP_PDB_PROC_TYPE_PLUGIN, run,
                                                      GINT_TO_POINTER(which), NULL);
  gimp_procedure_set_image_types(procedure, "RGB*, GRAY*");
  gimp_procedure_set_sensitivity_mask(procedure, GIMP_PROCEDURE_SENSITIVE_DRAWABLE);
  gimp_procedure_set_menu_label(procedure, _(rp_procedure_label(which)));
  gimp_procedure_add_menu_path(procedure, which == RP_FILL ? "<Image>/Filters/Enhance"
                                                           : "<Image>/Filters/Render/Pattern");
  gimp_procedure_set_documentation(procedure, _(rp_procedure_blurb(which)),
                                   _(rp_procedure_help(which)), name);
  gimp_procedure_set_attribution(procedure, "The Recede developers", "The Recede developers",
                                 "2026");
  GFile *icon = own_file("recede.svg");
  if (icon) gimp_procedure_set_icon_file(procedure, icon);
  g_clear_object(&icon);
  rp_add_arguments(procedure, which);
  if (which == RP_SYNTHESIZE)
    gimp_procedure_add_image_return_value(procedure, "new-image", _("New image"),
                                          _("The image that was made"), FALSE, G_PARAM_READWRITE);
  return procedure;
}

static void rp_plug_in_class_init(RpPlugInClass *class) {
  GimpPlugInClass *plug_in = GIMP_PLUG_IN_CLASS(class);
  plug_in->query_procedures = query_procedures;
  plug_in->create_procedure = create_procedure;
  plug_in->set_i18n = set_i18n;
}

static void rp_plug_in_init(RpPlugIn *plug_in) { (void)plug_in; }

GIMP_MAIN(rp_plug_in_get_type())
