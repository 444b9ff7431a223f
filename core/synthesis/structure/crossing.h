/* A line that crosses the hole: where it does, what it looks like there, and where the texture
 * along it comes from. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_CROSSING_H
#define RECEDE_SYNTHESIS_STRUCTURE_CROSSING_H

#include "image/image.h"
#include "synthesis/copy.h"

#define RC_MOST_LINES 8 /* parallel ones, and what leaves the picture */
#define RC_ALL_LINES 24 /* and all that cross them, or end there */
#define RC_MOST_PIECES 48

/* Signal to noise: stones' edges are as strong as this, but chance ones keep less. */
#define RC_SURE_STRENGTH 30.f
/* And of what is no chance: markings and kerbs have 100 and more. */
#define RC_CLEAR_STRENGTH 100.f

/* A line stands out where no more than this part of the rest of the hole's border is as strong:
 * joints of regular slabs have .03 to .3. */
#define RC_HARDLY_AS_STRONG .02f

/* A line from the hole's border at a to that at b, px of the finest level, or one that ends at a
 * where it meets another. */
typedef struct rc_crossing {
  float ax, ay, bx, by;
  float strength;   /* signal to noise of its weaker side */
  float kept;       /* the part of its contrast that its pieces' sources have */
  float rise;       /* -1..1: how far a is a step across */
  float as_strong;  /* the part of the rest of the hole's border where some line is as strong */
  bool alone;       /* hardly any parallel to it looks the same */
  bool faint;       /* it is known only by what tells two textures apart */
  bool ends_inside; /* at a */
  bool leaves;   /* and that is at the picture's end, or too near to see a run of it behind, or */
  bool recedes;  /* too far away to be seen: its pieces are equally long in the plane */
  bool band;     /* it is wide, and hardly anything at the hole's border is as strong */
  float axis[3]; /* the weights of colours it was seen by */
  /* How far it reaches to its left and right, px where w = 1; 0 where that is not told. */
  float reach_px[2];
  int pieces;
  float from_x[RC_MOST_PIECES], from_y[RC_MOST_PIECES]; /* where each piece's middle comes from */
} rc_crossing;

float rc_crossing_length(const rc_crossing *line);
/* Distance of (x, y) from the line, however far beyond its ends. */
float rc_crossing_distance(const rc_crossing *line, float x, float y);
/* On which side of it, seen from a to b with y downwards. */
bool rc_crossing_is_right(const rc_crossing *line, float x, float y);
/* It stands out, and what it is followed by looks like it all along, or it is a band: no chance. */
bool rc_crossing_is_sure(const rc_crossing *line);
/* It is sure, and stands alone: no joint of many. */
bool rc_crossing_is_lone(const rc_crossing *line);
/* And it is clear, as markings and rails are. */
bool rc_crossing_is_marking(const rc_crossing *line);
/* Tells whether one that was followed is a band. seen_coarser: than other lines are. */
void rc_crossing_tell_band(rc_crossing *line, bool seen_coarser);
/* After that: how far a faint one reaches is chance. */
void rc_crossing_forget_chance(rc_crossing *line);
/* How far from a to b, 0..1, its pieces' boundary n lies; n need not be whole. And which piece lies
 * there. chart: of the same level. */
float rc_crossing_part(const rc_chart *chart, const rc_crossing *line, float n);
int rc_crossing_piece(const rc_chart *chart, const rc_crossing *line, float part);
/* Its direction in the plane, a unit vector. chart: of the same level. */
rc_copy rc_crossing_direction(const rc_chart *chart, const rc_crossing *line);
/* Of two such directions, within 4 degrees. */
bool rc_parallel_in_plane(rc_copy a, rc_copy b);
/* The same line in px of a level 2^exponent times coarser; a negative exponent: finer. */
rc_crossing rc_crossing_coarser(rc_crossing line, int exponent);
/* Of so many lines keeps one direction, that of the greatest length together, or of those with a
 * clear one that stands alone: where two would cross, each needs another copy. chart: of the same
 * level. */
void rc_crossings_keep_parallel(const rc_chart *chart, rc_crossing lines[RC_MOST_LINES],
                                int *count);
/* Strongest first. */
void rc_crossings_sort(rc_crossing *lines, int count);
bool rc_crossings_have_lone(const rc_crossing *lines, int count);
/* And with one what stands alone but is not sure: a beam has two edges. */
void rc_crossings_keep_lone(rc_crossing lines[RC_MOST_LINES], int *count);
/* Strongest first. */
void rc_crossings_keep_sure(rc_crossing lines[RC_MOST_LINES], int *count);
void rc_crossings_drop_faint(rc_crossing *lines, int *count);
/* Keeps those that have nearly all of the hole on one side. flags: of the same level. */
void rc_crossings_keep_corners(const rc_mask *flags, rc_crossing lines[RC_MOST_LINES], int *count);

#endif
