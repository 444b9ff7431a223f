/* recede scale-map IMAGE|--size WxH -o OUT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "pixels.h"

typedef struct scale_map {
  options *given;
  image_file file;
  recede_view picture; /* the file's, or an empty one of the size asked for */
  recede_view map;     /* one float a pixel */
  recede_job *job;
  recede_report report;
  report_scale scale;
} scale_map;

static command_exit no_memory(void) {
  command_complain(NULL, "not enough memory for the scale map");
  return EXIT_LIMIT;
}

/* Whether the output is the values themselves, not a picture of them. HDR's three channels share an
 * exponent: it is for colours. */
static bool holds_values(const char *output) {
  const image_format *format = image_format_of_name(output);
  return format && image_format_holds(format, RECEDE_FLOAT) && strcmp(format->codec, "hdr") != 0;
}

static command_exit check_format(const scale_map *this) {
  image_message message;
  const options *given = this->given;
  const recede_view *view = &this->file.view;
  int width = given->input ? view->width : given->width;
  int height = given->input ? view->height : given->height;
  recede_type type = holds_values(given->output) ? RECEDE_FLOAT : RECEDE_U8;
  if (image_file_can_write(given->output, NULL, width, height, type, &message)) return EXIT_DONE;
  return command_refuse_image(given->output, IMAGE_OUTPUT, &message);
}

/* The pixels are only needed where the orientation is read from them. */
static command_exit read_input(scale_map *this) {
  options *given = this->given;
  if (!given->input) {
    command_exit format = check_format(this);
    if (format != EXIT_DONE) return format;
    uint64_t bytes = pixels_bytes(given->width, given->height, 1, RECEDE_FLOAT);
    uint64_t limit = given->memory_bytes ? given->memory_bytes : (uint64_t)1 << 30;
    if (bytes > limit) {
      char text[200];
      snprintf(text, sizeof text, "a map of %d x %d takes %llu MiB, the limit is %llu MiB",
               given->width, given->height, (unsigned long long)bytes >> 20,
               (unsigned long long)limit >> 20);
      command_complain(NULL, text);
      return EXIT_LIMIT;
    }
    this->picture = pixels_new(given->width, given->height, 1, RECEDE_U8);
    return this->picture.data ? EXIT_DONE : no_memory();
  }
  command_exit code = command_open(given->input, given, &this->file);
  if (code == EXIT_DONE) code = check_format(this);
  if (code == EXIT_DONE) code = command_read(&this->file, NULL);
  this->picture = this->file.view;
  return code;
}

static command_exit find_plane(scale_map *this) {
  recede_orientation orientation;
  if (!(this->job = command_job(this->given))) return EXIT_LIMIT;
  recede_status status = recede_job_set_params(this->job, &this->given->params);
  if (status == RECEDE_OK) status = recede_job_set_image(this->job, &this->picture);
  command_signals_enter(this->job);
  if (status == RECEDE_OK) status = recede_job_orient(this->job, &orientation);
  int number = command_signals_leave();
  command_exit code = command_finish(this->job, status, this->given);
  if (number) return (command_exit)(128 + number);
  this->report = *recede_job_report(this->job);
  if (status != RECEDE_OK) return code;
  this->report.orientation = orientation;
  command_doubt(this->given, &orientation);
  return code;
}

/* The centre; where that lies beyond the horizon, the image's corner nearest to the viewer. */
static void choose_reference(const recede_plane *plane, report_scale *scale) {
  double right = plane->width - 1, bottom = plane->height - 1, best = 0;
  scale->reference_x = right / 2;
  scale->reference_y = bottom / 2;
  if (recede_plane_w(plane, scale->reference_x, scale->reference_y) > 0) return;
  for (int corner = 0; corner < 4; corner++) {
    double x = corner & 1 ? right : 0, y = corner & 2 ? bottom : 0;
    double w = recede_plane_w(plane, x, y);
    if (w > best) {
      best = w;
      scale->reference_x = x;
      scale->reference_y = y;
    }
  }
}

