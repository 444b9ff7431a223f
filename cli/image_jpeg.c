#include "image_jpeg.h"

#include <string.h>

#define BYTES_OF_COEFFICIENT 2

static unsigned big16(const unsigned char *at) { return (unsigned)at[0] << 8 | at[1]; }

/* Where the entropy-coded data that starts at `at` ends: the next marker that is no restart. */
static size_t end_of_scan(const unsigned char *bytes, size_t size, size_t at) {
  for (; at + 1 < size; at++) {
    if (bytes[at] != 0xff || bytes[at + 1] == 0 || bytes[at + 1] == 0xff) continue;
    if (bytes[at + 1] < 0xd0 || bytes[at + 1] > 0xd7) return at;
  }
  return size;
}

/* Of all components, each with its share of the columns and rows. */
static uint64_t samples_of(const unsigned char *component, int count, unsigned width,
                           unsigned height) {
  unsigned across = 1, down = 1;
  uint64_t samples = 0;
  for (int i = 0; i < count; i++) {
    unsigned factors = component[3 * i + 1];
    if (factors >> 4 > across) across = factors >> 4;
    if ((factors & 15) > down) down = factors & 15;
  }
  for (int i = 0; i < count; i++) {
    unsigned factors = component[3 * i + 1];
    uint64_t columns = (uint64_t)width * (factors >> 4) / across;
    samples += columns * ((uint64_t)height * (factors & 15) / down);
  }
  return samples;
}

/* at: a frame's header, of which `left` bytes are there; the first one counts, as for decoders. */
static void read_frame(image_jpeg *jpeg, const unsigned char *at, size_t left) {
  if (left < 10 || jpeg->channels) return;
  jpeg->height = (int)big16(at + 5);
  jpeg->width = (int)big16(at + 7);
  jpeg->channels = at[9];
  if (left < 10 + 3 * (size_t)at[9]) return;
  jpeg->coefficients =
      BYTES_OF_COEFFICIENT * samples_of(at + 10, at[9], big16(at + 7), big16(at + 5));
}

static bool is_frame(unsigned marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

image_jpeg image_jpeg_walk(const unsigned char *bytes, size_t size) {
  image_jpeg jpeg = {0};
  for (size_t at = 2; at + 1 < size && !jpeg.whole;) {
    unsigned marker = bytes[at + 1];
    if (bytes[at] != 0xff || marker == 0 || marker == 0xff) { /* stray or fill: decoders go on */
      at++;
    } else if (marker == 0xd9) {
      jpeg.whole = true;
      jpeg.end = at + 2;
    } else if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7)) { /* without a length */
      at += 2;
    } else if (at + 4 > size) {
      break;
    } else {
      if (is_frame(marker)) read_frame(&jpeg, bytes + at, size - at);
      at += 2 + big16(bytes + at + 2);
      if (marker != 0xda) continue;
      jpeg.scans++;
      at = end_of_scan(bytes, size, at);
    }
  }
  if (jpeg.scans < 2) jpeg.coefficients = 0;
  return jpeg;
}
