/* What method plane needs at the most, before it begins. */
#include "synthesis/problem.h"
#include "synthesis/search/cuts.h"
#include "synthesis/search/effort.h"
#include "synthesis/search/trial.h"
#include "synthesis/sources/kin.h"
#include "synthesis/sources/places.h"

uint64_t rc_plane_bytes(uint64_t pixels, uint64_t columns, uint64_t rows, int channels,
                        const recede_params *params) {
  uint64_t c = (uint64_t)channels, box = columns * rows;
  uint64_t most_cut = rc_most_cut_box(rc_effort_of(params)->cut_again_px);
  uint64_t cut = box < most_cut ? box : most_cut, frame = 2 * (columns + rows) + 4;
  uint64_t cuts = most_cut ? RC_CUT_BYTES_PER_PX * (cut + frame) : 0;
  uint64_t grown = 4 * box + (256 << 10); /* the box that detail is measured in */
  /* Levels, and of the coarser ones what their pixels are compared by. */
  uint64_t pyramid = pixels * (4 * c + 1) / 3 + pixels * 4 / 3;
  /* Of the coarser levels, 1/3 of the finest, only the fields stay; the coarsest alone has sources
   * in order, but it may be the only one. */
  uint64_t levels = pixels * (4 + 1 + 1 + 4) + box * (12 + 4 + 1 + 1) * 4 / 3;
  /* Trials, too: the coarsest level may be the only one. */
  uint64_t search = box * (12 + 4 + 4) * 3 + pixels * (4 + 1) + cuts;
  uint64_t pads = rows * (40 * c + 20) + 16 * c * (columns + 5);
  uint64_t composition = box * (12 * c + 4) + pads;
  uint64_t detail = (grown < pixels ? grown : pixels) * (12 * c + 1) + pixels;
  uint64_t last = search > composition ? search : composition;
  uint64_t conditions = pixels * 11 / 10 + (64 << 10);
  uint64_t descent = levels + (last > detail ? last : detail);
  /* Before it, of the coarsest level. */
  uint64_t kin = RC_KIN_BYTES_PER_PX * (pixels < RC_MOST_LOOKED_AT ? pixels : RC_MOST_LOOKED_AT);
  uint64_t steps = pixels * (4 * c + 5);
  return pyramid + conditions + (descent > kin ? descent : kin) + steps + RC_MOST_BYTES_OF_LANES +
         ((uint64_t)4 << 20);
}
