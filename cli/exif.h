/* exif.h - Exif, that is TIFF's tree of tags: read from a TIFF, or from the block that JPEG and PNG
 * carry; and written. BigTIFF is read, never written. */
#ifndef RECEDE_EXIF_H
#define RECEDE_EXIF_H

#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum exif_folder { EXIF_MAIN, EXIF_EXIF, EXIF_GPS, EXIF_INTEROP, EXIF_FOLDERS } exif_folder;

typedef struct exif_entry {
  exif_folder folder;
  uint16_t tag, type;
  uint32_t count;
  const uint8_t *value; /* in the bytes that were read, in their byte order */
  size_t size;
} exif_entry;

typedef struct exif_tree {
  bool big_endian;
  bool cut;        /* there were more entries, or longer ones, than any sound file has */
  GArray *entries; /* exif_entry */
} exif_tree;

enum {
  EXIF_TAG_ORIENTATION = 274,
  EXIF_TAG_X_RESOLUTION = 282,
  EXIF_TAG_Y_RESOLUTION = 283,
  EXIF_TAG_RESOLUTION_UNIT = 296,
  EXIF_TAG_XMP = 700,
  EXIF_TAG_IPTC = 33723,
  EXIF_TAG_PHOTOSHOP = 34377,
  EXIF_TAG_PROFILE = 34675,
  EXIF_TAG_LAYERS = 37724
};

/* false: it is no TIFF structure; the tree is empty. Entries that lie outside the bytes are
 * left out; of pointers to a folder of one kind the first counts. The bytes must live as long as
 * the tree. */
bool exif_read(const uint8_t *bytes, size_t size, exif_tree *tree);
void exif_clear(exif_tree *tree);

const exif_entry *exif_find(const exif_tree *tree, exif_folder folder, uint16_t tag);
/* Takes out what describes how a TIFF's pixels are stored, and its profile. */
void exif_remove_structure(exif_tree *tree);
void exif_remove(exif_tree *tree, exif_folder folder, uint16_t tag);

/* Appends the entries of two trees (those of the first win) in little-endian order to a structure
 * that starts at the array's byte `start`; returns the offset of its first folder from there. */
uint32_t exif_append(const exif_tree *first, const exif_tree *second, GByteArray *to, guint start);

/* Blanks thumbnails, which would show what was removed: in the block itself, so that makers' notes
 * stay where they are. false: they cannot be told from the rest. */
bool exif_blank_thumbnails(uint8_t *bytes, size_t size);

#endif
