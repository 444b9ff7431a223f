/* mask_file.h - a mask for a picture, from an image file. */
#ifndef RECEDE_MASK_FILE_H
#define RECEDE_MASK_FILE_H

#include "image_file.h"

/* One channel in the picture's frame as seen: luminance times alpha. The mask's own Exif
 * orientation is honoured; without one it may have the picture's seen or stored size, and where
 * both fit (square pictures, turned by 180 degrees, mirrored) it is taken as stored. An EXR lies
 * where its windows say. mask->data: free(). note: on IMAGE_OK "" or what the user should know. */
image_status mask_file_read(const char *path, const image_file *picture, uint64_t limit_bytes,
                            recede_view *mask, image_message *note, image_message *message);

#endif
