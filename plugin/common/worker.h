/* worker.h - one run of the core in a thread of its own.
 *
 * The request's views must stay until the worker is finished. Everything here is called from the
 * main thread. */
#ifndef RP_WORKER_H
#define RP_WORKER_H

#include <glib.h>

#include "recede.h"

typedef enum { RP_RUN_FILL, RP_RUN_SYNTHESIZE, RP_RUN_ORIENT } rp_run;

typedef struct {
  rp_run run;
  recede_params params;
  recede_view image, mask, source, result; /* .data NULL: there is none */
  int threads;                             /* 0 = all */
  /* Filled by the run. */
  recede_status status;
  recede_orientation orientation;
  recede_report report;
  char message[512]; /* the core's, English */
} rp_request;

typedef struct rp_worker rp_worker;

/* What a run is doing: stage is the core's name of it. */
typedef struct {
  const char *stage;
  double fraction;
  gboolean finished;
} rp_state;

rp_worker *rp_worker_start(rp_request *request);
rp_state rp_worker_state(rp_worker *worker);
/* Returns at once; the run ends soon with RECEDE_CANCELLED. */
void rp_worker_cancel(rp_worker *worker);
/* Waits for the end of the run and frees the worker. */
void rp_worker_finish(rp_worker **worker);

/* Waits for the end, but only so long that progress can be shown smoothly. */
rp_state rp_worker_wait(rp_worker *worker);

#define RP_TELL_EVERY_MS 33

#endif
