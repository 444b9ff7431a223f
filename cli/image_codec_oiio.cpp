#include "image_codec.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <vector>

using namespace OIIO;

struct image_decoder {
  std::string format;
  Filesystem::IOMemReader reader;
  std::unique_ptr<ImageInput> input;
  ImageSpec spec;
  image_decoder(const char *name, const void *bytes, size_t size)
      : format(name), reader(bytes, size) {}
};

namespace {

image_status fail(image_message *message, image_status status, const std::string &text) {
  // The library's own messages come in several lines, some with a trailing one.
  std::string line = text;
  for (char &c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  while (!line.empty() && line.back() == ' ') line.pop_back();
  snprintf(message->text, sizeof message->text, "%s", line.c_str());
  return status;
}

bool threads_missing;

// Runs a body that may throw; every exception becomes a status.
template <typename Body> image_status guarded(image_message *message, Body body) noexcept {
  try {
    return body();
  } catch (const std::bad_alloc &) {
    snprintf(message->text, sizeof message->text, "not enough memory");
    return IMAGE_NO_MEMORY;
  } catch (const std::system_error &error) {
    threads_missing = true;
    snprintf(message->text, sizeof message->text, "a thread cannot be started: %s", error.what());
    return IMAGE_NO_MEMORY;
  } catch (const std::exception &error) {
    snprintf(message->text, sizeof message->text, "%s", error.what());
    return IMAGE_MALFORMED;
  } catch (...) {
    snprintf(message->text, sizeof message->text, "unknown fault in the image library");
    return IMAGE_MALFORMED;
  }
}

// Errors are kept per object and per thread: both must be asked, and so be emptied.
template <typename Object> std::string error_of(const Object *object, const char *otherwise) {
  std::string text = object ? object->geterror() : std::string();
  std::string global = OIIO::geterror();
  if (text.empty()) text = global;
  return text.empty() ? otherwise : text;
}

bool type_of(TypeDesc format, recede_type *type) {
  switch (format.basetype) {
    case TypeDesc::UINT8: *type = RECEDE_U8; return true;
    case TypeDesc::UINT16: *type = RECEDE_U16; return true;
    case TypeDesc::HALF: *type = RECEDE_HALF; return true;
    case TypeDesc::FLOAT: *type = RECEDE_FLOAT; return true;
    default: return false;
  }
}

TypeDesc format_of(recede_type type) {
  switch (type) {
    case RECEDE_U8: return TypeDesc::UINT8;
    case RECEDE_U16: return TypeDesc::UINT16;
    case RECEDE_HALF: return TypeDesc::HALF;
    default: return TypeDesc::FLOAT;
  }
}

// TIFF's tag 262; only 0-3 and 6 arrive as the gray or RGB that they are.
const char *foreign_colours(const ImageSpec &spec) {
  switch (spec.get_int_attribute("tiff:PhotometricInterpretation", 2)) {
    case 5: return "CMYK";
    case 8:
    case 9:
    case 10: return "CIE L*a*b*";
    case 32803: return "a camera's raw mosaic";
    case 32844:
    case 32845: return "LogLuv";
    default: break;
  }
  return spec.get_string_attribute("jpeg:ColorSpace") == "CMYK" ? "CMYK" : nullptr;
}

std::string channel_names(const ImageSpec &spec) {
  std::string names;
  for (int i = 0; i < spec.nchannels && i < 8; i++)
    names += (i ? ", " : "") + std::string(spec.channel_name(i));
  return names;
}

// What makes a sound picture one that we must not touch; empty: nothing.
std::string objection(const ImageSpec &spec) {
  recede_type type;
  if (spec.deep) return "it holds deep samples (several a pixel); flatten it first";
  if (spec.depth > 1) return "it is a volume, not a picture";
  if (const char *colours = foreign_colours(spec))
    return std::string("its colours are ") + colours + "; convert it to RGB first";
  if (!type_of(spec.format, &type))
    return std::string("its samples are ") + spec.format.c_str() +
           "; 8- and 16-bit whole numbers, half and float can be kept";
  if (spec.nchannels < 1 || spec.nchannels > 4)
    return "it has " + std::to_string(spec.nchannels) + " channels (" + channel_names(spec) +
           " ...); gray or RGB, with or without alpha, can be kept";
  int wanted_alpha = spec.nchannels == 2 ? 1 : spec.nchannels == 4 ? 3 : -1;
  if (spec.alpha_channel != wanted_alpha)
    return "its channels are " + channel_names(spec) +
           "; gray or RGB, with or without alpha, can be kept";
  return std::string();
}

// Pixels per inch; 0: unknown. The unit is a word, or (from Exif in PNG) Exif's number.
double dpi_of(const ImageSpec &spec, const char *axis) {
  double value = spec.get_float_attribute(axis);
  std::string unit(spec.get_string_attribute("ResolutionUnit"));
  int number = spec.get_int_attribute("ResolutionUnit");
  if (!(value > 0)) return 0;
  if (unit == "cm" || number == 3) return value * 2.54;
  if (unit == "m") return value * .0254;
  return unit == "in" || number == 2 ? value : 0;
}

image_info describe(const ImageSpec &spec, const std::string &format) {
  image_info info = {};
  info.width = spec.width;
  info.height = spec.height;
  info.channels = spec.nchannels;
  type_of(spec.format, &info.type);
  info.stored_bits = spec.get_int_attribute("oiio:BitsPerSample", int(spec.format.size()) * 8);
  info.has_window = format == "openexr";
  if (info.has_window) info.x = spec.x - spec.full_x, info.y = spec.y - spec.full_y;
  info.frame_width = info.has_window ? spec.full_width : spec.width;
  info.frame_height = info.has_window ? spec.full_height : spec.height;
  info.dpi_x = dpi_of(spec, "XResolution");
  info.dpi_y = dpi_of(spec, "YResolution");
  // Targa's reader gives the rows as seen, and the tag besides.
  info.orientation = format == "targa" ? 1 : spec.get_int_attribute("Orientation", 1);
  info.turn_given = spec.find_attribute("Orientation") != nullptr;
  info.profile = spec.find_attribute("ICCProfile") != nullptr;
  if (info.orientation < 1 || info.orientation > 8) info.orientation = 1;
  info.indexed = spec.get_int_attribute("tiff:PhotometricInterpretation", 2) == 3;
  // PNG, Targa and the like store colours plain; EXR always multiplies; TIFF's tag says which.
  info.premultiplied = spec.alpha_channel >= 0 && format == "openexr";
  return info;
}

bool lossless(const std::string &format, const std::string &compression) {
  static const char *const tiff[] = {"none", "lzw", "zip", "packbits"};
  static const char *const exr[] = {"none", "rle", "zips", "zip", "piz"};
  if (format == "tiff")
    for (const char *name : tiff)
      if (compression == name) return true;
  if (format == "openexr")
    for (const char *name : exr)
      if (compression == name) return true;
  return false;
}

// From EXR to EXR everything stays, but for what describes how it was stored.
void take_exr_attributes(ImageSpec &spec, const ImageSpec &like) {
  spec.extra_attribs = like.extra_attribs;
  for (const char *name : {"oiio:subimages", "oiio:ColorSpace", "name", "chunkCount", "type"})
    spec.erase_attribute(name);
  spec.x = like.x, spec.y = like.y;
  spec.full_x = like.full_x, spec.full_y = like.full_y;
  spec.full_width = like.full_width, spec.full_height = like.full_height;
}

void take_resolution(ImageSpec &spec, const ImageSpec &like) {
  double x = dpi_of(like, "XResolution"), y = dpi_of(like, "YResolution");
  if (!(x > 0) || !(y > 0)) return;
  spec.attribute("XResolution", float(x));
  spec.attribute("YResolution", float(y));
  spec.attribute("ResolutionUnit", "in");
}

// The profile's bytes alone: its fields, which the readers add, would be written as texts.
void take_profile(ImageSpec &spec, const ImageSpec &like) {
  if (const ParamValue *profile = like.find_attribute("ICCProfile"))
    spec.attribute("ICCProfile", profile->type(), profile->data());
}

void take_jpeg_settings(ImageSpec &spec, const ImageSpec *like) {
  // High, and without halving the colours unless the source had them halved already.
  std::string halving = "4:4:4";
  if (like) halving = like->get_string_attribute("jpeg:subsampling", halving);
  spec.attribute("CompressionQuality", 95);
  spec.attribute("jpeg:subsampling", halving);
}

ImageSpec spec_for(const recede_view *view, const std::string &format, const image_decoder *like,
                   bool premultiplied, int orientation, bool keep) {
  ImageSpec spec(view->width, view->height, view->channels, format_of(view->type));
  std::string compression;
  if (view->channels < 3) spec.channelnames[0] = "Y";
  if (view->channels == 2 || view->channels == 4) {
    spec.alpha_channel = view->channels - 1;
    spec.channelnames[view->channels - 1] = "A";
  }
  if (like && like->format == format) {
    if (format == "openexr" && keep) take_exr_attributes(spec, like->spec);
    if (format == "openexr") spec.channelnames = like->spec.channelnames;
    compression = like->spec.get_string_attribute("compression");
  }
  if (like && !(keep && format == "openexr" && like->format == format))
    take_resolution(spec, like->spec);
  // JPEG and PNG get it within Exif.
  if (orientation != 1 && (format == "tiff" || format == "openexr"))
    spec.attribute("Orientation", orientation);
  if (like && format != "openexr") take_profile(spec, like->spec); // EXR has no place for it
  // What this says is true already: no value is changed by the writers.
  if (!premultiplied) spec.attribute("oiio:UnassociatedAlpha", 1);
  if (!lossless(format, compression)) compression = "zip";
  if (format == "tiff" || format == "openexr") spec.attribute("compression", compression);
  // Without a date the writers put today's, and two runs would differ. OpenEXR's leaves out what is
  // no text; TIFF's tag is taken out again by metadata_into_tiff().
  if (format == "openexr" && !spec.find_attribute("DateTime")) spec.attribute("DateTime", 1);
  if (format == "tiff") spec.attribute("DateTime", "0000:00:00 00:00:00");
  if (format == "jpeg") take_jpeg_settings(spec, like ? &like->spec : nullptr);
  // A third of the usual level 6's time, and 8 % more bytes: 12 MP in .7 s instead of 2.2 s.
  if (format == "png") spec.attribute("png:compressionLevel", 4);
  return spec;
}

image_status copy_out(const std::vector<unsigned char> &from, image_bytes *bytes,
                      image_message *message) {
  bytes->data = static_cast<unsigned char *>(malloc(from.size() ? from.size() : 1));
  if (!bytes->data) return fail(message, IMAGE_NO_MEMORY, "not enough memory");
  memcpy(bytes->data, from.data(), from.size());
  bytes->size = from.size();
  return IMAGE_OK;
}

} // namespace

extern "C" void image_codec_init(int threads) {
  image_message ignored;
  guarded(&ignored, [&] {
    OIIO::attribute("threads", threads);
    OIIO::attribute("exr_threads", threads);
    OIIO::attribute("debug", 0);
    return IMAGE_OK;
  });
}

extern "C" bool image_codec_broken(void) { return threads_missing; }

extern "C" image_status image_decoder_new(const char *format, const void *bytes, size_t size,
                                          image_decoder **decoder, image_info *info,
                                          image_message *message) {
  *decoder = nullptr;
  return guarded(message, [&] {
    std::unique_ptr<image_decoder> made(new image_decoder(format, bytes, size));
    made->input = ImageInput::create(format, false);
    if (!made->input)
      return fail(message, IMAGE_UNSUPPORTED, error_of<ImageInput>(nullptr, "format not built in"));
    ImageSpec request;
    request.attribute("oiio:UnassociatedAlpha", 1);
    if (!made->input->set_ioproxy(&made->reader))
      return fail(message, IMAGE_UNSUPPORTED, "this format cannot be read from memory");
    if (!made->input->open(std::string("memory.") + format, made->spec, request))
      return fail(message, IMAGE_MALFORMED, error_of(made->input.get(), "cannot be opened"));
    if (made->spec.width < 1 || made->spec.height < 1)
      return fail(message, IMAGE_MALFORMED, "it has no pixels");
    std::string why_not = objection(made->spec);
    if (!why_not.empty()) return fail(message, IMAGE_UNSUPPORTED, why_not);
    *info = describe(made->spec, made->format);
    if (made->format == "tiff" || made->format == "openexr")
      info->several = made->input->seek_subimage(1, 0);
    error_of(made->input.get(), "");
    *decoder = made.release();
    return IMAGE_OK;
  });
}

extern "C" image_status image_decoder_read(image_decoder *decoder, void *data,
                                           image_message *message) {
  return guarded(message, [&] {
    ImageInput *input = decoder->input.get();
    bool good = input->read_image(0, 0, 0, decoder->spec.nchannels, decoder->spec.format, data);
    std::string error = error_of(input, "");
    // Some readers return true after an error in the middle of the data.
    if (!good || !error.empty())
      return fail(message, IMAGE_MALFORMED, error.empty() ? "its pixels cannot be read" : error);
    input->close();
    return IMAGE_OK;
  });
}

extern "C" image_status image_decoder_set_profile(image_decoder *decoder, const void *bytes,
                                                  size_t size, image_message *message) {
  return guarded(message, [&] {
    decoder->spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, int(size)), bytes);
    return IMAGE_OK;
  });
}

