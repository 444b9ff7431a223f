#include "metadata.h"

#include <stdlib.h>
#include <string.h>

#include "exif.h"
#include "metadata_parts.h"

#define LONGEST_FILE 0x7fffffffu /* GByteArray counts in 32 bits */

GByteArray *metadata_copy(const uint8_t *bytes, size_t size) {
  GByteArray *copy = g_byte_array_new();
  g_byte_array_append(copy, bytes, (guint)size);
  return copy;
}

/* A resource: "8BIM", number, name (a counted string, padded to even), length, data (padded). */
GByteArray *metadata_clean_iptc(const uint8_t *bytes, size_t size) {
  GByteArray *clean = g_byte_array_new();
  for (size_t at = 0; at + 12 <= size && memcmp(bytes + at, "8BIM", 4) == 0;) {
    unsigned number = (unsigned)bytes[at + 4] << 8 | bytes[at + 5];
    size_t name = ((size_t)bytes[at + 6] + 2) & ~(size_t)1, data = at + 6 + name + 4;
    if (data > size) break;
    const uint8_t *length = bytes + data - 4;
    size_t count =
        (size_t)length[0] << 24 | (size_t)length[1] << 16 | (size_t)length[2] << 8 | length[3];
    if (count > size - data) break;
    size_t end = MIN(data + ((count + 1) & ~(size_t)1), size);
    if (number != 1033 && number != 1036) g_byte_array_append(clean, bytes + at, (guint)(end - at));
    at = end;
  }
  return clean;
}

void metadata_take(metadata_parts *parts, const uint8_t *bytes, size_t size) {
  static const char exif[] = "Exif\0", xmp[] = "http://ns.adobe.com/xap/1.0/"; /* and a 0 each */
  GByteArray **part = NULL;
  if (size > sizeof exif && memcmp(bytes, exif, sizeof exif) == 0) {
    part = &parts->exif;
    bytes += sizeof exif, size -= sizeof exif;
  } else if (size > 4 && (memcmp(bytes, "II*\0", 4) == 0 || memcmp(bytes, "MM\0*", 4) == 0)) {
    part = &parts->exif;
  } else if (size > sizeof xmp && memcmp(bytes, xmp, sizeof xmp) == 0) {
    part = &parts->xmp;
    bytes += sizeof xmp, size -= sizeof xmp;
  } else if (size > 1 && bytes[0] == '<') {
    part = &parts->xmp;
  } else if (size > 4 && memcmp(bytes, "8BIM", 4) == 0) {
    part = &parts->iptc;
  }
  if (!part)
    parts->lost = true;
  else if (!*part)
    *part = part == &parts->iptc ? metadata_clean_iptc(bytes, size) : metadata_copy(bytes, size);
}

/* GLib ends the process where it gets no memory: ask before for what its arrays grow to, and for
 * one text and its copy. */
static bool has_room(size_t size) {
  void *room = malloc(2 * size + 2 * METADATA_LONGEST_TEXT);
  free(room);
  return room != NULL;
}

/* How Exif says that the picture is turned; 0: it does not. */
static int turn_in_exif(const GByteArray *exif) {
  exif_tree tree;
  int turn = 0;
  if (!exif) return 0;
  exif_read(exif->data, exif->len, &tree);
  const exif_entry *entry = exif_find(&tree, EXIF_MAIN, EXIF_TAG_ORIENTATION);
  if (entry && entry->type == 3) turn = entry->value[tree.big_endian ? 1 : 0];
  exif_clear(&tree);
  return turn <= 8 ? turn : 0;
}

static void drop(metadata_parts *parts, GByteArray **part) {
  g_byte_array_unref(*part);
  *part = NULL;
  parts->lost = true;
}

image_status metadata_read(image_file *file, image_message *message) {
  const char *kind = file->format->codec;
  const uint8_t *bytes = file->bytes.data;
  size_t size = file->bytes.size;
  if (!has_room(size)) {
    g_strlcpy(message->text, "not enough memory for its metadata", sizeof message->text);
    return IMAGE_NO_MEMORY;
  }
  metadata_parts *parts = file->metadata = g_new0(metadata_parts, 1);
  parts->dpi_x = file->info.dpi_x;
  parts->dpi_y = file->info.dpi_y;
  if (strcmp(kind, "jpeg") == 0)
    metadata_from_jpeg(bytes, size, parts);
  else if (strcmp(kind, "png") == 0)
    metadata_from_png(bytes, size, parts);
  else if (strcmp(kind, "tiff") == 0)
    metadata_from_tiff(bytes, size, parts);
  else if (strcmp(kind, "webp") == 0)
    metadata_from_webp(bytes, size, parts);
  else
    return IMAGE_OK;
  /* The decoder's word may be XMP's, by which no viewer turns. */
  int turn = turn_in_exif(parts->exif);
  if (parts->exif && !exif_blank_thumbnails(parts->exif->data, parts->exif->len))
    drop(parts, &parts->exif);
  if (parts->xmp && !metadata_clean_xmp(parts->xmp)) drop(parts, &parts->xmp);
  file->info.turn_given = turn > 0;
  file->info.orientation = turn > 0 ? turn : 1;
  if (strcmp(kind, "tiff") == 0)
    file->info.premultiplied = metadata_tiff_is_premultiplied(bytes, size);
  if (!parts->profile) return IMAGE_OK;
  file->info.profile = true;
  return image_decoder_set_profile(file->decoder, parts->profile->data, parts->profile->len,
                                   message);
}

