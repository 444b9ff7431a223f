/* report.h - the report of a run as JSON: locale-independent, the same keys for every subcommand.
 */
#ifndef RECEDE_REPORT_H
#define RECEDE_REPORT_H

#include <stdbool.h>

#include "recede.h"

/* Numbers of a scale map. */
typedef struct report_scale {
  const char *kind;
  double reference_x, reference_y; /* px: where the scale is 1 across the tilt */
  double smallest, largest;
} report_scale;

/* Writes the report to path, or to standard output for "-". scale: NULL but for scale-map.
 * false: why not, in message. */
bool report_write(const char *path, bool overwrite, const recede_report *report,
                  const report_scale *scale, char *message, size_t message_size);

#endif
