/* Pictures of planes of known angles to read orientations from, and a question as one value. */
#ifndef RECEDE_TESTS_ORIENT_SCENE_H
#define RECEDE_TESTS_ORIENT_SCENE_H

#include <glib.h>

#include "judged.h"
#include "recede.h"

#define SIDE 384
#define FLOOR_SLANT 80
#define WALL_SLANT 65

typedef enum { BRICKS, DOTS, NOISE, PIER, LAWN } texture_kind;

/* A repeatable number in 0..1 for a place. */
double chance(int x, int y, int n);
/* One texel is 1 px at (on_x, on_y); beyond the horizon a plain sky. */
void draw(texture_kind kind, double slant, double tilt, double on_x, double on_y, guint8 *gray);
/* side x side lawns seen from above, of sizes, contrasts and brightnesses by chance: no plane. */
void draw_patchwork(int side, int n, guint8 *gray);
/* Noise whose size and contrast drift by chance, as in clouds and nebulas: no plane. */
void draw_clouds(int n, guint8 *gray);
/* A floor, and a wall of the same on its left that recedes to the right, twice as far off. */
void draw_street(guint8 *gray);
/* Blades that stand up from a floor. */
void draw_blades(double slant, guint8 *gray);

typedef struct question {
  guint8 gray[SIDE * SIDE], mask[SIDE * SIDE], source[SIDE * SIDE];
  gboolean masked, sourced;
  recede_host host;
  recede_orientation answer;
  char message[512];
} question;

question *new_question(void);
void put_hole(question *q, int x, int y, int width, int height);
recede_status ask(question *q);
/* Between the answer's plane and the one of these angles. */
double error_deg(const recede_orientation *answer, double slant, double tilt);

#endif