static void find_range(const recede_view *map, report_scale *scale) {
  scale->smallest = scale->largest = NAN;
  for (int y = 0; y < map->height; y++)
    for (int x = 0; x < map->width; x++) {
      double value = (double)pixels_get(map, x, y, 0);
      if (!(value > 0)) continue;
      scale->smallest = fmin(scale->smallest, value);
      scale->largest = fmax(scale->largest, value);
    }
}

static command_exit make_map(scale_map *this) {
  static const char *const names[] = {"across", "along", "area", "paper"};
  const recede_plane *plane = &this->report.orientation.plane;
  report_scale *scale = &this->scale;
  this->map = pixels_new(this->picture.width, this->picture.height, 1, RECEDE_FLOAT);
  if (!this->map.data) return no_memory();
  scale->kind = names[this->given->kind];
  choose_reference(plane, scale);
  recede_status status = recede_scale_map(plane, this->given->kind, scale->reference_x,
                                          scale->reference_y, &this->map);
  if (status != RECEDE_OK) {
    command_complain(NULL, this->given->kind == RECEDE_SCALE_PAPER
                               ? "The paper's map is only defined for slants below 90 degrees."
                               : "The image lies beyond the horizon: there is no scale.");
    return EXIT_USAGE;
  }
  find_range(&this->map, scale);
  return EXIT_DONE;
}

/* ------------------------------------------------------------------------- as a picture -- */

/* How far down the far end is drawn: eight doublings below the largest scale is black. */
#define SHOWN_DOUBLINGS 8.

static int doubling(const recede_view *map, int x, int y) {
  double value = (double)pixels_get(map, x, y, 0);
  return value > 0 ? (int)floor(log2(value)) : -1000;
}

static bool on_line(const recede_view *map, int x, int y) {
  int here = doubling(map, x, y);
  return (x + 1 < map->width && doubling(map, x + 1, y) != here) ||
         (y + 1 < map->height && doubling(map, x, y + 1) != here);
}

static void paint(const scale_map *this, recede_view *picture) {
  static const float beyond[3] = {.55f, .1f, .1f}, line[3] = {.1f, .45f, .8f};
  double top = log2(this->scale.largest);
  double range = fmin(fmax(top - log2(this->scale.smallest), 1e-6), SHOWN_DOUBLINGS);
  for (int y = 0; y < picture->height; y++)
    for (int x = 0; x < picture->width; x++) {
      double value = (double)pixels_get(&this->map, x, y, 0);
      float gray = (float)(value > 0 ? 1 - (top - log2(value)) / range : 0);
      for (int c = 0; c < 3; c++)
        pixels_set(picture, x, y, c,
                   !(value > 0)                ? beyond[c]
                   : on_line(&this->map, x, y) ? line[c]
                                               : gray);
    }
}

static command_exit write_map(scale_map *this) {
  if (holds_values(this->given->output)) return command_write(this->given, &this->map, NULL, false);
  recede_view picture = pixels_new(this->map.width, this->map.height, 3, RECEDE_U8);
  if (!picture.data) return no_memory();
  paint(this, &picture);
  command_exit code = command_write(this->given, &picture, NULL, false);
  free(picture.data);
  if (code == EXIT_DONE) {
    char text[200];
    snprintf(
        text, sizeof text,
        "scale %s: %.4g to %.4g, of a texel 1 px wide at (%g, %g); white is the largest, a line "
        "at each doubling",
        this->scale.kind, this->scale.smallest, this->scale.largest, this->scale.reference_x,
        this->scale.reference_y);
    command_warn(this->given, NULL, text);
  }
  return code;
}

command_exit command_scale_map(options *given) {
  scale_map this = {.given = given};
  command_exit code = command_check_outputs(given);
  if (code == EXIT_DONE) code = read_input(&this);
  if (code == EXIT_DONE) code = find_plane(&this);
  if (code == EXIT_DONE) code = make_map(&this);
  if (code == EXIT_DONE) code = write_map(&this);
  if (code == EXIT_DONE) code = command_report(given, &this.report, &this.scale);
  if (this.job) recede_job_free(&this.job);
  free(this.map.data);
  if (!given->input) free(this.picture.data);
  image_file_close(&this.file);
  return code;
}
