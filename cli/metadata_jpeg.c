/* Exif, XMP, IPTC and comments in a JPEG's segments. */
#include <string.h>

#include "image_jpeg.h"
#include "metadata_parts.h"

#define EXIF "Exif\0"                      /* and one more 0 */
#define XMP "http://ns.adobe.com/xap/1.0/" /* and a 0 */
#define PHOTOSHOP "Photoshop 3.0"          /* and a 0 */
enum { APP0 = 0xe0, APP1 = 0xe1, APP2 = 0xe2, APP13 = 0xed, COMMENT = 0xfe, SCAN = 0xda };
#define LONGEST 65533 /* bytes of a segment: its length has 16 bits and counts itself */

#define LEAST_FOLLOWER 64 /* bytes: in fewer there is no picture, but a stray end of line */

typedef struct segment {
  unsigned marker;
  const uint8_t *whole, *data; /* from its 0xff; after its length */
  size_t whole_size, size;
} segment;

/* The segment at *at, which moves on; false at the scan or at anything odd. */
static bool next_segment(const uint8_t *bytes, size_t size, size_t *at, segment *found) {
  while (*at + 1 < size && bytes[*at] == 0xff && bytes[*at + 1] == 0xff) ++*at;
  if (*at + 4 > size || bytes[*at] != 0xff || bytes[*at + 1] == SCAN) return false;
  size_t length = (size_t)bytes[*at + 2] << 8 | bytes[*at + 3];
  if (length < 2 || *at + 2 + length > size) return false;
  *found = (segment){bytes[*at + 1], bytes + *at, bytes + *at + 4, length + 2, length - 2};
  *at += 2 + length;
  return true;
}

static bool begins(const segment *found, unsigned marker, const char *mark, size_t length) {
  return found->marker == marker && found->size > length && memcmp(found->data, mark, length) == 0;
}

static void append_to(GByteArray **to, const uint8_t *bytes, size_t size) {
  if (!*to) *to = g_byte_array_new();
  g_byte_array_append(*to, bytes, (guint)size);
}

/* Phones and cameras put a gain map, a preview or a video behind the picture. */
static bool is_followed(const uint8_t *bytes, size_t size) {
  image_jpeg jpeg = image_jpeg_walk(bytes, size);
  size_t more = 0;
  for (size_t i = jpeg.end; jpeg.whole && i < size && more < LEAST_FOLLOWER; i++)
    more += bytes[i] != 0 && bytes[i] != 0xff; /* what files are filled up with */
  return more >= LEAST_FOLLOWER;
}

void metadata_from_jpeg(const uint8_t *bytes, size_t size, metadata_parts *parts) {
  segment found;
  GByteArray *iptc = NULL;
  for (size_t at = 2; next_segment(bytes, size, &at, &found);) {
    if (found.marker == APP1) {
      metadata_take(parts, found.data, found.size);
    } else if (begins(&found, APP13, PHOTOSHOP, sizeof PHOTOSHOP)) {
      append_to(&iptc, found.data + sizeof PHOTOSHOP, found.size - sizeof PHOTOSHOP);
    } else if (found.marker == COMMENT) {
      append_to(&parts->comment, found.whole, found.whole_size);
    }
  }
  if (iptc) {
    parts->iptc = metadata_clean_iptc(iptc->data, iptc->len);
    g_byte_array_unref(iptc);
  }
  parts->lost |= is_followed(bytes, size);
}

static void put_segment(GByteArray *to, unsigned marker, const char *mark, size_t mark_size,
                        const GByteArray *data, bool *lost) {
  if (!data || data->len == 0) return;
  size_t length = 2 + mark_size + data->len;
  if (length > LONGEST + 2) {
    *lost = true;
    return;
  }
  uint8_t head[4] = {0xff, (uint8_t)marker, (uint8_t)(length >> 8), (uint8_t)length};
  g_byte_array_append(to, head, 4);
  g_byte_array_append(to, (const uint8_t *)mark, (guint)mark_size);
  g_byte_array_append(to, data->data, data->len);
}

static void put_parts(GByteArray *to, const metadata_parts *parts, bool *lost) {
  put_segment(to, APP1, EXIF, 6, parts->exif, lost);
  put_segment(to, APP1, XMP, sizeof XMP, parts->xmp, lost);
  put_segment(to, APP13, PHOTOSHOP, sizeof PHOTOSHOP, parts->iptc, lost);
  if (parts->comment) g_byte_array_append(to, parts->comment->data, parts->comment->len);
}

/* JFIF's segment stays first, the encoder's own Exif and IPTC go, its profile stays. */
GByteArray *metadata_into_jpeg(const uint8_t *bytes, size_t size, const metadata_parts *parts,
                               bool *lost) {
  GByteArray *to = metadata_copy(bytes, 2);
  segment found;
  size_t at = 2, before = 2;
  bool put = false;
  while (next_segment(bytes, size, &at, &found)) {
    if (!put && found.marker != APP0) {
      put_parts(to, parts, lost);
      put = true;
    }
    if (found.marker != APP1 && found.marker != APP13)
      g_byte_array_append(to, found.whole, (guint)found.whole_size);
    before = at;
  }
  g_byte_array_append(to, bytes + before, (guint)(size - before));
  return to;
}
