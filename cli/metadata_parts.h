/* metadata_parts.h - the parts that metadata.c passes between the kinds of file. */
#ifndef RECEDE_METADATA_PARTS_H
#define RECEDE_METADATA_PARTS_H

#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct metadata_parts {
  GByteArray *exif;    /* an Exif block (a TIFF structure), its thumbnail blanked */
  GByteArray *xmp;     /* the packet */
  GByteArray *iptc;    /* Photoshop's 8BIM resources, without thumbnails */
  GByteArray *chunks;  /* PNG: chunks to be copied as they are */
  GByteArray *comment; /* JPEG: comment segments as they are */
  double dpi_x, dpi_y; /* 0: unknown */
} metadata_parts;

/* Take what they find; NULL parts stay NULL. The bytes come from a file that was read well. */
void metadata_from_jpeg(const uint8_t *bytes, size_t size, metadata_parts *parts);
/* texts: those too that describe the picture, not only its colours and resolution. */
void metadata_from_png(const uint8_t *bytes, size_t size, bool texts, metadata_parts *parts);
void metadata_from_tiff(const uint8_t *bytes, size_t size, metadata_parts *parts);

/* Return the encoded file with the parts put in. *lost is set where one does not fit. */
GByteArray *metadata_into_jpeg(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost);
GByteArray *metadata_into_png(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                              bool *lost);
GByteArray *metadata_into_tiff(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost);

/* 8BIM resources without the thumbnails (1033, 1036), which would show what was removed. */
GByteArray *metadata_clean_iptc(const uint8_t *bytes, size_t size);
GByteArray *metadata_copy(const uint8_t *bytes, size_t size);

#endif