void metadata_free(image_file *file) {
  metadata_parts *parts = file->metadata;
  if (!parts) return;
  GByteArray *all[] = {parts->exif,    parts->xmp,   parts->iptc,   parts->profile,
                       parts->colours, parts->texts, parts->comment};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
    if (all[i]) g_byte_array_unref(all[i]);
  g_free(parts);
  file->metadata = NULL;
}

/* Where the tag has a place. JPEG and PNG take it within an Exif block, which must be there. */
bool metadata_carries_orientation(const image_file *from, const image_format *format) {
  if (strcmp(format->codec, "tiff") == 0 || strcmp(format->codec, "openexr") == 0) return true;
  if (strcmp(format->codec, "jpeg") != 0 && strcmp(format->codec, "png") != 0) return false;
  return from && from->metadata->exif;
}

/* For another picture: its colours and resolution are all that is left. */
static metadata_parts parts_of(const image_file *from, bool keep) {
  metadata_parts parts = {NULL};
  if (!from) return parts;
  parts = *from->metadata;
  if (!keep) {
    parts.exif = parts.xmp = parts.iptc = parts.texts = parts.comment = NULL;
    parts.lost = false;
  }
  return parts;
}

/* More than turn and resolution, which every TIFF states and we carry by ourselves. */
static bool describes(const GByteArray *exif) {
  exif_tree tree;
  bool more = false;
  if (!exif) return false;
  exif_read(exif->data, exif->len, &tree);
  for (guint i = 0; i < tree.entries->len; i++) {
    const exif_entry *entry = &g_array_index(tree.entries, exif_entry, i);
    bool ours = entry->tag == EXIF_TAG_ORIENTATION || entry->tag == EXIF_TAG_X_RESOLUTION ||
                entry->tag == EXIF_TAG_Y_RESOLUTION || entry->tag == EXIF_TAG_RESOLUTION_UNIT;
    more |= entry->folder != EXIF_MAIN || !ours;
  }
  exif_clear(&tree);
  return more;
}

image_status metadata_carry(const image_file *from, const image_format *format, bool keep,
                            image_bytes *bytes, image_message *message) {
  GByteArray *made = NULL;
  if (bytes->size > LONGEST_FILE) {
    g_snprintf(message->text, sizeof message->text, "The file is too long for metadata.");
    return IMAGE_OK;
  }
  if (!has_room(bytes->size)) {
    g_strlcpy(message->text, "not enough memory to write", sizeof message->text);
    return IMAGE_NO_MEMORY;
  }
  metadata_parts parts = parts_of(from, keep);
  bool lost = parts.lost;
  if (strcmp(format->codec, "png") == 0)
    made = metadata_into_png(bytes->data, bytes->size, &parts, &lost);
  if (strcmp(format->codec, "jpeg") == 0)
    made = metadata_into_jpeg(bytes->data, bytes->size, &parts, &lost);
  if (strcmp(format->codec, "tiff") == 0)
    made = metadata_into_tiff(bytes->data, bytes->size, &parts, &lost);
  if (!made)
    lost |= describes(parts.exif) || parts.xmp || parts.iptc || (from && from->info.profile);
  lost |= parts.comment && strcmp(format->codec, "jpeg") != 0;
  lost |= parts.texts && parts.texts->len > 0 && strcmp(format->codec, "png") != 0;
  if (lost)
    g_snprintf(
        message->text, sizeof message->text,
        "Not all that the input holds beside its pixels (profile, Exif, XMP, IPTC, comments, "
        "further pictures) is kept in %s.",
        format->name);
  if (!made) return IMAGE_OK;
  image_bytes_free(bytes);
  bytes->size = made->len;
  bytes->data = g_byte_array_free(made, FALSE);
  return IMAGE_OK;
}
