/* metadata.h - what a picture's file says beside its pixels, carried to the file we write. */
#ifndef RECEDE_METADATA_H
#define RECEDE_METADATA_H

#include "image_file.h"

/* Whether a picture in this format keeps its stored rows and its Exif orientation. */
bool metadata_carries_orientation(const image_file *from, const image_format *format);

/* Puts Exif, XMP, IPTC, texts and the resolution of `from` into the bytes of an encoded picture.
 * keep: see image_file_encode(). */
image_status metadata_carry(const image_file *from, const image_format *format, bool keep,
                            image_bytes *bytes, image_message *message);

#endif
