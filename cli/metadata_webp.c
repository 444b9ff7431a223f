/* Exif, XMP and profile in a WebP's chunks. */
#include <string.h>

#include "metadata_parts.h"

#define HEAD 12 /* "RIFF", length, "WEBP" */

void metadata_from_webp(const uint8_t *bytes, size_t size, metadata_parts *parts) {
  for (size_t at = HEAD; at + 8 <= size;) {
    const uint8_t *name = bytes + at, *length = name + 4, *data = name + 8;
    size_t count =
        (size_t)length[3] << 24 | (size_t)length[2] << 16 | (size_t)length[1] << 8 | length[0];
    if (count > size - at - 8) return;
    if (memcmp(name, "EXIF", 4) == 0 || memcmp(name, "XMP ", 4) == 0)
      metadata_take(parts, data, count);
    if (memcmp(name, "ICCP", 4) == 0 && !parts->profile)
      parts->profile = metadata_copy(data, count);
    at += 8 + count + count % 2;
  }
}
