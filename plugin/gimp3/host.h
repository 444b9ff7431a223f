/* host.h - GIMP 3's side: the image and the drawable that a procedure was called with. */
#ifndef RP_GIMP3_HOST_H
#define RP_GIMP3_HOST_H

#include <libgimp/gimp.h>

#include "../common/host.h"

struct rp_host {
  GimpProcedure *procedure;
  GimpProcedureConfig *config;
  GimpImage *image;
  GimpDrawable *drawable;
  GimpImage *new_image;  /* made by synthesize, else NULL */
  GimpChannel *selected; /* what was selected before rp_host_select_nothing(); NULL: nothing */
};

#endif
