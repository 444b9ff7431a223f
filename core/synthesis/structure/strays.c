#include "synthesis/structure/strays.h"

#include <math.h>
#include <stdlib.h>

#include "base/real.h"

/* Its run is so long: junctions may be near. */
#define RUN_PX 24
/* A row and its two neighbours that are so many times as unlike as half of all are no chance. */
#define TIMES_USUAL 20.f
#define LEAST_USUAL 6e-5f /* of white, squared: 2 of 255 */
#define LONGEST_PX 64

/* So far along from (x, y). False: not all of it is seen. */
static bool row_at(const rc_ruler *ruler, float x, float y, float along, float row[RC_WIDE]) {
  float px = x + ruler->ux * along, py = y + ruler->uy * along;
  for (int o = 0; o < RC_WIDE; o++) {
    float across = (float)(o - RC_WIDE_HALF);
    if (!rc_ruler_sample(ruler, px - ruler->uy * across, py + ruler->ux * across, &row[o]))
      return false;
  }
  return true;
}

/* Of its two sides, for what crosses a line shows beside it, and dots of the line do not, the more
 * unlike. */
static float unlike(const float row[RC_WIDE], const float mean[RC_WIDE], float tone) {
  float square[2] = {0, 0};
  int beside = RC_WIDE_HALF - RC_PROFILE_HALF;
  for (int o = 0; o < beside; o++)
    for (int side = 0; side < 2; side++) {
      int at = side ? RC_WIDE - 1 - o : o;
      float off = row[at] - mean[at] - tone;
      square[side] += off * off / (float)beside;
    }
  return fmaxf(square[0], square[1]);
}

bool rc_clean_measure(const rc_ruler *ruler, float x, float y, float outwards, rc_clean *clean) {
  float rows[RUN_PX][RC_WIDE], squares[RUN_PX];
  int count = 0;
  for (int k = 0; k < RUN_PX; k++)
    if (row_at(ruler, x, y, outwards * (RC_PROFILE_FROM_PX + (float)k), rows[count])) count++;
  if (2 * count < RUN_PX) return false;
  for (int o = 0; o < RC_WIDE; o++) {
    clean->mean[o] = 0;
    for (int k = 0; k < count; k++) clean->mean[o] += rows[k][o] / (float)count;
  }
  for (int k = 0; k < count; k++) squares[k] = unlike(rows[k], clean->mean, 0);
  qsort(squares, (size_t)count, sizeof *squares, rc_by_value);
  clean->usual = fmaxf(squares[count / 2], LEAST_USUAL);
  return true;
}

bool rc_strays_at(const rc_ruler *ruler, const rc_clean *clean, float x, float y, int length_px) {
  float rows[LONGEST_PX][RC_WIDE], tone = 0;
  int count = 0, longest = length_px < LONGEST_PX ? length_px : LONGEST_PX;
  for (int k = 0; k < longest; k++)
    if (row_at(ruler, x, y, (float)k - .5f * (float)(longest - 1), rows[count])) count++;
  if (2 * count < longest) return true;
  for (int k = 0; k < count; k++)
    for (int o = 0; o < RC_WIDE; o++)
      tone += (rows[k][o] - clean->mean[o]) / (float)(count * RC_WIDE);
  for (int k = 1; k + 1 < count; k++) {
    float sum = 0;
    for (int j = -1; j <= 1; j++) sum += unlike(rows[k + j], clean->mean, tone) / 3;
    if (sum > TIMES_USUAL * clean->usual) return true;
  }
  return false;
}
