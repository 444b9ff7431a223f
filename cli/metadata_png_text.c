/* Texts of a PNG. Some hold XMP or, as ImageMagick writes them, Exif and IPTC as hexadecimal
 * digits: these are taken apart, since they can tell of a turn and hold a thumbnail. */
#include <gio/gio.h>
#include <stdlib.h>
#include <string.h>

#include "metadata_parts.h"

#define XMP_KEY "XML:com.adobe.xmp"
#define RAW_KEY "Raw profile type "
/* Texts that are taken apart: one of each of three kinds counts, and each may take 50 ms. */
#define MOST_UNPACKED 12

static GByteArray *unpack(const uint8_t *bytes, size_t size) {
  GByteArray *to = g_byte_array_sized_new((guint)METADATA_LONGEST_TEXT);
  GConverter *zlib = G_CONVERTER(g_zlib_decompressor_new(G_ZLIB_COMPRESSOR_FORMAT_ZLIB));
  gsize read = 0, written = 0;
  GConverterResult result;
  g_byte_array_set_size(to, (guint)METADATA_LONGEST_TEXT);
  /* Once is enough: what does not fit then is no metadata. */
  result = g_converter_convert(zlib, bytes, size, to->data, METADATA_LONGEST_TEXT,
                               G_CONVERTER_INPUT_AT_END, &read, &written, NULL);
  g_object_unref(zlib);
  g_byte_array_set_size(to, (guint)written);
  if (result == G_CONVERTER_FINISHED) return to;
  g_byte_array_unref(to);
  return NULL;
}

/* A chunk's text, from after its keyword's 0 on. NULL: damaged. */
static GByteArray *text_of(const char *kind, const uint8_t *data, size_t size) {
  bool packed = strcmp(kind, "zTXt") == 0;
  if (packed) {
    if (size < 1) return NULL;
    data++, size--; /* the method: there is one */
  } else if (strcmp(kind, "iTXt") == 0) {
    if (size < 2) return NULL;
    packed = data[0] != 0;
    data += 2, size -= 2;
    for (int skipped = 0; skipped < 2; skipped++) { /* language, translated keyword */
      const uint8_t *end = memchr(data, 0, size);
      if (!end) return NULL;
      size -= (size_t)(end + 1 - data);
      data = end + 1;
    }
  }
  return packed ? unpack(data, size) : metadata_copy(data, size);
}

/* An empty line, a name, the number of bytes, then the bytes as hexadecimal digits. */
static GByteArray *bytes_of_digits(GByteArray *text) {
  g_byte_array_append(text, (const uint8_t *)"", 1);
  const char *at = strchr((const char *)text->data + (text->len > 1), '\n');
  char *end;
  if (!at) return NULL;
  unsigned long count = strtoul(at, &end, 10);
  if (count == 0 || count > text->len / 2) return NULL;
  GByteArray *bytes = g_byte_array_new();
  unsigned value = 0, digits = 0;
  for (; *end && bytes->len < count; end++) {
    int digit = g_ascii_xdigit_value(*end);
    if (digit < 0) continue;
    value = value << 4 | (unsigned)digit;
    uint8_t byte = (uint8_t)value;
    if (++digits % 2 == 0) g_byte_array_append(bytes, &byte, 1);
  }
  if (bytes->len == count) return bytes;
  g_byte_array_unref(bytes);
  return NULL;
}

void metadata_take_text(metadata_parts *parts, const uint8_t *whole, size_t whole_size) {
  char kind[5] = "";
  const uint8_t *data = whole + 8;
  size_t size = whole_size - 12;
  const uint8_t *end = memchr(data, 0, size);
  memcpy(kind, whole + 4, 4);
  bool raw = end && g_str_has_prefix((const char *)data, RAW_KEY);
  if (!raw && !(end && strcmp((const char *)data, XMP_KEY) == 0)) {
    g_byte_array_append(parts->texts, whole, (guint)whole_size);
    return;
  }
  if (parts->unpacked++ >= MOST_UNPACKED) {
    parts->lost = true;
    return;
  }
  GByteArray *text = text_of(kind, end + 1, size - (size_t)(end + 1 - data));
  GByteArray *bytes = text && raw ? bytes_of_digits(text) : text;
  if (bytes)
    metadata_take(parts, bytes->data, bytes->len);
  else
    parts->lost = true;
  if (text && bytes != text) g_byte_array_unref(text);
  if (bytes) g_byte_array_unref(bytes);
}
