/* image_jpeg.h - what a JPEG's segments say, before its decoder is asked: that takes a file cut in
 * half for a picture with a gray lower half, and begins to decode one of several scans as soon as
 * it is opened. */
#ifndef RECEDE_IMAGE_JPEG_H
#define RECEDE_IMAGE_JPEG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct image_jpeg {
  int width, height;     /* 0: none said */
  int channels;          /* as stored: 4 is CMYK, whatever the decoder makes of it */
  int scans;             /* passes over the picture */
  uint64_t coefficients; /* bytes that the decoder keeps until the last scan; 0: only one comes */
  bool whole;            /* its end was met */
  size_t end;            /* and what follows it begins here */
} image_jpeg;

image_jpeg image_jpeg_walk(const unsigned char *bytes, size_t size);

#endif
