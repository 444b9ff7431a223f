/* exchange.h - from the host's drawables into a picture, and a fill back into its drawable. */
#ifndef RP_EXCHANGE_H
#define RP_EXCHANGE_H

#include "host.h"

rp_read_status rp_read(const rp_host *host, rp_procedure procedure, rp_picture *picture);
/* id: the drawable to copy from. FALSE: it is gone, or there is no memory; *message says it. */
gboolean rp_read_source(const rp_host *host, int id, rp_picture *picture, char **message);
/* One step of undo. */
void rp_write_in_place(const rp_host *host, const rp_picture *picture);

#endif
