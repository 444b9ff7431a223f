/* Drawn planes to fill, and a fill as one value: what the tests of the plane engine share. */
#ifndef RECEDE_TESTS_PLANE_SCENE_H
#define RECEDE_TESTS_PLANE_SCENE_H

#include <glib.h>
#include <stdbool.h>

#include "judged.h"
#include "recede.h"

typedef struct picture {
  recede_view view;
  guint8 *pixels;
} picture;

typedef struct area {
  int x0, y0, x1, y1; /* x1, y1 exclusive */
} area;

picture picture_new(int width, int height, int channels, recede_type type);
picture picture_copy(const picture *from);
void picture_clear(picture *p);
gsize picture_bytes(const picture *p);
/* Values 0..1 of RECEDE_U8 and RECEDE_FLOAT pictures. */
float picture_get(const picture *p, int x, int y, int k);
void picture_set(picture *p, int x, int y, int k, float value);
void picture_fill(picture *p, area a, float value);
/* A uniform number in 0..1 that depends on these alone. */
double noise_at(int x, int y, int n);
/* One in -.5 to .5, of so many a texel, smooth between them. */
double smooth_noise(double u, double v, double per_texel, int n);

/* Colours over a plane: (u, v) in texels. */
typedef double pattern(double u, double v, int k);
pattern bricks, grains;
/* The pattern on a plane that recedes (field of view 50 degrees), texel_px wide in the middle of
 * the picture; black beyond the horizon. */
picture picture_of_plane(int width, int height, int channels, recede_type type, pattern *draw,
                         double texel_px, double slant_deg, double tilt_deg);
/* Upright discs of one size lying about on such a floor. */
picture picture_of_discs(int width, int height, double disc_px, double slant_deg);

typedef struct task {
  recede_host host;
  recede_params params;
  picture image, mask, source, result; /* source.pixels NULL: everything */
  recede_status status;
  recede_report report;
  char message[512];
} task;

/* Takes the image over. No hole yet; settings: "key=value key=value" over angles, one thread. */
task task_new(picture image, const char *settings);
void task_set(task *t, const char *settings);
void task_hole(task *t, area a);
void task_round_hole(task *t, area a); /* the ellipse in it */
/* A fill; the result starts as bytes of 0xa5. task_succeeds: which must end well. */
void task_run(task *t);
void task_succeeds(task *t);
void task_synthesize(task *t, int width, int height);
void task_clear(task *t);
bool task_result_untouched(const task *t);
/* Every byte of the result outside the mask is the image's. */
void task_assert_outside(const task *t);

typedef struct moments {
  double count, mean, deviation, least, most;
} moments;
/* Of channel k of the pixels of an area whose mask is set (or, inside false, is not). */
moments moments_of(const picture *p, const picture *mask, bool inside, area a, int k);
/* How much of the bright markings of a dark ground is there in the hole. */
typedef struct paint {
  double right, all; /* pixels that are, or of those that are or should be */
  double wrong;      /* of plain ones */
} paint;
paint task_paint(const task *t, const picture *truth, area a);
/* Peak signal to noise ratio of p against truth in the masked pixels, dB. */
double masked_psnr(const picture *p, const picture *truth, const picture *mask);

#endif
