/* The part of the dialog that both hosts share. */
#include "panel.h"

#include <math.h>
#include <string.h>

#include "background.h"
#include "draft.h"
#include "exchange.h"
#include "intl.h"
#include "legend.h"
#include "preview.h"
#include "procedure.h"
#include "watch.h"

#define SHOWS 3
/* The preview as the dialog opens, and as small as it can be made. */
#define PREVIEW_WIDTH 600
#define PREVIEW_HEIGHT 420
#define LEAST_WIDTH 240
#define LEAST_HEIGHT 180

struct rp_panel {
  rp_host *host;
  rp_settings *settings;
  rp_picture *picture;
  rp_set_func set;
  gpointer user;
  rp_scene scene;
  rp_background estimate;
  rp_draft draft;
  rp_watch watch;   /* of the run that OK asks for */
  gboolean setting; /* the panel itself is moving the controls */
  gboolean refused; /* why is what the panel says */
  /* What became of a run stays said until the user goes on, whatever goes on by itself. */
  gboolean answered;
  GtkWidget *box, *area, *shows[SHOWS], *estimate_button;
};

static void say(rp_panel *panel, const char *text) {
  if (!panel->answered) gtk_label_set_text(GTK_LABEL(panel->watch.status), text);
}

static void answer(rp_panel *panel, const char *text) {
  panel->answered = FALSE;
  say(panel, text);
  panel->answered = TRUE;
}

static void explain(rp_panel *panel) { say(panel, rp_legend(&panel->scene)); }

static int choice(const rp_panel *panel, const char *key) {
  return (int)rp_settings_get(panel->settings, key);
}

/* ------------------------------------------------------------------------------------ draft -- */

static void on_draft(gpointer user, const char *text) {
  rp_panel *panel = user;
  if (text)
    say(panel, text);
  else
    explain(panel);
  gtk_widget_queue_draw(panel->area);
}

/* --------------------------------------------------------------------------------- estimate -- */

static void set_value(rp_panel *panel, const char *key, double value) {
  panel->setting = TRUE;
  panel->set(panel->user, key, value);
  panel->setting = FALSE;
}

static void set_angles(rp_panel *panel, double slant_deg, double tilt_deg) {
  set_value(panel, "slant", slant_deg);
  set_value(panel, "tilt", tilt_deg);
}

static void show_plane(rp_panel *panel) {
  gboolean frontal = choice(panel, "orientation") == RECEDE_ORIENTATION_FRONTAL;
  gboolean was_beyond = rp_scene_is_beyond(&panel->scene);
  rp_scene_set_angles(&panel->scene, frontal ? 0 : rp_settings_get(panel->settings, "slant"),
                      frontal ? 0 : rp_settings_get(panel->settings, "tilt"),
                      rp_settings_get(panel->settings, "fov"));
  if (rp_scene_is_beyond(&panel->scene) != was_beyond) explain(panel);
  rp_draft_renew(&panel->draft);
  gtk_widget_queue_draw(panel->area);
}

static void stop_estimate(rp_panel *panel) {
  if (panel->estimate.worker) explain(panel);
  rp_background_stop(&panel->estimate);
  gtk_widget_set_sensitive(panel->estimate_button, !rp_scene_is_laid(&panel->scene));
}

/* Whoever sets an angle by hand means it. */
static void take_angles(rp_panel *panel) {
  if (choice(panel, "orientation") == RECEDE_ORIENTATION_ANGLES) return;
  stop_estimate(panel);
  set_value(panel, "orientation", RECEDE_ORIENTATION_ANGLES);
  explain(panel);
}

