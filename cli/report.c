#include "report.h"

#include <errno.h>
#include <json-glib/json-glib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "safe_file.h"

static void add_text(JsonBuilder *to, const char *name, const char *text) {
  json_builder_set_member_name(to, name);
  json_builder_add_string_value(to, text);
}
static void add_count(JsonBuilder *to, const char *name, uint64_t value) {
  json_builder_set_member_name(to, name);
  json_builder_add_int_value(to, (gint64)value);
}
/* JSON knows no NaN and no infinity: null. */
static void add_value(JsonBuilder *to, double value) {
  if (isfinite(value))
    json_builder_add_double_value(to, value);
  else
    json_builder_add_null_value(to);
}
static void add_number(JsonBuilder *to, const char *name, double value) {
  json_builder_set_member_name(to, name);
  add_value(to, value);
}

static const char *choice(const char *key, unsigned index) {
  size_t rows;
  const recede_param_info *table = recede_param_table(&rows);
  for (size_t i = 0; i < rows; i++)
    if (strcmp(table[i].key, key) == 0 && index <= table[i].maximum) return table[i].choices[index];
  return "?";
}

static void add_orientation(JsonBuilder *to, const recede_orientation *orientation) {
  json_builder_set_member_name(to, "orientation");
  json_builder_begin_object(to);
  add_number(to, "slant_deg", orientation->slant_deg);
  add_number(to, "tilt_deg", orientation->tilt_deg);
  add_number(to, "fov_deg", orientation->fov_deg);
  json_builder_set_member_name(to, "horizon");
  if (isfinite(orientation->horizon[0])) {
    json_builder_begin_array(to);
    for (int i = 0; i < 4; i++) add_value(to, orientation->horizon[i]);
    json_builder_end_array(to);
  } else {
    json_builder_add_null_value(to);
  }
  add_number(to, "confidence", orientation->confidence);
  json_builder_set_member_name(to, "estimated");
  json_builder_add_boolean_value(to, orientation->estimated);
  json_builder_end_object(to);
}

static void add_stages(JsonBuilder *to, const recede_report *report) {
  json_builder_set_member_name(to, "stages");
  json_builder_begin_object(to);
  for (int i = 0; i < report->stage_count; i++)
    add_number(to, report->stages[i].name, report->stages[i].seconds);
  json_builder_end_object(to);
}

static void add_scale(JsonBuilder *to, const report_scale *scale) {
  json_builder_set_member_name(to, "scale");
  json_builder_begin_object(to);
  add_text(to, "kind", scale->kind);
  add_number(to, "reference_x", scale->reference_x);
  add_number(to, "reference_y", scale->reference_y);
  add_number(to, "smallest", scale->smallest);
  add_number(to, "largest", scale->largest);
  json_builder_end_object(to);
}

static void add_pixels(JsonBuilder *to, const recede_report *report) {
  add_text(to, "surface", choice("surface", report->surface));
  add_count(to, "estimated_bytes", report->estimated_bytes);
  add_count(to, "filled_pixels", report->filled_pixels);
  add_count(to, "refused_pixels", report->refused_pixels);
  add_count(to, "magnified_pixels", report->magnified_pixels);
  add_number(to, "largest_magnification", report->largest_magnification);
  add_count(to, "nonfinite_pixels", report->nonfinite_pixels);
  add_number(to, "energy", report->energy);
  add_count(to, "iterations", (uint64_t)report->iterations);
  add_text(to, "warning", report->warning);
}

static char *to_text(const recede_report *report, const report_scale *scale) {
  char hash[17];
  JsonBuilder *to = json_builder_new();
  snprintf(hash, sizeof hash, "%016llx", (unsigned long long)report->output_hash);
  json_builder_begin_object(to);
  add_text(to, "version", RECEDE_VERSION);
  add_text(to, "method", choice("method", report->method));
  add_orientation(to, &report->orientation);
  add_count(to, "seed", (uint64_t)report->seed);
  add_count(to, "threads", (uint64_t)report->threads);
  add_stages(to, report);
  add_count(to, "peak_bytes", report->peak_bytes);
  add_text(to, "output_hash", hash);
  add_pixels(to, report);
  if (scale) add_scale(to, scale);
  json_builder_end_object(to);
  JsonGenerator *generator = json_generator_new();
  JsonNode *root = json_builder_get_root(to);
  json_generator_set_root(generator, root);
  json_generator_set_pretty(generator, TRUE);
  char *bare = json_generator_to_data(generator, NULL);
  char *text = g_strconcat(bare, "\n", NULL);
  g_free(bare);
  json_node_unref(root);
  g_object_unref(generator);
  g_object_unref(to);
  return text;
}

bool report_write(const char *path, bool overwrite, const recede_report *report,
                  const report_scale *scale, char *message, size_t message_size) {
  char *text = to_text(report, scale);
  bool good;
  if (strcmp(path, "-") == 0) {
    good = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    if (!good) snprintf(message, message_size, "standard output: %s", strerror(errno));
  } else {
    good = safe_file_write(path, text, strlen(text), overwrite, message, message_size);
  }
  g_free(text);
  return good;
}
