/* One level of the picture, as lines are looked for in it. */
#ifndef RECEDE_SYNTHESIS_STRUCTURE_SEEN_H
#define RECEDE_SYNTHESIS_STRUCTURE_SEEN_H

#include "image/image.h"
#include "synthesis/copy.h"

typedef struct rc_seen {
  const rc_mask *flags;
  const float *value;     /* finite; NAN: no source */
  bool without_crossings; /* rc_run_measure leaves out what crosses a run */
  /* The level's, where lines get so much narrower towards the horizon that a run must, too; else
   * NULL. */
  const rc_chart *narrows;
} rc_seen;

/* The weights of colours that lines are looked for by. */
const float *rc_brightness_axis(const rc_image *image);
/* The level's pixels by these weights of their channels. */
recede_status rc_see(rc_context *context, const rc_image *image, const rc_mask *flags,
                     const float axis[3], rc_seen *seen);
/* The same picture by its contrast: the deviation within 3 x 3 px. */
recede_status rc_see_contrast(rc_context *context, rc_seen *seen);

#endif