static void on_estimate(gpointer user, const rp_request *request) {
  rp_panel *panel = user;
  const recede_orientation *found = &request->orientation;
  double slant_deg, tilt_deg;
  gtk_widget_set_sensitive(panel->estimate_button, TRUE);
  if (request->status == RECEDE_OK && found->confidence >= RECEDE_CONFIDENCE_LOW) {
    char *text = g_strdup_printf(_("Read from the picture with a confidence of %.0f %%. Look "
                                   "whether the squares lie on the ground; drag them if not."),
                                 100 * found->confidence);
    set_angles(panel, round(found->slant_deg * 10) / 10, round(found->tilt_deg * 10) / 10);
    show_plane(panel);
    say(panel, text);
    g_free(text);
    return;
  }
  take_angles(panel); /* what is shown is what will be filled */
  if (panel->settings->procedure == RP_FILL &&
      rp_scene_first_guess(&panel->scene, &slant_deg, &tilt_deg)) {
    set_angles(panel, round(slant_deg * 10) / 10, round(tilt_deg * 10) / 10);
    show_plane(panel);
  }
  say(panel, _("The orientation could not be read from the picture with confidence. Drag the "
               "horizon or the grid until the squares lie on the ground."));
}

static void start_estimate(rp_panel *panel) {
  char *message = NULL;
  if (rp_scene_is_laid(&panel->scene)) { /* it tells nothing of a plane */
    take_angles(panel);
    return;
  }
  rp_request request = {.run = RP_RUN_ORIENT, .threads = rp_host_threads()};
  if (!rp_settings_params(panel->settings, &request.params, &message)) {
    g_free(message);
    return;
  }
  request.params.orientation = RECEDE_ORIENTATION_AUTO;
  request.image = panel->picture->image.view;
  request.mask = panel->picture->mask.view;
  request.source = panel->picture->source.view;
  if (panel->settings->procedure == RP_SYNTHESIZE) {
    request.source = request.mask;
    request.mask.data = NULL;
  }
  gtk_widget_set_sensitive(panel->estimate_button, FALSE);
  say(panel, _("Reading the orientation…"));
  rp_background_start(&panel->estimate, &request);
}

/* When what it depends on has changed. */
static void renew_estimate(rp_panel *panel) {
  stop_estimate(panel);
  if (choice(panel, "orientation") == RECEDE_ORIENTATION_AUTO) start_estimate(panel);
}

static void on_estimate_clicked(GtkButton *button, gpointer user) {
  rp_panel *panel = user;
  (void)button;
  panel->answered = FALSE;
  set_value(panel, "orientation", RECEDE_ORIENTATION_AUTO);
  start_estimate(panel);
}

/* ---------------------------------------------------------------------------------- changes -- */

static void on_dragged(gpointer user, double slant_deg, double tilt_deg) {
  rp_panel *panel = user;
  panel->answered = FALSE;
  take_angles(panel);
  set_angles(panel, slant_deg, tilt_deg);
  show_plane(panel);
  explain(panel);
}

static void take_source(rp_panel *panel) {
  char *message = NULL;
  int id = choice(panel, "source");
  rp_draft_stop(&panel->draft);
  stop_estimate(panel);
  rp_pixels_clear(&panel->picture->source);
  if (id >= 0 && !rp_read_source(panel->host, id, panel->picture, &message)) say(panel, message);
  rp_scene_set_source(&panel->scene, panel->picture);
  g_free(message);
}

static void take_scene(rp_panel *panel, rp_scene scene) {
  scene.show = panel->scene.show;
  rp_scene_clear(&panel->scene);
  panel->scene = scene;
}

/* When what it depends on has changed: how the texture is seen, or the new image's size. */
static void renew_scene(rp_panel *panel) {
  rp_scene scene;
  if (rp_scene_is_of(&panel->scene, panel->settings)) return;
  rp_draft_clear(&panel->draft);
  stop_estimate(panel);
  if (!rp_scene_new(panel->settings, panel->picture, &scene)) {
    say(panel, rp_no_memory());
    return;
  }
  take_scene(panel, scene);
  explain(panel);
}

void rp_panel_changed(rp_panel *panel, const char *key) {
  if (panel->setting || panel->watch.worker) return;
  panel->answered = FALSE;
  if (strcmp(key, "exemplar") == 0 || strcmp(key, "width") == 0 || strcmp(key, "height") == 0) {
    renew_scene(panel);
    if (strcmp(key, "exemplar") == 0) renew_estimate(panel);
  }
  if (strcmp(key, "slant") == 0 || strcmp(key, "tilt") == 0) take_angles(panel);
  if (strcmp(key, "source") == 0) take_source(panel);
  show_plane(panel);
  if (strcmp(key, "orientation") == 0 || strcmp(key, "source") == 0 || strcmp(key, "fov") == 0)
    renew_estimate(panel);
}

