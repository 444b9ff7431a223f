/* From a procedure's arguments to the changed image. */
#include "procedure.h"

#include "exchange.h"
#include "intl.h"

static gboolean into_new_layer(const rp_settings *settings) {
  return settings->procedure == RP_FILL && (int)rp_settings_get(settings, "result") == RP_NEW_LAYER;
}

const char *rp_refusal(const rp_host *host, const rp_settings *settings, gboolean result_chosen) {
  if (!rp_host_is_there(host)) return rp_layer_gone();
  rp_target target = rp_host_target(host);
  gboolean fill = settings->procedure == RP_FILL;
  gboolean writes = fill && result_chosen;
  const char *text = rp_target_refusal(&target, writes, writes && into_new_layer(settings));
  if (text) return text;
  return fill && !rp_host_has_selection(host) ? rp_no_selection() : NULL;
}

static gboolean make_request(const rp_settings *settings, const recede_params *params,
                             rp_picture *picture, rp_request *request) {
  if (settings->procedure == RP_FILL)
    return rp_picture_request_fill(picture, params, !into_new_layer(settings), request);
  return rp_picture_request_synthesize(picture, params, (int)rp_settings_get(settings, "width"),
                                       (int)rp_settings_get(settings, "height"), request);
}

static gboolean take_source(const rp_host *host, const rp_settings *settings, rp_picture *picture,
                            char **message) {
  int id = settings->procedure == RP_FILL ? (int)rp_settings_get(settings, "source") : -1;
  rp_pixels_clear(&picture->source);
  return id < 0 || rp_read_source(host, id, picture, message);
}

/* The user goes on working while a fill runs. What is selected then does not matter. */
static char *cannot_write(const rp_host *host, const rp_settings *settings,
                          const rp_picture *picture) {
  if (!rp_host_is_there(host)) return g_strdup(rp_layer_gone());
  if (settings->procedure == RP_SYNTHESIZE) return NULL;
  rp_target target = rp_host_target(host);
  const char *text = rp_target_refusal(&target, TRUE, into_new_layer(settings));
  return text ? g_strdup(text) : rp_misfit(host, picture);
}

rp_outcome rp_compute(const rp_host *host, const rp_settings *settings, rp_picture *picture,
                      rp_request *request, rp_runner run_it, gpointer user, char **message) {
  recede_params params;
  if (!rp_settings_params(settings, &params, message)) return RP_CALLING_ERROR;
  if (!take_source(host, settings, picture, message)) return RP_CALLING_ERROR;
  if (!make_request(settings, &params, picture, request)) {
    *message = g_strdup(rp_no_memory());
    return RP_FAILED;
  }
  request->threads = rp_host_threads();
  run_it(request, user);
  if (request->status == RECEDE_CANCELLED) return RP_CANCELLED;
  picture->plane = request->report.orientation.plane;
  *message =
      request->status == RECEDE_OK ? cannot_write(host, settings, picture) : rp_failure(request);
  return *message ? RP_FAILED : RP_DONE;
}

static const char *write_result(rp_host *host, const rp_settings *settings,
                                const rp_picture *picture) {
  if (settings->procedure == RP_SYNTHESIZE)
    return rp_host_write_new_image(host, picture) ? NULL : rp_no_memory();
  if (into_new_layer(settings))
    return rp_host_write_new_layer(host, picture) ? NULL : rp_no_memory();
  return rp_write_in_place(host, picture) ? NULL : rp_not_taken();
}

/* GIMP's own Cancel ends the process: the image has not been touched. */
static void run_with_gimps_progress(rp_request *request, gpointer user) {
  rp_worker *worker = rp_worker_start(request);
  rp_state state;
  (void)user;
  while (!(state = rp_worker_wait(worker)).finished)
    rp_host_progress(rp_title(request), rp_stage_label(state.stage), state.fraction);
  rp_worker_finish(&worker);
}

static rp_outcome obtain_result(rp_host *host, rp_settings *settings, gboolean with_dialog,
                                rp_picture *picture, rp_request *request, char **message) {
  if (!with_dialog)
    return rp_compute(host, settings, picture, request, run_with_gimps_progress, NULL, message);
  return rp_host_dialog(host, settings, picture, request) ? RP_DONE : RP_CANCELLED;
}

static rp_outcome fail(const char *text, char **message) {
  *message = g_strdup(text);
  return RP_FAILED;
}

static rp_outcome run(rp_host *host, rp_settings *settings, gboolean with_dialog,
                      rp_picture *picture, char **message) {
  rp_request request;
  const char *text = rp_read(host, settings->procedure, picture);
  if (text) return fail(text, message);
  rp_outcome outcome = obtain_result(host, settings, with_dialog, picture, &request, message);
  if (outcome != RP_DONE) return outcome;
  text = write_result(host, settings, picture);
  if (text) return fail(text, message);
  char *warning = rp_warning(&request);
  if (warning) rp_host_message(warning);
  g_free(warning);
  return RP_DONE;
}

rp_outcome rp_procedure_run(rp_host *host, rp_settings *settings, gboolean with_dialog,
                            char **message) {
  rp_picture picture = {.image.view.data = NULL};
  recede_params params;
  *message = NULL;
  if (!rp_settings_params(settings, &params, message)) return RP_CALLING_ERROR;
  /* The dialog's user may still choose a new layer. */
  const char *text = rp_refusal(host, settings, !with_dialog);
  if (text) return fail(text, message);
  rp_outcome outcome = run(host, settings, with_dialog, &picture, message);
  rp_picture_clear(&picture);
  return outcome;
}
