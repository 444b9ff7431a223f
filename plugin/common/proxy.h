/* proxy.h - the picture at preview size: what the preview shows and the draft fills. */
#ifndef RP_PROXY_H
#define RP_PROXY_H

#include "picture.h"

typedef struct {
  int width, height;
  double shrink;  /* picture pixels per proxy pixel */
  guchar *rgba;   /* R'G'B'A, 4 bytes a pixel, alpha not premultiplied */
  guchar *mask;   /* 255 where the fill goes, else 0 */
  guchar *source; /* 255: may be copied from; NULL: everything */
  int *ends;      /* two a row: the first and the last x that may be copied; -1, -1: none */
} rp_proxy;

/* No longer than longest px. FALSE: no memory. */
gboolean rp_proxy_new(const rp_picture *picture, int longest, rp_proxy *proxy);
/* Of a picture of that size with nothing in it yet: transparent, nothing to fill or to copy. */
gboolean rp_proxy_new_blank(int width, int height, int longest, rp_proxy *proxy);
/* Takes picture->source, or everything when it has none. */
void rp_proxy_set_source(rp_proxy *proxy, const rp_picture *picture);
/* To be called when mask or source has been changed by hand. */
void rp_proxy_find_ends(rp_proxy *proxy);
void rp_proxy_clear(rp_proxy *proxy);
/* Centre of the mask, in proxy pixels; the middle when there is no mask. */
void rp_proxy_centre(const rp_proxy *proxy, double *x, double *y);

#endif
