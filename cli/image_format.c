#include "image_format.h"

#include <glib.h>
#include <string.h>

#define U8 (1u << RECEDE_U8)
#define U16 (1u << RECEDE_U16)
#define HALF (1u << RECEDE_HALF)
#define FLOAT (1u << RECEDE_FLOAT)
#define GRAY (1u << 1)
#define GRAY_ALPHA (1u << 2)
#define RGB (1u << 3)
#define RGBA (1u << 4)
#define ALL (GRAY | GRAY_ALPHA | RGB | RGBA)

/* What the writers of OpenImageIO 2.4 were seen to keep bit for bit (JPEG, which cannot, apart),
 * and the longest sides: of libjpeg, whose fault would end the process, libpng and Targa's header.
 * WebP: until 3.0 its writer halves the colours even when it is asked to lose nothing. */
static const image_format formats[] = {
    {"PNG", "png", {"png"}, U8 | U16, ALL, 1000000},
    {"JPEG", "jpeg", {"jpg", "jpeg", "jpe"}, U8, GRAY | RGB, 65500},
    {"TIFF", "tiff", {"tif", "tiff"}, U8 | U16 | FLOAT, ALL, 0},
    {"OpenEXR", "openexr", {"exr"}, HALF | FLOAT, ALL, 0},
    {"WebP", "webp", {"webp"}, 0, 0, 0},
    {"BMP", "bmp", {"bmp"}, U8, GRAY | RGB | RGBA, 0},
    {"Radiance HDR", "hdr", {"hdr"}, FLOAT, RGB, 0},
    {"PNM", "pnm", {"ppm", "pgm", "pnm"}, U8, GRAY | RGB, 0},
    {"Targa", "targa", {"tga"}, U8, ALL, 65535},
};
#define FORMATS (sizeof formats / sizeof *formats)
enum { PNG, JPEG, TIFF, EXR, WEBP, BMP, HDR, PNM, TARGA };

const char *image_format_read(void) {
  return ".png, .jpg, .tif, .exr, .webp, .bmp, .hdr, .ppm, .tga";
}

const char *image_format_written(void) { return ".png, .jpg, .tif, .exr, .bmp, .hdr, .ppm, .tga"; }

const image_format *image_format_of_name(const char *path) {
  const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
  if (!dot || (slash && dot < slash)) return NULL;
  for (size_t i = 0; i < FORMATS; i++)
    for (size_t k = 0; k < 5 && formats[i].suffixes[k]; k++)
      if (g_ascii_strcasecmp(dot + 1, formats[i].suffixes[k]) == 0) return &formats[i];
  return NULL;
}

static bool starts(const unsigned char *bytes, size_t size, const char *mark, size_t length) {
  return size >= length && memcmp(bytes, mark, length) == 0;
}

const image_format *image_format_of_bytes(const unsigned char *bytes, size_t size,
                                          const char *path) {
  static const struct {
    const char *mark;
    size_t length;
    int format;
  } marks[] = {
      {"\x89PNG\r\n\x1a\n", 8, PNG},
      {"\xff\xd8\xff", 3, JPEG},
      {"II*\0", 4, TIFF},
      {"MM\0*", 4, TIFF},
      {"II+\0", 4, TIFF},
      {"MM\0+", 4, TIFF},
      {"\x76\x2f\x31\x01", 4, EXR},
      {"BM", 2, BMP},
      {"#?RADIANCE", 10, HDR},
      {"#?RGBE", 6, HDR},
      {"P1", 2, PNM},
      {"P2", 2, PNM},
      {"P3", 2, PNM},
      {"P4", 2, PNM},
      {"P5", 2, PNM},
      {"P6", 2, PNM},
      {"Pf", 2, PNM},
      {"PF", 2, PNM},
  };
  for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
    if (starts(bytes, size, marks[i].mark, marks[i].length)) return &formats[marks[i].format];
  if (starts(bytes, size, "RIFF", 4) && size > 12 && memcmp(bytes + 8, "WEBP", 4) == 0)
    return &formats[WEBP];
  const image_format *named = image_format_of_name(path);
  return named == &formats[TARGA] ? named : NULL;
}

bool image_format_holds(const image_format *format, recede_type type) {
  return (format->types & (1u << type)) != 0;
}

bool image_format_lossy(const image_format *format) {
  return format == &formats[JPEG] || format == &formats[WEBP];
}

static unsigned big16(const unsigned char *at) { return (unsigned)at[0] << 8 | at[1]; }

bool image_format_png_header(const unsigned char *bytes, size_t size, int *bits, bool *indexed) {
  if (size < 33 || image_format_of_bytes(bytes, size, "") != &formats[PNG]) return false;
  *bits = bytes[24];
  *indexed = bytes[25] == 3;
  return true;
}

uint64_t image_format_png_bytes(const unsigned char *bytes, size_t size) {
  static const unsigned samples[] = {1, 0, 3, 1, 2, 0, 4}; /* of a pixel, by the kind of colours */
  if (size < 33 || image_format_of_bytes(bytes, size, "") != &formats[PNG] || bytes[25] > 6)
    return 0;
  uint64_t width = (uint64_t)big16(bytes + 16) << 16 | big16(bytes + 18);
  uint64_t height = (uint64_t)big16(bytes + 20) << 16 | big16(bytes + 22);
  return height * ((width * bytes[24] * samples[bytes[25]] + 7) / 8);
}

/* From 40 bytes on the header says how the pixels are packed; 1 and 2 are RLE. */
bool image_format_bmp_rle(const image_format *format, const unsigned char *bytes, size_t size) {
  if (format != &formats[BMP] || size < 34 || (bytes[14] < 40 && !bytes[15])) return false;
  return (bytes[30] == 1 || bytes[30] == 2) && !bytes[31] && !bytes[32] && !bytes[33];
}

/* APNG says so before the pixels, in a chunk "acTL"; WebP in the flags of its chunk "VP8X". */
bool image_format_animated(const image_format *format, const unsigned char *bytes, size_t size) {
  if (format == &formats[WEBP])
    return size > 20 && memcmp(bytes + 12, "VP8X", 4) == 0 && (bytes[20] & 2);
  if (format != &formats[PNG]) return false;
  for (size_t at = 8; at + 8 <= size && memcmp(bytes + at + 4, "IDAT", 4) != 0;) {
    if (memcmp(bytes + at + 4, "acTL", 4) == 0) return true;
    at += 12 + ((size_t)big16(bytes + at) << 16 | big16(bytes + at + 2));
  }
  return false;
}
