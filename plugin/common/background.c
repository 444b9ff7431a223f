/* One run beside the dialog. */
#include "background.h"

#define POLL_MS 20

static gboolean on_poll(gpointer data) {
  rp_background *background = data;
  if (!rp_worker_state(background->worker).finished) return G_SOURCE_CONTINUE;
  background->poll = 0;
  rp_worker_finish(&background->worker);
  background->done(background->user, &background->request);
  return G_SOURCE_REMOVE;
}

void rp_background_start(rp_background *background, const rp_request *request) {
  rp_background_stop(background);
  background->request = *request;
  background->worker = rp_worker_start(&background->request);
  background->poll = g_timeout_add(POLL_MS, on_poll, background);
}

void rp_background_stop(rp_background *background) {
  if (!background->worker) return;
  g_source_remove(background->poll);
  background->poll = 0;
  rp_worker_cancel(background->worker);
  rp_worker_finish(&background->worker);
}
