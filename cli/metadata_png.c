/* Exif, XMP, texts, profile and resolution in a PNG's chunks. */
#include <math.h>
#include <string.h>

#include "metadata.h"
#include "metadata_parts.h"

#define SIGNATURE 8
#define XMP_HEAD "XML:com.adobe.xmp\0\0\0\0" /* keyword, not compressed, no language; and a 0 */

typedef struct chunk {
  char name[5];
  const uint8_t *whole, *data;
  size_t whole_size, size;
} chunk;

static bool next_chunk(const uint8_t *bytes, size_t size, size_t *at, chunk *found) {
  if (*at + 12 > size) return false;
  const uint8_t *head = bytes + *at;
  size_t length = (size_t)head[0] << 24 | (size_t)head[1] << 16 | (size_t)head[2] << 8 | head[3];
  if (length > size - *at - 12) return false;
  *found = (chunk){"", head, head + 8, length + 12, length};
  memcpy(found->name, head + 4, 4);
  *at += length + 12;
  return true;
}

static bool is_one_of(const chunk *found, const char *names) {
  return strstr(names, found->name) != NULL;
}

unsigned metadata_png_packed_texts(const uint8_t *bytes, size_t size) {
  chunk found;
  unsigned packed = 0;
  for (size_t at = SIGNATURE; next_chunk(bytes, size, &at, &found);) {
    const uint8_t *end = memchr(found.data, 0, found.size);
    bool flagged = end && (size_t)(end + 1 - found.data) < found.size && end[1] != 0;
    packed += strcmp(found.name, "zTXt") == 0 || (strcmp(found.name, "iTXt") == 0 && flagged);
  }
  return packed;
}

void metadata_from_png(const uint8_t *bytes, size_t size, metadata_parts *parts) {
  chunk found;
  parts->colours = g_byte_array_new();
  parts->texts = g_byte_array_new();
  /* Exif has a chunk of its own, which counts before a text that holds it. */
  for (size_t at = SIGNATURE; next_chunk(bytes, size, &at, &found);)
    if (strcmp(found.name, "eXIf") == 0) metadata_take(parts, found.data, found.size);
  for (size_t at = SIGNATURE; next_chunk(bytes, size, &at, &found);) {
    if (is_one_of(&found, "tEXt zTXt iTXt"))
      metadata_take_text(parts, found.whole, found.whole_size);
    else if (is_one_of(&found, "iCCP sRGB gAMA cHRM cICP pHYs"))
      g_byte_array_append(parts->colours, found.whole, (guint)found.whole_size);
  }
}

/* The CRC of PNG's specification, annex D, a bit at a time: metadata is short. */
static uint32_t crc_of(const uint8_t *bytes, size_t size) {
  uint32_t crc = 0xffffffffu;
  for (size_t i = 0; i < size; i++) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
  }
  return ~crc;
}

static void put_big32(GByteArray *to, uint32_t value) {
  uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                      (uint8_t)value};
  g_byte_array_append(to, bytes, 4);
}

static void put_chunk(GByteArray *to, const char *name, const uint8_t *head, size_t head_size,
                      const uint8_t *data, size_t size) {
  put_big32(to, (uint32_t)(head_size + size));
  guint at = to->len;
  g_byte_array_append(to, (const uint8_t *)name, 4);
  g_byte_array_append(to, head, (guint)head_size);
  g_byte_array_append(to, data, (guint)size);
  put_big32(to, crc_of(to->data + at, to->len - at));
}

static void put_resolution(GByteArray *to, const metadata_parts *parts) {
  GByteArray *data = g_byte_array_new();
  if (!(parts->dpi_x > 0 && parts->dpi_y > 0 && parts->dpi_x < 1e6 && parts->dpi_y < 1e6)) {
    g_byte_array_unref(data);
    return;
  }
  put_big32(data, (uint32_t)lround(parts->dpi_x / .0254));
  put_big32(data, (uint32_t)lround(parts->dpi_y / .0254));
  put_chunk(to, "pHYs", (const uint8_t *)"", 0, data->data, data->len);
  to->data[to->len - 5] = 1; /* the unit: the metre */
  g_byte_array_unref(data);
}

static void put_parts(GByteArray *to, const metadata_parts *parts) {
  if (parts->colours)
    g_byte_array_append(to, parts->colours->data, parts->colours->len);
  else
    put_resolution(to, parts);
  if (parts->texts) g_byte_array_append(to, parts->texts->data, parts->texts->len);
  if (parts->exif)
    put_chunk(to, "eXIf", (const uint8_t *)"", 0, parts->exif->data, parts->exif->len);
  if (parts->xmp)
    put_chunk(to, "iTXt", (const uint8_t *)XMP_HEAD, sizeof XMP_HEAD, parts->xmp->data,
              parts->xmp->len);
}

/* Of the encoder's chunks those stay that make the picture; its profile where the source, being no
 * PNG, brings none of its own. */
GByteArray *metadata_into_png(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                              bool *lost) {
  GByteArray *to = metadata_copy(bytes, SIGNATURE);
  chunk found;
  bool put = false;
  if (parts->iptc) *lost = true; /* PNG has no place for it */
  for (size_t at = SIGNATURE; next_chunk(bytes, size, &at, &found);) {
    if (!put && strcmp(found.name, "IDAT") == 0) {
      put_parts(to, parts);
      put = true;
    }
    if (is_one_of(&found,
                  parts->colours ? "IHDR PLTE tRNS IDAT IEND" : "IHDR PLTE tRNS IDAT IEND iCCP"))
      g_byte_array_append(to, found.whole, (guint)found.whole_size);
  }
  return to;
}
