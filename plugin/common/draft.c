/* The real fill at the preview's size. */
#include "draft.h"

#include "host.h"
#include "intl.h"

#define AFTER_MS 250 /* after the last change */

static void on_done(gpointer user, const rp_request *request) {
  rp_draft *draft = user;
  char *text = request->status == RECEDE_OK ? NULL : rp_failure(request);
  if (!text) rp_scene_set_draft(draft->scene, draft->pixels);
  draft->told(draft->user, text);
  g_free(text);
}

static recede_view view_of(const rp_proxy *proxy, guchar *pixels, int channels) {
  return (recede_view){
      pixels, (gsize)(proxy->width * channels), proxy->width, proxy->height, channels, RECEDE_U8};
}

/* Estimated angles are shown by the sliders, so the draft takes them from there. */
static gboolean find_params(const rp_draft *draft, recede_params *params) {
  char *message = NULL;
  gboolean good = rp_settings_params(draft->settings, params, &message);
  g_free(message);
  if (params->orientation == RECEDE_ORIENTATION_AUTO)
    params->orientation = RECEDE_ORIENTATION_ANGLES;
  params->quality = RECEDE_QUALITY_DRAFT;
  return good;
}

static gboolean is_shown(const rp_draft *draft) {
  return draft->scene->show == RP_SHOW_DRAFT || rp_scene_is_laid(draft->scene);
}

static gboolean start(gpointer data) {
  rp_draft *draft = data;
  gboolean laid = rp_scene_is_laid(draft->scene);
  rp_proxy *proxy = &draft->scene->proxy, *from = laid ? &draft->scene->texture : proxy;
  rp_request request = {.run = laid ? RP_RUN_SYNTHESIZE : RP_RUN_FILL,
                        .threads = rp_host_threads()};
  draft->timer = 0;
  if (!is_shown(draft) || !find_params(draft, &request.params)) return G_SOURCE_REMOVE;
  request.image = view_of(from, from->rgba, 4);
  if (!laid) request.mask = view_of(from, from->mask, 1);
  if (from->source) request.source = view_of(from, from->source, 1);
  rp_background_stop(&draft->run);
  if (!draft->pixels) draft->pixels = g_malloc((gsize)proxy->width * (gsize)proxy->height * 4);
  request.result = view_of(proxy, draft->pixels, 4);
  draft->told(draft->user, _("Making a draft…"));
  draft->run.done = on_done, draft->run.user = draft;
  rp_background_start(&draft->run, &request);
  return G_SOURCE_REMOVE;
}

void rp_draft_stop(rp_draft *draft) {
  if (draft->timer) g_source_remove(draft->timer);
  draft->timer = 0;
  rp_background_stop(&draft->run);
}

void rp_draft_renew(rp_draft *draft) {
  rp_draft_stop(draft);
  rp_scene_set_draft(draft->scene, NULL);
  if (is_shown(draft)) draft->timer = g_timeout_add(AFTER_MS, start, draft);
}

void rp_draft_clear(rp_draft *draft) {
  rp_draft_stop(draft);
  g_clear_pointer(&draft->pixels, g_free);
}
