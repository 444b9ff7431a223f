/* Fuzz: parameters as text, "key=value" a line. What set() takes, get() must write so that set()
 * takes it again and means the same; what it refuses must leave all parameters as they were. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "recede.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void set_one(recede_params *params, const char *key, const char *value) {
  char message[160] = "", text[400], again[400];
  recede_params before = *params;
  if (recede_params_set(params, key, value, message, sizeof message) != RECEDE_OK) {
    if (memcmp(&before, params, sizeof before) != 0 || !message[0]) abort();
    return;
  }
  int length = recede_params_get(params, key, text, sizeof text);
  if (length < 0 || (size_t)length >= sizeof text) abort();
  if (recede_params_set(params, key, text, message, sizeof message) != RECEDE_OK) abort();
  recede_params_get(params, key, again, sizeof again);
  if (strcmp(text, again) != 0) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  recede_params params;
  recede_params_init(&params);
  char *text = malloc(size + 1), *rest = NULL;
  if (!text) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
    char *equals = strchr(line, '=');
    if (!equals) continue;
    *equals = '\0';
    set_one(&params, line, equals + 1);
  }
  free(text);
  return 0;
}
