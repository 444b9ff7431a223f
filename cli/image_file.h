/* image_file.h - pictures from and to files.
 *
 * A picture is handled as it is SEEN: stored rows are turned by the Exif orientation after reading
 * and turned back before writing, so horizon, tilt and mask mean what the user sees, and the file
 * keeps its layout and its tag. Colours that are stored premultiplied are divided by alpha for the
 * core; stored pixels that are not filled are written back bit for bit.
 */
#ifndef RECEDE_IMAGE_FILE_H
#define RECEDE_IMAGE_FILE_H

#include "image_codec.h"
#include "image_format.h"

typedef struct image_file {
  const char *path; /* the caller's */
  const image_format *format;
  image_bytes bytes; /* the file as it is */
  image_decoder *decoder;
  struct metadata_parts *metadata; /* what it says beside the pixels: metadata.h */
  image_info info;                 /* as stored */
  recede_view view;                /* as seen; data NULL before image_file_read() */
} image_file;

/* Reads the file's bytes and header. limit_bytes: of the decoded pixels. On any status but IMAGE_OK
 * the message tells why, the file's name not included; close it in any case. */
image_status image_file_open(const char *path, uint64_t limit_bytes, image_file *file,
                             image_message *message);
image_status image_file_read(image_file *file, image_message *message);
/* Stored rows into seen ones, in fresh memory; the view's own is freed. */
image_status image_file_turn(recede_view *view, int orientation, image_message *message);
void image_file_close(image_file *file);

/* What the output's format would do to a picture of this size. like: what it is made from; NULL:
 * none. false: it cannot hold it, message says what to
 * use; else message is "" or says what will be reduced. */
bool image_file_can_write(const char *path, const image_file *like, int width, int height,
                          recede_type type, image_message *message);

/* Whether the output's format has transparency, if the picture has; false: message says what to
 * use.
 */
bool image_file_holds_alpha(const char *path, int channels, image_message *message);

/* Encodes a picture as seen. like: where metadata, orientation, compression come from; NULL: none.
 * keep: it is the same picture, so Exif, XMP, IPTC and the turn of the stored rows stay; else only
 * the colour profile and the resolution do. message: why not, or on IMAGE_OK "" or a warning. */
image_status image_file_encode(const char *path, const recede_view *seen, const image_file *like,
                               bool keep, image_bytes *bytes, image_message *message);

#endif
