/* metadata_parts.h - the parts that metadata.c passes between the kinds of file. */
#ifndef RECEDE_METADATA_PARTS_H
#define RECEDE_METADATA_PARTS_H

#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

/* A PNG's text, unpacked: XMP and Exif have some 64 KiB, twice that as digits. */
#define METADATA_LONGEST_TEXT ((size_t)4 << 20)

typedef struct metadata_parts {
  GByteArray *exif;    /* an Exif block (a TIFF structure), its thumbnails blanked */
  GByteArray *xmp;     /* the packet */
  GByteArray *iptc;    /* Photoshop's 8BIM resources, without thumbnails */
  GByteArray *profile; /* WebP's, which the decoder does not give */
  GByteArray *colours; /* PNG: chunks of profile and resolution, to be copied as they are */
  GByteArray *texts;   /* PNG: texts that describe the picture, likewise */
  GByteArray *comment; /* JPEG: comment segments as they are */
  double dpi_x, dpi_y; /* 0: unknown */
  unsigned unpacked;   /* PNG: texts that were taken apart */
  bool lost;           /* there was more, which we cannot read */
} metadata_parts;

/* Take what they find; NULL parts stay NULL. The bytes come from a file that was read well. */
void metadata_from_jpeg(const uint8_t *bytes, size_t size, metadata_parts *parts);
void metadata_from_png(const uint8_t *bytes, size_t size, metadata_parts *parts);
void metadata_from_tiff(const uint8_t *bytes, size_t size, metadata_parts *parts);
void metadata_from_webp(const uint8_t *bytes, size_t size, metadata_parts *parts);
/* A block by what it begins with: Exif, XMP or 8BIM resources. The first of each kind stays. */
void metadata_take(metadata_parts *parts, const uint8_t *bytes, size_t size);
/* A text chunk of a PNG: "tEXt", "zTXt" or "iTXt". whole: from its length to its checksum. */
void metadata_take_text(metadata_parts *parts, const uint8_t *whole, size_t whole_size);

/* Return the encoded file with the parts put in. *lost is set where one does not fit. */
GByteArray *metadata_into_jpeg(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost);
GByteArray *metadata_into_png(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                              bool *lost);
GByteArray *metadata_into_tiff(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost);

/* 8BIM resources without the thumbnails (1033, 1036), which would show what was removed. */
GByteArray *metadata_clean_iptc(const uint8_t *bytes, size_t size);
/* Takes pictures, and words of pictures behind this one, out of an XMP packet. false: they cannot
 * be told from the rest, or it is longer than METADATA_LONGEST_TEXT. */
bool metadata_clean_xmp(GByteArray *xmp);
GByteArray *metadata_copy(const uint8_t *bytes, size_t size);

#endif
