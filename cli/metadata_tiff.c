/* Exif, XMP and IPTC as tags of a TIFF. */
#include <string.h>

#include "exif.h"
#include "metadata.h"
#include "metadata_parts.h"

static const uint8_t empty_structure[8] = {'I', 'I', '*', 0};

static GByteArray *value_of(const exif_tree *tree, uint16_t tag) {
  const exif_entry *entry = exif_find(tree, EXIF_MAIN, tag);
  return entry ? metadata_copy(entry->value, entry->size) : NULL;
}

bool metadata_tiff_is_premultiplied(const uint8_t *bytes, size_t size) {
  exif_tree tree;
  bool associated = false;
  if (exif_read(bytes, size, &tree)) {
    const exif_entry *extra = exif_find(&tree, EXIF_MAIN, 338);
    associated = extra && extra->type == 3 && extra->value[tree.big_endian ? 1 : 0] == 1;
  }
  exif_clear(&tree);
  return associated;
}

void metadata_from_tiff(const uint8_t *bytes, size_t size, metadata_parts *parts) {
  exif_tree tree;
  if (exif_read(bytes, size, &tree)) {
    parts->lost |= tree.cut;
    parts->xmp = value_of(&tree, EXIF_TAG_XMP);
    const exif_entry *photoshop = exif_find(&tree, EXIF_MAIN, EXIF_TAG_PHOTOSHOP);
    if (photoshop) parts->iptc = metadata_clean_iptc(photoshop->value, photoshop->size);
    exif_remove_structure(&tree);
    exif_remove(&tree, EXIF_MAIN, EXIF_TAG_XMP);
    exif_remove(&tree, EXIF_MAIN, EXIF_TAG_PHOTOSHOP);
    exif_remove(&tree, EXIF_MAIN, EXIF_TAG_LAYERS); /* the old picture, as Photoshop's layers */
    parts->exif = metadata_copy(empty_structure, sizeof empty_structure);
    exif_append(&tree, NULL, parts->exif, 0);
  }
  exif_clear(&tree);
}

static void add(exif_tree *tree, uint16_t tag, uint16_t type, const GByteArray *data) {
  exif_entry entry = {EXIF_MAIN, tag, type, 0, NULL, 0};
  if (!data || data->len == 0) return;
  entry.count = data->len;
  entry.value = data->data;
  entry.size = data->len;
  g_array_append_val(tree->entries, entry);
}

/* A new first folder at the end: the encoder's tags, which know where the pixels are, and then
 * everything else. */
GByteArray *metadata_into_tiff(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost) {
  exif_tree made, more;
  GByteArray *to = metadata_copy(bytes, size);
  if (!exif_read(bytes, size, &made) || made.big_endian || size > G_MAXUINT32 - (1u << 28)) {
    *lost = true;
    exif_clear(&made);
    return to;
  }
  bool has_exif = parts->exif && exif_read(parts->exif->data, parts->exif->len, &more);
  if (!has_exif) exif_read((const uint8_t *)"", 0, &more);
  *lost |= more.cut;
  exif_remove_structure(&more);
  exif_remove(&made, EXIF_MAIN, 306); /* the encoder's date is today's */
  static const uint16_t better[] = {EXIF_TAG_ORIENTATION, EXIF_TAG_X_RESOLUTION,
                                    EXIF_TAG_Y_RESOLUTION, EXIF_TAG_RESOLUTION_UNIT};
  for (size_t i = 0; i < G_N_ELEMENTS(better); i++)
    if (exif_find(&more, EXIF_MAIN, better[i])) exif_remove(&made, EXIF_MAIN, better[i]);
  add(&made, EXIF_TAG_XMP, 1, parts->xmp);
  add(&made, EXIF_TAG_PHOTOSHOP, 1, parts->iptc);
  exif_append(&made, &more, to, 0);
  exif_clear(&made);
  exif_clear(&more);
  return to;
}
