/* Prints the core's table, the rows that hosts register: key, type, range, default, choices. */
#include <stdio.h>

#include "recede.h"

int main(void) {
  static const char *const types[] = {"double", "int", "choice", "points"};
  size_t rows;
  const recede_param_info *row = recede_param_table(&rows);
  for (; rows > 0; row++, rows--) {
    if (!(row->flags & RECEDE_PARAM_HOST)) continue;
    printf("%s\t%s\t%.15g\t%.15g\t%.15g\t", row->key, types[row->type], row->minimum, row->maximum,
           row->default_value);
    for (int i = 0; row->choices && row->choices[i]; i++) printf("%s ", row->choices[i]);
    puts("");
  }
  return 0;
}
