#include "image/image.h"

#include "base/memory.h"

recede_status rc_image_new(rc_context *context, int width, int height, int channels,
                           rc_image *image) {
  *image = (rc_image){width, height, channels, NULL};
  return RC_NEW_ZERO(context, (size_t)width * (size_t)height * (size_t)channels, &image->data);
}

recede_status rc_mask_new(rc_context *context, int width, int height, rc_mask *mask) {
  *mask = (rc_mask){width, height, NULL};
  return RC_NEW_ZERO(context, (size_t)width * (size_t)height, &mask->data);
}

void rc_allow_sources(rc_mask *mask) {
  for (size_t i = 0; i < (size_t)mask->width * (size_t)mask->height; i++)
    if (mask->data[i] & RC_SOURCE) mask->data[i] |= RC_ALLOWED;
}

rc_box rc_box_of(const rc_mask *mask, int wanted) {
  rc_box box = {mask->width, mask->height, 0, 0};
  for (int y = 0; y < mask->height; y++) {
    const uint8_t *row = rc_flag(mask, 0, y);
    int first = 0, end = mask->width, any = 0;
    for (int x = 0; x < end; x++) any |= row[x];
    if (!(any & wanted)) continue;
    while (!(row[first] & wanted)) first++;
    while (!(row[end - 1] & wanted)) end--;
    box.x0 = first < box.x0 ? first : box.x0, box.x1 = end > box.x1 ? end : box.x1;
    box.y0 = y < box.y0 ? y : box.y0, box.y1 = y + 1;
  }
  return box.x1 ? box : (rc_box){0, 0, 0, 0};
}

rc_box rc_box_common(rc_box a, rc_box b) {
  return (rc_box){a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1,
                  a.y1 < b.y1 ? a.y1 : b.y1};
}

void rc_border_of_row(const rc_mask *flags, int y, int x0, int x1, uint8_t *border) {
  const uint8_t *row = rc_flag(flags, 0, y);
  const uint8_t *above = y > 0 ? row - flags->width : row;
  const uint8_t *below = y + 1 < flags->height ? row + flags->width : row;
  for (int x = x0; x < x1; x++) {
    bool inner = x > 0 && x + 1 < flags->width;
    uint8_t beside = inner ? row[x - 1] | row[x + 1] : row[x > 0 ? x - 1 : x + 1 < flags->width];
    border[x - x0] = (row[x] & RC_TARGET) && ((above[x] | below[x] | beside) & RC_KNOWN);
  }
}

rc_box rc_box_grown(rc_box box, int px, int width, int height) {
  return (rc_box){box.x0 > px ? box.x0 - px : 0, box.y0 > px ? box.y0 - px : 0,
                  box.x1 + px < width ? box.x1 + px : width,
                  box.y1 + px < height ? box.y1 + px : height};
}
