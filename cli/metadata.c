#include "metadata.h"

#include <stdlib.h>
#include <string.h>

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

static void clear(metadata_parts *parts) {
  GByteArray **all[] = {&parts->exif, &parts->xmp, &parts->iptc, &parts->chunks, &parts->comment};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
    if (*all[i]) g_byte_array_unref(*all[i]);
}

static metadata_parts parts_of(const image_file *from, bool keep) {
  metadata_parts parts = {NULL};
  if (!from) return parts;
  parts.dpi_x = from->info.dpi_x;
  parts.dpi_y = from->info.dpi_y;
  const char *kind = from->format->codec;
  const uint8_t *bytes = from->bytes.data;
  if (strcmp(kind, "jpeg") == 0) metadata_from_jpeg(bytes, from->bytes.size, &parts);
  if (strcmp(kind, "png") == 0) metadata_from_png(bytes, from->bytes.size, keep, &parts);
  if (strcmp(kind, "tiff") == 0) metadata_from_tiff(bytes, from->bytes.size, &parts);
  return parts;
}

/* Where the tag has a place. JPEG and PNG take it within an Exif block, which must be there. */
bool metadata_carries_orientation(const image_file *from, const image_format *format) {
  if (strcmp(format->codec, "tiff") == 0 || strcmp(format->codec, "openexr") == 0) return true;
  if (strcmp(format->codec, "jpeg") != 0 && strcmp(format->codec, "png") != 0) return false;
  metadata_parts parts = parts_of(from, true);
  bool has_block = parts.exif != NULL;
  clear(&parts);
  return has_block;
}

/* For another picture: its colours and resolution are all that is left. */
static void drop_description(metadata_parts *parts) {
  GByteArray **all[] = {&parts->exif, &parts->xmp, &parts->iptc, &parts->comment};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) {
    if (*all[i]) g_byte_array_unref(*all[i]);
    *all[i] = NULL;
  }
}

image_status metadata_carry(const image_file *from, const image_format *format, bool keep,
                            image_bytes *bytes, image_message *message) {
  bool lost = false;
  GByteArray *made = NULL;
  bool png = strcmp(format->codec, "png") == 0;
  if (bytes->size > LONGEST_FILE) {
    g_snprintf(message->text, sizeof message->text, "The file is too long for metadata.");
    return IMAGE_OK;
  }
  /* GLib ends the process where it gets no memory: ask before for what its arrays grow to. */
  void *room = malloc(2 * bytes->size + ((size_t)1 << 20));
  free(room);
  if (!room) {
    g_strlcpy(message->text, "not enough memory to write", sizeof message->text);
    return IMAGE_NO_MEMORY;
  }
  metadata_parts parts = parts_of(from, keep);
  if (!keep) drop_description(&parts);
  if (png) made = metadata_into_png(bytes->data, bytes->size, &parts, &lost);
  if (strcmp(format->codec, "jpeg") == 0)
    made = metadata_into_jpeg(bytes->data, bytes->size, &parts, &lost);
  if (strcmp(format->codec, "tiff") == 0)
    made = metadata_into_tiff(bytes->data, bytes->size, &parts, &lost);
  if (!made) lost = parts.exif || parts.xmp || parts.iptc;
  clear(&parts);
  if (lost)
    g_snprintf(message->text, sizeof message->text, "Not all of the input's metadata fits in %s.",
               format->name);
  if (!made) return IMAGE_OK;
  image_bytes_free(bytes);
  bytes->size = made->len;
  bytes->data = g_byte_array_free(made, FALSE);
  return IMAGE_OK;
}