extern "C" void image_decoder_free(image_decoder **decoder) {
  image_message ignored;
  guarded(&ignored, [&] {
    delete *decoder;
    *decoder = nullptr;
    return IMAGE_OK;
  });
}

extern "C" void image_bytes_free(image_bytes *bytes) {
  free(bytes->data);
  bytes->data = nullptr;
  bytes->size = 0;
}

extern "C" image_status image_encode(const recede_view *view, const char *format,
                                     const image_decoder *like, bool premultiplied, int orientation,
                                     bool keep, image_bytes *bytes, image_message *message) {
  return guarded(message, [&] {
    auto output = ImageOutput::create(format);
    if (!output)
      return fail(message, IMAGE_OUTPUT, error_of<ImageOutput>(nullptr, "format not built in"));
    Filesystem::IOVecOutput memory;
    if (!output->set_ioproxy(&memory))
      return fail(message, IMAGE_OUTPUT, "this format cannot be written from memory");
    ImageSpec spec = spec_for(view, format, like, premultiplied, orientation, keep);
    if (!output->open(std::string("memory.") + format, spec))
      return fail(message, IMAGE_OUTPUT, error_of(output.get(), "the encoder cannot start"));
    bool good = output->write_image(format_of(view->type), view->data, AutoStride,
                                    stride_t(view->stride_bytes), AutoStride);
    good = output->close() && good;
    // Only the return values count: TIFF's writer leaves an error even when all went well.
    std::string error = error_of(output.get(), "the encoder failed");
    if (!good) return fail(message, IMAGE_OUTPUT, error);
    return copy_out(memory.buffer(), bytes, message);
  });
}
