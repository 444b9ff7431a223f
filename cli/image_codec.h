/* image_codec.h - pixels from and to the bytes of an image file, in memory. Implemented over
 * OpenImageIO, the only C++ of the project; nothing here throws, prints or touches a file.
 *
 * Metadata that OpenImageIO 2.4 loses or damages (Exif in PNG and in a TIFF made in memory, ICC's
 * fields written as text, a date of today) is carried by metadata.h; only OpenEXR's attributes,
 * which it keeps faithfully, pass through here. */
#ifndef RECEDE_IMAGE_CODEC_H
#define RECEDE_IMAGE_CODEC_H

#include <stdbool.h>
#include <stddef.h>

#include "recede.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum image_status {
  IMAGE_OK,
  IMAGE_MALFORMED,   /* damaged, or of no format we know */
  IMAGE_UNSUPPORTED, /* sound, but of a kind we cannot keep: CMYK, deep, double ... */
  IMAGE_TOO_LARGE,
  IMAGE_NO_MEMORY,
  IMAGE_OUTPUT /* the output's format cannot hold it, or the encoder failed */
} image_status;

typedef struct image_message {
  char text[600];
} image_message;

typedef struct image_info {
  int width, height, channels;
  recede_type type;
  int orientation; /* Exif 1..8: how the stored rows must be turned to be seen */
  bool turn_given; /* the file itself says so */
  int stored_bits; /* of a sample in the file: 1, 2, 4 are expanded to 8 */
  bool has_window; /* OpenEXR: the pixels lie at x, y of a frame that may be larger or smaller */
  int x, y, frame_width, frame_height;
  double dpi_x, dpi_y; /* 0: unknown */
  bool premultiplied;  /* colours are stored multiplied by alpha */
  bool profile;        /* of colours (ICC) */
  bool indexed;        /* a palette, expanded to RGB */
  bool several;        /* the file holds more pictures than the first */
} image_info;

typedef struct image_decoder image_decoder;

/* Once, before anything else here. threads: 0 is all processors. Keeps the library from printing.
 */
void image_codec_init(int threads);
/* The library could not start a thread: what it does at a process's exit would crash. */
bool image_codec_broken(void);

/* format: OpenImageIO's name of it. bytes must live as long as the decoder. Reads no pixel. */
image_status image_decoder_new(const char *format, const void *bytes, size_t size,
                               image_decoder **decoder, image_info *info, image_message *message);
/* data: room for height rows of width * channels samples of the info's type, without gaps. */
image_status image_decoder_read(image_decoder *decoder, void *data, image_message *message);
/* A colour profile that the decoder does not see itself. */
image_status image_decoder_set_profile(image_decoder *decoder, const void *bytes, size_t size,
                                       image_message *message);
void image_decoder_free(image_decoder **decoder);

/* A flat array, made and freed here. */
typedef struct image_bytes {
  unsigned char *data;
  size_t size;
} image_bytes;
void image_bytes_free(image_bytes *bytes);

/* Encodes the view. like: where the colour profile, compression, resolution and, from EXR to EXR,
 * channel names come from; NULL: none. premultiplied: the view's colours are. orientation: written
 * where the format has a tag of its own for it. keep: it is the same picture, so EXR's attributes
 * and windows come too. */
image_status image_encode(const recede_view *view, const char *format, const image_decoder *like,
                          bool premultiplied, int orientation, bool keep, image_bytes *bytes,
                          image_message *message);

#ifdef __cplusplus
}
#endif
#endif
