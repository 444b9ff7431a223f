#include "mask_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pixels.h"

/* Black that was compressed with loss decodes as 1 at JPEG's quality 70 and as up to 2 beside it;
 * and any value above 0 is part of the hole, so that nothing would be left to copy from. Without
 * loss, 1 and 2 are meant: the tail of a soft edge. */
#define LOSSY_BLACK (2.5f / 255)
/* Below this the old picture shows through more than the fill, and a source counts for nothing. */
#define DIM .5f

static image_status fail(image_message *message, image_status status, const char *text) {
  snprintf(message->text, sizeof message->text, "%s", text);
  return status;
}

/* An EXR whose pixels are a part of the frame that the picture lies in, or a picture that is. */
static bool has_place(const image_info *mask, const image_info *picture) {
  bool same_frame =
      mask->frame_width == picture->frame_width && mask->frame_height == picture->frame_height;
  bool same_place = mask->x == picture->x && mask->y == picture->y &&
                    mask->width == picture->width && mask->height == picture->height;
  return mask->has_window && same_frame && !same_place;
}

/* How the mask's stored rows must be turned to lie on the picture as seen; 0: it does not fit. */
static int turn_of_mask(const image_file *mask, const image_file *picture, image_message *note) {
  const image_info *info = &mask->info;
  bool seen = info->width == picture->view.width && info->height == picture->view.height;
  bool stored = info->width == picture->info.width && info->height == picture->info.height;
  if (info->orientation != 1) { /* it says itself how it is seen */
    bool fits =
        mask->view.width == picture->view.width && mask->view.height == picture->view.height;
    return fits ? info->orientation : 0;
  }
  if (seen && info->turn_given) return 1;
  if (seen && stored && picture->info.orientation != 1)
    snprintf(note->text, sizeof note->text,
             "The picture is stored turned (Exif orientation) and the mask fits both ways: it was "
             "taken to lie on the stored rows. ");
  return stored ? picture->info.orientation : seen ? 1 : 0;
}

/* Into the picture's stored frame; zero where the mask has no pixels. */
static recede_view place(const recede_view *mask, const image_info *of, const image_info *picture) {
  recede_view placed = pixels_new(picture->width, picture->height, 1, mask->type);
  int left = of->x - picture->x, top = of->y - picture->y;
  for (int y = 0; placed.data && y < placed.height; y++)
    for (int x = 0; x < placed.width; x++)
      if (x >= left && y >= top && x - left < mask->width && y - top < mask->height)
        pixels_set(&placed, x, y, 0, pixels_get(mask, x - left, y - top, 0));
  return placed;
}

static float brightest_of(const recede_view *mask) {
  float brightest = 0;
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++) {
      float value = pixels_get(mask, x, y, 0);
      if (value > brightest) brightest = value;
    }
  return brightest;
}

static void note_dim(const recede_view *mask, recede_type type, image_message *note) {
  float brightest = brightest_of(mask);
  float white = type == RECEDE_U8 ? 255 : type == RECEDE_U16 ? 65535 : 1;
  size_t used = strlen(note->text);
  if (brightest <= 0 || brightest >= DIM) return; /* an empty one is refused */
  snprintf(note->text + used, sizeof note->text - used,
           "Its brightest value is %.6g, and white is %g: so little is blended in, or copied from. "
           "Make white what is meant.",
           (double)(brightest * white), (double)white);
}

static void blacken(const recede_view *mask) {
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++)
      if (pixels_get(mask, x, y, 0) < LOSSY_BLACK) pixels_set(mask, x, y, 0, 0);
}

static image_status read_values(image_file *file, recede_view *mask, image_message *message) {
  int bad_x, bad_y;
  image_status status = image_file_read(file, message);
  if (status != IMAGE_OK) return status;
  const recede_view *view = &file->view;
  *mask =
      pixels_new(view->width, view->height, 1, view->type == RECEDE_U8 ? RECEDE_U8 : RECEDE_FLOAT);
  if (!mask->data) return fail(message, IMAGE_NO_MEMORY, "not enough memory for the mask");
  if (pixels_to_mask(view, file->info.premultiplied, mask, &bad_x, &bad_y)) return IMAGE_OK;
  snprintf(message->text, sizeof message->text, "its pixel (%d, %d) is not a finite number", bad_x,
           bad_y);
  return IMAGE_MALFORMED;
}

static image_status read_placed(image_file *file, const image_file *picture, recede_view *mask,
                                image_message *message) {
  file->info.orientation = 1;
  image_status status = read_values(file, mask, message);
  if (status != IMAGE_OK) return status;
  recede_view placed = place(mask, &file->info, &picture->info);
  free(mask->data);
  *mask = placed;
  if (!placed.data) return fail(message, IMAGE_NO_MEMORY, "not enough memory for the mask");
  return image_file_turn(mask, picture->info.orientation, message);
}

static image_status make_mask(image_file *file, const image_file *picture, recede_view *mask,
                              image_message *note, image_message *message) {
  if (has_place(&file->info, &picture->info)) return read_placed(file, picture, mask, message);
  int turn = turn_of_mask(file, picture, note);
  if (!turn) {
    snprintf(message->text, sizeof message->text,
             "it is %d x %d px, the picture %d x %d: they must agree", file->view.width,
             file->view.height, picture->view.width, picture->view.height);
    return IMAGE_MALFORMED;
  }
  file->info.orientation = turn;
  return read_values(file, mask, message);
}

image_status mask_file_read(const char *path, const image_file *picture, uint64_t limit,
                            recede_view *mask, image_message *note, image_message *message) {
  image_file file;
  mask->data = NULL;
  note->text[0] = '\0';
  image_status status = image_file_open(path, limit, &file, message);
  if (status == IMAGE_OK) status = make_mask(&file, picture, mask, note, message);
  if (status == IMAGE_OK) {
    note_dim(mask, file.info.type, note);
    if (image_format_lossy(file.format)) blacken(mask);
  }
  image_file_close(&file);
  if (status == IMAGE_OK) return status;
  free(mask->data);
  mask->data = NULL;
  return status;
}
