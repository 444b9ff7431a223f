/* pixels.h - the few things the command does to pixels itself: turn, convert, read a mask. */
#ifndef RECEDE_PIXELS_H
#define RECEDE_PIXELS_H

#include <stdbool.h>

#include "recede.h"

size_t pixels_type_bytes(recede_type type);
/* Bytes of a picture without gaps. */
uint64_t pixels_bytes(int width, int height, int channels, recede_type type);
/* A view over fresh memory, zeroed, without gaps; data NULL: no memory. free(view.data). */
recede_view pixels_new(int width, int height, int channels, recede_type type);
/* One sample: whole numbers as 0..1. */
float pixels_get(const recede_view *view, int x, int y, int channel);
void pixels_set(const recede_view *view, int x, int y, int channel, float value);

/* Exif's orientation 1..8: does it exchange width and height? Which one undoes it? */
bool pixels_turn_swaps(int orientation);
int pixels_turn_inverse(int orientation);
/* Turns stored rows into what is seen (bit for bit); to has the turned size. */
void pixels_turn(const recede_view *from, int orientation, const recede_view *to);

/* Is every pixel opaque? True without alpha. */
bool pixels_opaque(const recede_view *view);
/* And where the mask is zero? */
bool pixels_opaque_outside(const recede_view *view, const recede_view *mask);
/* Copies into another type and number of channels: gray spreads to RGB, alpha is dropped or 1. From
 * RGB to gray there is no way here. */
void pixels_convert(const recede_view *from, const recede_view *to);
/* A mask of one channel from a picture: its luminance times its alpha, which premultiplied colours
 * hold already. false: *bad_x, *bad_y is not finite. */
bool pixels_to_mask(const recede_view *from, bool premultiplied, const recede_view *to, int *bad_x,
                    int *bad_y);

/* Colours divided by alpha and multiplied again; fully transparent and opaque pixels are left. */
void pixels_unpremultiply(const recede_view *view);
void pixels_premultiply(const recede_view *view);
/* Of a result: where the mask is zero, the original's bits; else its colours times its alpha. */
void pixels_premultiply_filled(const recede_view *result, const recede_view *original,
                               const recede_view *mask);
/* Of a result with the divided exemplar, or a part of it, in its middle: what is unchanged there
 * gets the original's bits; else colours are multiplied by alpha. */
void pixels_premultiply_around(const recede_view *result, const recede_view *divided,
                               const recede_view *original);

#endif