void rp_panel_changed_all(rp_panel *panel) {
  if (panel->watch.worker) return;
  panel->answered = FALSE;
  renew_scene(panel);
  explain(panel);
  if (panel->settings->procedure == RP_FILL) take_source(panel);
  show_plane(panel);
  renew_estimate(panel);
}

/* The user works on while the dialog is open: paints, selects something else, moves or crops the
 * layer. Why it cannot be filled now; NULL: it can. */
static const char *read_anew(rp_panel *panel) {
  rp_procedure procedure = panel->settings->procedure;
  rp_picture picture;
  rp_scene scene;
  if (rp_is_as_read(panel->host, procedure, panel->picture)) return NULL;
  const char *text = rp_read(panel->host, procedure, &picture);
  if (text) return text;
  if (!rp_scene_new(panel->settings, &picture, &scene)) {
    rp_picture_clear(&picture);
    return rp_no_memory();
  }
  rp_draft_clear(&panel->draft);
  stop_estimate(panel);
  rp_picture_clear(panel->picture);
  *panel->picture = picture;
  take_scene(panel, scene);
  rp_panel_changed_all(panel);
  return NULL;
}

static void on_show(GtkToggleButton *button, gpointer user) {
  rp_panel *panel = user;
  if (!gtk_toggle_button_get_active(button)) return;
  for (int i = 0; i < SHOWS; i++)
    if (panel->shows[i] == GTK_WIDGET(button)) panel->scene.show = (rp_show)i;
  panel->scene.shade_is_old = TRUE;
  panel->answered = FALSE;
  explain(panel);
  if (panel->scene.show == RP_SHOW_DRAFT && !panel->scene.draft.pixels)
    rp_draft_renew(&panel->draft);
  gtk_widget_queue_draw(panel->area);
}

/* ---------------------------------------------------------------------------------- widgets -- */

static GtkWidget *show_row(rp_panel *panel) {
  static const char *const labels[SHOWS] = {N_("Grid"), N_("Scale map"), N_("Draft result")};
  GtkWidget *row = rp_ui_box(GTK_ORIENTATION_HORIZONTAL, 6);
  GSList *group = NULL;
  int shows = panel->settings->procedure == RP_FILL ? SHOWS : RP_SHOW_DRAFT;
  for (int i = 0; i < shows; i++) {
    panel->shows[i] = gtk_radio_button_new_with_label(group, _(labels[i]));
    group = gtk_radio_button_get_group(GTK_RADIO_BUTTON(panel->shows[i]));
    g_signal_connect(panel->shows[i], "toggled", G_CALLBACK(on_show), panel);
    gtk_box_pack_start(GTK_BOX(row), panel->shows[i], FALSE, FALSE, 0);
  }
  panel->estimate_button = gtk_button_new_with_mnemonic(_("_Estimate"));
  gtk_widget_set_tooltip_text(panel->estimate_button, _("Read slant and tilt from the picture"));
  g_signal_connect(panel->estimate_button, "clicked", G_CALLBACK(on_estimate_clicked), panel);
  gtk_box_pack_end(GTK_BOX(row), panel->estimate_button, FALSE, FALSE, 0);
  return row;
}

/* Three lines are kept free for it, so that nothing jumps. */
static GtkWidget *status_lines(rp_panel *panel) {
  GtkWidget *lines = rp_ui_paragraph(&panel->watch.status);
  gtk_widget_set_size_request(lines, LEAST_WIDTH, 54);
  atk_object_set_name(gtk_widget_get_accessible(panel->watch.status), _("Status"));
  return lines;
}

