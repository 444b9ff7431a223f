/* The coarse-to-fine loop: start at the coarsest level, then search and vote in turn at each. */
#ifndef RECEDE_SYNTHESIS_SEARCH_DESCENT_H
#define RECEDE_SYNTHESIS_SEARCH_DESCENT_H

#include "synthesis/search/level.h"
#include "synthesis/search/periods.h"
#include "synthesis/search/traits.h"
#include "synthesis/structure/lattice.h"
#include "synthesis/structure/lines.h"
#include "synthesis/structure/rails.h"

#define RC_MAX_LEVELS 10

typedef struct rc_descent {
  const recede_params *params;
  const rc_kernels *kernels;
  rc_chart chart;               /* of the finest level */
  float gain;                   /* of the bytes */
  int cut_x, cut_y, shorter_px; /* as the problem's */
  int level_count;
  rc_image images[RC_MAX_LEVELS];
  rc_mask flags[RC_MAX_LEVELS];
  rc_traits traits[RC_MAX_LEVELS];
  rc_periods of_all;               /* as rc_periods_of_all tells */
  bool due;                        /* these are */
  rc_periods periods;              /* of the coarsest level */
  rc_lattice lattice;              /* px of the coarsest level */
  rc_bends bends;                  /* the lattice's */
  rc_crossing lines[RC_ALL_LINES]; /* px of the finest level */
  int line_count;
  rc_rails rails;
  bool keep_rails; /* an earlier fill of the same plane did: other starts need not be tried */
  rc_conditions conditions; /* of the finest level */
  float layers;             /* as rc_layers_find */
  rc_sides sides;           /* of the finest level */
  bool take_beside; /* what is too far away for a level's patches is taken from beside the hole */
  /* Starts that kept to them fitted well enough. */
  bool lines_taken; /* from the sources: they must be continued */
  bool on_rails, on_lattice, by_periods, continue_lines;
  int cut_level;       /* the coarsest where seams are led by cuts; level_count: nowhere */
  uint8_t *rest;       /* of each pixel; out: 1 where it only continues what lies beside it */
  uint64_t rest_count; /* out */
} rc_descent;

/* Makes the finest level, its field settled into whole copies. Progress .1 .. .8. */
recede_status rc_descend(rc_context *context, rc_descent *descent, rc_level *finest);

#endif
