/* draft.h - the real fill at the preview's size, made beside the dialog and laid into the scene. */
#ifndef RP_DRAFT_H
#define RP_DRAFT_H

#include "background.h"
#include "scene.h"

typedef struct {
  const rp_settings *settings;
  rp_scene *scene;
  /* text: what is being done, or why there is no draft; NULL: it is there. */
  void (*told)(gpointer user, const char *text);
  gpointer user;
  rp_background run;
  guchar *pixels; /* of the scene's proxy */
  guint timer;
} rp_draft;

/* The one there is no longer holds. Another is made soon, when the scene is to show it. */
void rp_draft_renew(rp_draft *draft);
void rp_draft_stop(rp_draft *draft);
/* To be called before the scene changes its size or is freed. */
void rp_draft_clear(rp_draft *draft);

#endif
