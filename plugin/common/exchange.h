/* exchange.h - from the host's drawables into a picture, and a fill back into its drawable. */
#ifndef RP_EXCHANGE_H
#define RP_EXCHANGE_H

#include "host.h"

/* Why it could not be read; NULL: it was. */
const char *rp_read(const rp_host *host, rp_procedure procedure, rp_picture *picture);
/* Whether drawable and selection still are where and what they were, pixel by pixel. */
gboolean rp_is_as_read(const rp_host *host, rp_procedure procedure, const rp_picture *picture);
/* id: the drawable to copy from. FALSE: it is gone, or there is no memory; *message says it. */
gboolean rp_read_source(const rp_host *host, int id, rp_picture *picture, char **message);
/* Why a fill of picture no longer fits into its drawable (free it); NULL: it does. */
char *rp_misfit(const rp_host *host, const rp_picture *picture);
/* Writes what was selected when picture was read, whatever is selected now. One step of undo.
 * FALSE: GIMP refused, and nothing was written. */
gboolean rp_write_in_place(rp_host *host, const rp_picture *picture);

#endif
