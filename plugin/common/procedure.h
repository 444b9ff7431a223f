/* procedure.h - from a procedure's arguments to the changed image, the same in both hosts. */
#ifndef RP_PROCEDURE_H
#define RP_PROCEDURE_H

#include "host.h"

typedef enum { RP_DONE, RP_CANCELLED, RP_CALLING_ERROR, RP_FAILED } rp_outcome;

/* message: why it is not RP_DONE (free it), else NULL. settings: as the dialog left them. */
rp_outcome rp_procedure_run(rp_host *host, rp_settings *settings, gboolean with_dialog,
                            char **message);

/* Why nothing can be done with the drawable; NULL: it can. result_chosen: FALSE: the dialog's user
 * may still choose a new layer. */
const char *rp_refusal(const rp_host *host, const rp_settings *settings, gboolean result_chosen);

/* Does the run that request asks for; returns when it is over. */
typedef void (*rp_runner)(rp_request *request, gpointer user);

/* One run on a picture that was read. RP_DONE: its result can be written, too. */
rp_outcome rp_compute(const rp_host *host, const rp_settings *settings, rp_picture *picture,
                      rp_request *request, rp_runner run, gpointer user, char **message);

#endif
