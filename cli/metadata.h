/* metadata.h - what a picture's file says beside its pixels, carried to the file we write. */
#ifndef RECEDE_METADATA_H
#define RECEDE_METADATA_H

#include "image_file.h"

/* Reads file->metadata from file->bytes, and what it says of the picture into file->info. */
image_status metadata_read(image_file *file, image_message *message);
void metadata_free(image_file *file);

/* Whether a picture in this format keeps its stored rows and its Exif orientation. */
bool metadata_carries_orientation(const image_file *from, const image_format *format);

/* Puts Exif, XMP, IPTC, texts and the resolution of `from` into the bytes of an encoded picture.
 * from: NULL for none; what the encoder adds of its own is taken out even then. keep: see
 * image_file_encode(). */
image_status metadata_carry(const image_file *from, const image_format *format, bool keep,
                            image_bytes *bytes, image_message *message);

/* How many texts of a PNG its decoder unpacks. */
unsigned metadata_png_packed_texts(const uint8_t *bytes, size_t size);

/* A TIFF whose colours are stored multiplied by alpha ("associated"); when it does not say, they
 * are taken to be plain. */
bool metadata_tiff_is_premultiplied(const uint8_t *bytes, size_t size);

#endif
