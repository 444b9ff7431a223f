/* host.h - GIMP 2.10's side: the image and the drawable that a procedure was called with. */
#ifndef RP_GIMP2_HOST_H
#define RP_GIMP2_HOST_H

#include <libgimp/gimp.h>

#include "../common/host.h"

struct rp_host {
  gint32 image, drawable;
  gint32 new_image; /* made by synthesize, else -1 */
  gint32 selected;  /* what was selected before rp_host_select_nothing(); -1: nothing */
};

#endif