static void build(rp_panel *panel) {
  panel->box = rp_ui_box(GTK_ORIENTATION_VERTICAL, 6);
  panel->area = rp_preview_new(&panel->scene, on_dragged, panel);
  gtk_box_pack_start(GTK_BOX(panel->box), panel->area, TRUE, TRUE, 0);
  gtk_box_pack_start(GTK_BOX(panel->box), show_row(panel), FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(panel->box), status_lines(panel), FALSE, FALSE, 0);
  panel->watch.progress = gtk_progress_bar_new();
  gtk_box_pack_start(GTK_BOX(panel->box), panel->watch.progress, FALSE, FALSE, 0);
  gtk_widget_show_all(panel->box);
}

rp_panel *rp_panel_new(rp_host *host, rp_settings *settings, rp_picture *picture, rp_set_func set,
                       gpointer user) {
  rp_panel *panel = g_new0(rp_panel, 1);
  *panel =
      (rp_panel){.host = host, .settings = settings, .picture = picture, .set = set, .user = user};
  panel->estimate = (rp_background){.done = on_estimate, .user = panel};
  panel->draft =
      (rp_draft){.settings = settings, .scene = &panel->scene, .told = on_draft, .user = panel};
  rp_scene scene;
  if (!rp_scene_new(settings, picture, &scene)) {
    rp_panel_free(panel);
    return NULL;
  }
  take_scene(panel, scene);
  build(panel);
  rp_panel_changed_all(panel);
  return panel;
}

GtkWidget *rp_panel_widget(rp_panel *panel) { return panel->box; }

static gboolean can_fill(rp_panel *panel, gboolean result_chosen) {
  const char *text = rp_refusal(panel->host, panel->settings, result_chosen);
  if (!text) text = read_anew(panel);
  if (text || panel->refused) panel->answered = FALSE;
  if (text)
    say(panel, text);
  else if (panel->refused && !panel->estimate.worker)
    explain(panel);
  panel->refused = text != NULL;
  return !panel->refused;
}

/* Back from the image's window. */
static gboolean on_focus(GtkWidget *dialog, GdkEvent *event, gpointer user) {
  rp_panel *panel = user;
  (void)dialog, (void)event;
  if (!panel->watch.worker) can_fill(panel, FALSE);
  return FALSE;
}

void rp_panel_attach(rp_panel *panel, GtkWidget *dialog) {
  panel->watch.dialog = dialog;
  gtk_widget_set_size_request(panel->area, PREVIEW_WIDTH, PREVIEW_HEIGHT);
  rp_ui_open_so_large(dialog);
  gtk_widget_set_size_request(panel->area, LEAST_WIDTH, LEAST_HEIGHT);
  g_signal_connect(dialog, "focus-in-event", G_CALLBACK(on_focus), panel);
}

void rp_panel_free(rp_panel *panel) {
  rp_draft_clear(&panel->draft);
  rp_background_stop(&panel->estimate);
  rp_scene_clear(&panel->scene);
  g_free(panel);
}

/* -------------------------------------------------------------------------------------- run -- */

/* What a run without a result interrupted. */
static void resume(rp_panel *panel, gboolean estimating) {
  if (estimating) start_estimate(panel);
  if (!panel->scene.draft.pixels) rp_draft_renew(&panel->draft);
}

/* The result is written as the settings were when OK was pressed, whatever changes them meanwhile.
 */
gboolean rp_panel_compute(rp_panel *panel, rp_request *request) {
  char *message = NULL;
  if (!can_fill(panel, TRUE)) return FALSE;
  gboolean estimating = panel->estimate.worker != NULL;
  rp_draft_stop(&panel->draft);
  stop_estimate(panel);
  rp_settings asked = *panel->settings;
  rp_outcome outcome = rp_compute(panel->host, &asked, panel->picture, request, rp_watch_run,
                                  &panel->watch, &message);
  if (outcome == RP_DONE) *panel->settings = asked;
  if (outcome == RP_CANCELLED) answer(panel, _("Stopped; the picture has not been changed."));
  if (message) answer(panel, message);
  if (outcome != RP_DONE) resume(panel, estimating);
  g_free(message);
  return outcome == RP_DONE;
}
