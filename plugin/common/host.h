/* host.h - what the shared part asks of GIMP. gimp2/host.c and gimp3/host.c each answer all of it.
 *
 * An rp_host stands for the image and the drawable that a procedure was called with. */
#ifndef RP_HOST_H
#define RP_HOST_H

#include "messages.h"
#include "picture.h"

typedef struct rp_host rp_host;

rp_target rp_host_target(const rp_host *host);
gboolean rp_host_has_selection(const rp_host *host);
/* Fill: the whole drawable and the selection. Synthesize: the selection's box in the drawable, or
 * all of it. */
rp_read_status rp_host_read(const rp_host *host, rp_procedure procedure, rp_picture *picture);
/* id: the drawable to copy from. FALSE: it is gone, or there is no memory; *message says it. */
gboolean rp_host_read_source(const rp_host *host, int id, rp_picture *picture, char **message);

/* Each is one step of undo. */
void rp_host_write_in_place(rp_host *host, const rp_picture *picture);
gboolean rp_host_write_new_layer(rp_host *host, const rp_picture *picture);
/* The image's type, precision, profile and resolution. */
gboolean rp_host_write_new_image(rp_host *host, const rp_picture *picture);

int rp_host_threads(void);
/* GIMP's own progress, for runs without a dialog; starts with the first call. */
void rp_host_progress(const char *text, double fraction);
/* Shows the procedure's dialog and does the runs it asks for. TRUE: request holds a finished one.
 */
gboolean rp_host_dialog(rp_host *host, rp_settings *settings, rp_picture *picture,
                        rp_request *request);
void rp_host_message(const char *text);

#endif
