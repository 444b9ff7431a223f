#include "image_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image_jpeg.h"
#include "metadata.h"
#include "pixels.h"

/* What deflate can do at most: a PNG that claims more is made to exhaust memory. */
#define BOMB_RATIO 1032
/* Cameras and programs write some 10, tuned ones some 60; each takes the time of a pass over the
 * whole picture, and two thousand fit in 1.5 MB. */
#define MOST_SCANS 200
/* libpng unpacks each twice, up to 8 MB: 50 ms each time. Programs write a few. */
#define MOST_PACKED_TEXTS 32

static image_status fail(image_message *message, image_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static image_status fail(image_message *message, image_status status, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message->text, sizeof message->text, format, arguments);
  va_end(arguments);
  return status;
}

/* ------------------------------------------------------------------------------------ read -- */

static image_status read_all(int fd, image_bytes *bytes, image_message *message) {
  size_t done = 0;
  while (done < bytes->size) {
    ssize_t got = read(fd, bytes->data + done, bytes->size - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(message, IMAGE_MALFORMED, "%s", strerror(errno));
    if (got == 0) break; /* it shrank meanwhile: what is left will tell */
    done += (size_t)got;
  }
  bytes->size = done;
  return IMAGE_OK;
}

static image_status load(const char *path, uint64_t limit, image_bytes *bytes,
                         image_message *message) {
  struct stat status;
  int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return fail(message, IMAGE_MALFORMED, "%s", strerror(errno));
  image_status result = IMAGE_OK;
  if (fstat(fd, &status) != 0)
    result = fail(message, IMAGE_MALFORMED, "%s", strerror(errno));
  else if (S_ISDIR(status.st_mode))
    result = fail(message, IMAGE_MALFORMED, "it is a folder");
  else if (!S_ISREG(status.st_mode))
    result = fail(message, IMAGE_MALFORMED, "it is no ordinary file");
  else if (status.st_size == 0)
    result = fail(message, IMAGE_MALFORMED, "it is empty");
  else if ((uint64_t)status.st_size > limit)
    result = fail(message, IMAGE_TOO_LARGE,
                  "the file has %llu MiB, the limit is %llu MiB (--memory raises it)",
                  (unsigned long long)status.st_size >> 20, (unsigned long long)limit >> 20);
  if (result == IMAGE_OK) {
    bytes->size = (size_t)status.st_size;
    bytes->data = malloc(bytes->size);
    result = bytes->data ? read_all(fd, bytes, message)
                         : fail(message, IMAGE_NO_MEMORY, "not enough memory");
  }
  close(fd);
  return result;
}

static image_status check_limit(int width, int height, uint64_t bytes, uint64_t limit,
                                image_message *message) {
  if (bytes <= limit) return IMAGE_OK;
  return fail(message, IMAGE_TOO_LARGE,
              "its %d x %d px take %llu MiB, the limit is %llu MiB (--memory raises it)", width,
              height, (unsigned long long)(bytes >> 20) + 1, (unsigned long long)limit >> 20);
}

static image_status check_jpeg(const image_file *file, uint64_t limit, image_message *message) {
  image_jpeg jpeg = image_jpeg_walk(file->bytes.data, file->bytes.size);
  if (jpeg.channels == 4)
    return fail(message, IMAGE_UNSUPPORTED, "its colours are CMYK; convert it to RGB first");
  if (!jpeg.whole)
    return fail(message, IMAGE_MALFORMED, "the file is cut off: the JPEG's end is missing");
  uint64_t bytes = pixels_bytes(jpeg.width, jpeg.height, jpeg.channels, RECEDE_U8);
  image_status status =
      check_limit(jpeg.width, jpeg.height, bytes + jpeg.coefficients, limit, message);
  if (status != IMAGE_OK || jpeg.scans <= MOST_SCANS) return status;
  return fail(
      message, IMAGE_MALFORMED,
      "its pixels come in %d scans, more than any picture needs (%d are read); save it anew",
      jpeg.scans, MOST_SCANS);
}

static image_status check_png(const image_file *file, image_message *message) {
  unsigned texts = metadata_png_packed_texts(file->bytes.data, file->bytes.size);
  if (texts <= MOST_PACKED_TEXTS) return IMAGE_OK;
  return fail(message, IMAGE_MALFORMED,
              "it holds %u compressed texts, more than any picture needs (%d are read); save it "
              "without them",
              texts, MOST_PACKED_TEXTS);
}

static image_status check_before_decoder(const image_file *file, uint64_t limit,
                                         image_message *message) {
  if (!file->format)
    return fail(message, IMAGE_MALFORMED, "it is no picture of a kind we read (%s)",
                image_format_read());
  if (image_format_bmp_rle(file->format, file->bytes.data, file->bytes.size))
    return fail(message, IMAGE_UNSUPPORTED,
                "its pixels are compressed (RLE), which is not read in BMP; save it without");
  if (strcmp(file->format->codec, "png") == 0) return check_png(file, message);
  return strcmp(file->format->codec, "jpeg") == 0 ? check_jpeg(file, limit, message) : IMAGE_OK;
}

static image_status check_size(const image_file *file, uint64_t limit, image_message *message) {
  const image_info *info = &file->info;
  uint64_t packed = image_format_png_bytes(file->bytes.data, file->bytes.size);
  if (packed / BOMB_RATIO > file->bytes.size)
    return fail(message, IMAGE_MALFORMED,
                "%llu bytes of file cannot hold the %d x %d px that it claims",
                (unsigned long long)file->bytes.size, info->width, info->height);
  uint64_t bytes = pixels_bytes(info->width, info->height, info->channels, info->type);
  return check_limit(info->width, info->height, bytes, limit, message);
}

image_status image_file_open(const char *path, uint64_t limit, image_file *file,
                             image_message *message) {
  memset(file, 0, sizeof *file);
  message->text[0] = '\0';
  file->path = path;
  image_status status = load(path, limit, &file->bytes, message);
  if (status != IMAGE_OK) return status;
  file->format = image_format_of_bytes(file->bytes.data, file->bytes.size, path);
  status = check_before_decoder(file, limit, message);
  if (status != IMAGE_OK) return status;
  status = image_decoder_new(file->format->codec, file->bytes.data, file->bytes.size,
                             &file->decoder, &file->info, message);
  if (status != IMAGE_OK) return status;
  image_format_png_header(file->bytes.data, file->bytes.size, &file->info.stored_bits,
                          &file->info.indexed);
  file->info.several |= image_format_animated(file->format, file->bytes.data, file->bytes.size);
  status = metadata_read(file, message);
  if (status != IMAGE_OK) return status;
  status = check_size(file, limit, message);
  bool swap = pixels_turn_swaps(file->info.orientation);
  file->view = (recede_view){NULL,
                             0,
                             swap ? file->info.height : file->info.width,
                             swap ? file->info.width : file->info.height,
                             file->info.channels,
                             file->info.type};
  return status;
}

image_status image_file_turn(recede_view *view, int orientation, image_message *message) {
  bool swap = pixels_turn_swaps(orientation);
  if (orientation == 1) return IMAGE_OK;
  recede_view turned = pixels_new(swap ? view->height : view->width,
                                  swap ? view->width : view->height, view->channels, view->type);
  if (!turned.data) return fail(message, IMAGE_NO_MEMORY, "not enough memory to turn it");
  pixels_turn(view, orientation, &turned);
  free(view->data);
  *view = turned;
  return IMAGE_OK;
}

image_status image_file_read(image_file *file, image_message *message) {
  const image_info *info = &file->info;
  file->view = pixels_new(info->width, info->height, info->channels, info->type);
  if (!file->view.data) return fail(message, IMAGE_NO_MEMORY, "not enough memory for its pixels");
  image_status status = image_decoder_read(file->decoder, file->view.data, message);
  if (status != IMAGE_OK) return status;
  /* OpenImageIO multiplies them by alpha, whatever it is asked for, and 8 bits do not come back. */
  if (strcmp(file->format->codec, "webp") == 0 && !pixels_opaque(&file->view))
    return fail(message, IMAGE_UNSUPPORTED,
                "WebP's reader changes colours under transparency, which it has; save it as .png");
  return image_file_turn(&file->view, info->orientation, message);
}

void image_file_close(image_file *file) {
  metadata_free(file);
  image_decoder_free(&file->decoder);
  image_bytes_free(&file->bytes);
  free(file->view.data);
  file->view.data = NULL;
}

/* ----------------------------------------------------------------------------------- write -- */

static bool is_float(recede_type type) { return type == RECEDE_HALF || type == RECEDE_FLOAT; }
static const char *type_name(recede_type type) {
  static const char *const names[] = {"8-bit", "16-bit", "half", "float"};
  return names[type];
}

/* The type it will be written in; false: whole numbers and floats do not mix. A float picture is
 * usually linear light beyond 0..1, a whole-number one is not: exchanging them silently would
 * change how everything looks. */
static bool written_type(const image_format *format, recede_type type, recede_type *written) {
  static const recede_type fallback[4] = {RECEDE_U16, RECEDE_U8, RECEDE_FLOAT, RECEDE_HALF};
  *written = image_format_holds(format, type) ? type : fallback[type];
  return image_format_holds(format, *written) && is_float(*written) == is_float(type);
}

static bool has_alpha(int channels) { return channels % 2 == 0; }

/* Alpha that is 1 everywhere may go; else gray with alpha becomes RGB with alpha where only that is
 * held. */
static int written_channels(const image_format *format, int channels, bool opaque) {
  const int colours = channels - has_alpha(channels);
  const int wanted[] = {channels, opaque ? colours : channels, has_alpha(channels) ? 4 : 3,
                        colours};
  for (int i = 0; i < 4; i++)
    if (format->channels & (1u << wanted[i])) return wanted[i];
  return 3;
}

bool image_file_holds_alpha(const char *path, int channels, image_message *message) {
  const image_format *format = image_format_of_name(path);
  if (!has_alpha(channels) || (format && has_alpha(written_channels(format, channels, false))))
    return true;
  fail(message, IMAGE_OUTPUT, "%s has no transparency, which the picture has; use .png or .tif",
       format ? format->name : "it");
  return false;
}

static void note(image_message *message, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void note(image_message *message, const char *format, ...) {
  size_t used = strlen(message->text);
  va_list arguments;
  if (used) message->text[used++] = ' ';
  va_start(arguments, format);
  vsnprintf(message->text + used, sizeof message->text - used, format, arguments);
  va_end(arguments);
}

/* What reading alone has changed. */
static void note_input(const image_file *like, image_message *message) {
  const image_info *info = &like->info;
  int bits = 8 * (int)pixels_type_bytes(info->type);
  if (info->several) note(message, "The input holds several pictures: the first was used alone.");
  if (info->indexed)
    note(message, "The palette was expanded: the output is RGB.");
  else if (info->stored_bits < bits)
    note(message, "The input has %d-bit samples: they were expanded to %d bits.", info->stored_bits,
         bits);
}

bool image_file_can_write(const char *path, const image_file *like, int width, int height,
                          recede_type type, image_message *message) {
  const image_format *format = image_format_of_name(path);
  recede_type written;
  message->text[0] = '\0';
  if (!format) {
    fail(message, IMAGE_OUTPUT, "its suffix names no format we write (%s)", image_format_written());
    return false;
  }
  if (!format->types) {
    fail(message, IMAGE_OUTPUT,
         "%s is read, not written: its encoder here would change pixels outside the mask; use .png "
         "or .tif",
         format->name);
    return false;
  }
  if (!written_type(format, type, &written)) {
    fail(message, IMAGE_OUTPUT, "%s cannot hold %s samples; use %s", format->name, type_name(type),
         is_float(type) ? ".exr or .tif" : ".png or .tif");
    return false;
  }
  if (format->longest && (width > format->longest || height > format->longest)) {
    fail(message, IMAGE_OUTPUT, "%s holds sides of up to %d px, the result has %d x %d; use .tif",
         format->name, format->longest, width, height);
    return false;
  }
  if (like) note_input(like, message);
  if (written == RECEDE_U8 && type == RECEDE_U16)
    note(message, "%s holds 8 bits: 16 were reduced to 8.", format->name);
  if (written == RECEDE_FLOAT && type == RECEDE_HALF)
    note(message, "%s gets floats of 32 bits: half is not written there.", format->name);
  if (like && format != like->format && strcmp(format->codec, "hdr") == 0)
    note(message, "%s rounds every pixel to 8 bits and one exponent, and has nothing below 0.",
         format->name);
  return true;
}

/* In stored order, in a type and with channels that the format holds; data is fresh memory, or
 * seen's own where nothing has to change. */
static image_status storable(const char *path, const recede_view *seen, int orientation,
                             recede_view *stored, image_message *message) {
  const image_format *format = image_format_of_name(path);
  recede_type type;
  bool opaque = pixels_opaque(seen);
  int channels = written_channels(format, seen->channels, opaque);
  *stored = *seen;
  if (!written_type(format, seen->type, &type))
    return fail(message, IMAGE_OUTPUT, "%s cannot hold %s samples", format->name,
                type_name(seen->type));
  if (!opaque && !has_alpha(channels)) {
    image_file_holds_alpha(path, seen->channels, message);
    return IMAGE_OUTPUT;
  }
  if (type != seen->type || channels != seen->channels) {
    *stored = pixels_new(seen->width, seen->height, channels, type);
    if (!stored->data) return fail(message, IMAGE_NO_MEMORY, "not enough memory to write");
    pixels_convert(seen, stored);
  }
  if (orientation == 1) return IMAGE_OK;
  bool swap = pixels_turn_swaps(orientation);
  recede_view turned = pixels_new(swap ? seen->height : seen->width,
                                  swap ? seen->width : seen->height, channels, type);
  if (turned.data) pixels_turn(stored, pixels_turn_inverse(orientation), &turned);
  if (stored->data != seen->data) free(stored->data);
  *stored = turned;
  return turned.data ? IMAGE_OK : fail(message, IMAGE_NO_MEMORY, "not enough memory to write");
}

/* EXR knows no other colours with alpha. */
static image_status premultiply(recede_view *stored, const recede_view *seen,
                                image_message *message) {
  if (stored->channels % 2 == 1 || pixels_opaque(stored)) return IMAGE_OK;
  if (stored->data == seen->data) {
    *stored = pixels_new(seen->width, seen->height, seen->channels, seen->type);
    if (!stored->data) return fail(message, IMAGE_NO_MEMORY, "not enough memory to write");
    pixels_turn(seen, 1, stored);
  }
  pixels_premultiply(stored);
  return IMAGE_OK;
}

image_status image_file_encode(const char *path, const recede_view *seen, const image_file *like,
                               bool keep, image_bytes *bytes, image_message *message) {
  const image_format *format = image_format_of_name(path);
  recede_view stored = {0};
  message->text[0] = '\0';
  if (!format) return fail(message, IMAGE_OUTPUT, "its suffix names no format we write");
  /* A format that cannot carry the tag gets the picture as it is seen. */
  int orientation = keep && metadata_carries_orientation(like, format) ? like->info.orientation : 1;
  image_status status = storable(path, seen, orientation, &stored, message);
  /* The view's colours are stored the source's way; a JPEG and the like has none to be multiplied.
   */
  bool premultiplied = like && like->info.premultiplied;
  if (status == IMAGE_OK && !premultiplied && strcmp(format->codec, "openexr") == 0)
    status = premultiply(&stored, seen, message);
  if (status == IMAGE_OK)
    status = image_encode(&stored, format->codec, like ? like->decoder : NULL, premultiplied,
                          orientation, keep, bytes, message);
  if (status == IMAGE_OK) status = metadata_carry(like, format, keep, bytes, message);
  if (stored.data != seen->data) free(stored.data);
  return status;
}
