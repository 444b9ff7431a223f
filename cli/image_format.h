/* image_format.h - the formats of image files we read and write: how they are told apart and what
 * each can hold. */
#ifndef RECEDE_IMAGE_FORMAT_H
#define RECEDE_IMAGE_FORMAT_H

#include <stdbool.h>
#include <stddef.h>

#include "recede.h"

typedef struct image_format {
  const char *name;        /* as people write it */
  const char *codec;       /* as OpenImageIO does */
  const char *suffixes[5]; /* lower case; NULL ends */
  unsigned types;          /* bit 1 << recede_type: written without loss; 0: only read */
  unsigned channels;       /* bit 1 << channels */
  int longest;             /* side it can have, px, of those that --size can ask for; 0: any */
} image_format;

/* By the first bytes, whatever the file is called; only Targa, which has no mark of its own, by the
 * name. NULL: none of ours. */
const image_format *image_format_of_bytes(const unsigned char *bytes, size_t size,
                                          const char *path);
/* By the suffix of the name, in either case. NULL: none of ours. */
const image_format *image_format_of_name(const char *path);
/* ".png, .tif, ...": what may be given as a suffix of an input, of an output. */
const char *image_format_read(void);
const char *image_format_written(void);

/* May have been compressed with loss. */
bool image_format_lossy(const image_format *format);
bool image_format_holds(const image_format *format, recede_type type);

/* An animated PNG or WebP, of which decoders give the first picture. */
bool image_format_animated(const image_format *format, const unsigned char *bytes, size_t size);
/* A PNG with a palette; its depth in *bits. */
bool image_format_png_header(const unsigned char *bytes, size_t size, int *bits, bool *indexed);
/* Bytes of a PNG's pixels before they were packed, of one that was opened (its sides are below a
 * million); 0: it is none. */
uint64_t image_format_png_bytes(const unsigned char *bytes, size_t size);
/* A BMP whose pixels are packed in a way that the decoder takes for damage. */
bool image_format_bmp_rle(const image_format *format, const unsigned char *bytes, size_t size);

#endif
