/* background.h - one run beside the dialog, replaced by the next: the draft, or the estimate. */
#ifndef RP_BACKGROUND_H
#define RP_BACKGROUND_H

#include "worker.h"

typedef struct {
  rp_request request;
  rp_worker *worker; /* NULL: idle */
  guint poll;
  void (*done)(gpointer user, const rp_request *request);
  gpointer user;
} rp_background;

/* Starts request, whose views must last; done is called from the main loop when it is over, not
 * when it was stopped. A run that is under way is stopped first. */
void rp_background_start(rp_background *background, const rp_request *request);
void rp_background_stop(rp_background *background);

#endif
