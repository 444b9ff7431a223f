#include "metadata.h"

bool metadata_carries_orientation(const image_format *format) {
  (void)format;
  return false;
}
image_status metadata_carry(const image_file *from, const image_format *format, bool keep,
                            image_bytes *bytes, image_message *message) {
  (void)from, (void)format, (void)keep, (void)bytes, (void)message;
  return IMAGE_OK;
}
