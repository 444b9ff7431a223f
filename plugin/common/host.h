/* host.h - what the shared part asks of GIMP. gimp2/host.c and gimp3/host.c each answer all of it.
 *
 * An rp_host stands for the image and the drawable that a procedure was called with. */
#ifndef RP_HOST_H
#define RP_HOST_H

#include "messages.h"
#include "picture.h"

typedef struct rp_host rp_host;

/* FALSE: the drawable was deleted, or its image closed. Nothing else may be asked then. */
gboolean rp_host_is_there(const rp_host *host);
rp_target rp_host_target(const rp_host *host);
gboolean rp_host_has_selection(const rp_host *host);

/* A drawable's pixels, to be unreferenced, and where they lie in the image. */
typedef struct {
  GeglBuffer *buffer;
  GeglRectangle area; /* of what a procedure reads, in the drawable's coordinates */
  int offset_x, offset_y;
} rp_drawable;

/* area: fill: all; synthesize: the selection's box, or all. */
rp_drawable rp_host_open(const rp_host *host, rp_procedure procedure);
/* The selection, in the image's coordinates; NULL: nothing is selected. */
GeglBuffer *rp_host_open_selection(const rp_host *host);
/* id: another drawable of this image. FALSE: there is none. */
gboolean rp_host_open_other(const rp_host *host, int id, rp_drawable *drawable);

/* Which components of a pixel may change, a bit each, the first the lowest: of a layer those that
 * the Channels dialog has not switched off, and alpha unless it is locked. */
unsigned rp_host_components(const rp_host *host);
GeglBuffer *rp_host_open_shadow(const rp_host *host);
/* The shadow becomes the drawable, within the selection: one step of undo. FALSE: GIMP refused. */
gboolean rp_host_merge_shadow(const rp_host *host);
/* Nothing is selected until rp_host_select_again() brings back what was. All that happens between
 * the two is one step of undo. */
void rp_host_select_nothing(rp_host *host);
void rp_host_select_again(rp_host *host);
void rp_host_updated(const rp_host *host, const GeglRectangle *box);
/* One step of undo. */
gboolean rp_host_write_new_layer(rp_host *host, const rp_picture *picture);
/* The image's type, precision, profile and resolution. */
gboolean rp_host_write_new_image(rp_host *host, const rp_picture *picture);

int rp_host_threads(void);
/* GIMP's own progress, for runs without a dialog; starts with the first call. */
void rp_host_progress(const char *title, const char *text, double fraction);
/* Shows the procedure's dialog and does the runs it asks for. TRUE: request holds a finished one.
 */
gboolean rp_host_dialog(rp_host *host, rp_settings *settings, rp_picture *picture,
                        rp_request *request);
void rp_host_message(const char *text);

#endif
