/* recede fill IMAGE --mask MASK -o OUT */
#include <stdlib.h>

#include "command.h"
#include "pixels.h"
#include "report.h"

typedef struct fill {
  options *given;
  image_file file;
  recede_view mask, source;
  recede_view stored; /* premultiplied colours, as they were; data NULL: not needed */
  recede_job *job;
} fill;

/* The fill is opaque: what JPEG and the like cannot hold is known before it is made. */
static command_exit check_alpha(const fill *this) {
  image_message message;
  const recede_view *view = &this->file.view;
  if (image_file_holds_alpha(this->given->output, view->channels, &message) ||
      pixels_opaque_outside(view, &this->mask))
    return EXIT_DONE;
  return command_refuse_image(this->given->output, IMAGE_OUTPUT, &message);
}

/* Memory is judged before any pixel of the picture is read: the core looks at the mask alone, and
 * the untouched pages of a zeroed picture take no memory. */
static command_exit check_memory(fill *this) {
  uint64_t bytes;
  double seconds;
  recede_view shape = pixels_new(this->file.view.width, this->file.view.height,
                                 this->file.view.channels, this->file.view.type);
  recede_status status = shape.data ? RECEDE_OK : RECEDE_NO_MEMORY;
  if (!shape.data) command_complain(this->file.path, "not enough memory for its pixels");
  if (status != RECEDE_OK) return EXIT_LIMIT;
  status = recede_job_set_image(this->job, &shape);
  if (status == RECEDE_OK) status = recede_job_set_mask(this->job, &this->mask);
  if (status == RECEDE_OK) status = recede_job_estimate_fill(this->job, &bytes, &seconds);
  free(shape.data);
  return command_finish(this->job, status, this->given);
}

static command_exit read_inputs(fill *this) {
  options *given = this->given;
  command_exit code = command_open(given->input, given, &this->file);
  const recede_view *view = &this->file.view;
  if (code == EXIT_DONE) code = command_check_format(given, &this->file, view->width, view->height);
  if (code == EXIT_DONE) code = command_read_mask(given->mask, given, &this->file, &this->mask);
  if (code == EXIT_DONE && !(this->job = command_job(given))) code = EXIT_LIMIT;
  if (code == EXIT_DONE)
    code = command_finish(this->job, recede_job_set_params(this->job, &given->params), given);
  if (code == EXIT_DONE) code = check_memory(this);
  if (code == EXIT_DONE && given->source)
    code = command_read_mask(given->source, given, &this->file, &this->source);
  if (code == EXIT_DONE) code = command_read(&this->file, &this->stored);
  if (code == EXIT_DONE) code = check_alpha(this);
  return code;
}

static command_exit run(fill *this) {
  recede_view *view = &this->file.view;
  recede_status status = recede_job_set_image(this->job, view);
  if (status == RECEDE_OK) status = recede_job_set_mask(this->job, &this->mask);
  if (status == RECEDE_OK && this->source.data)
    status = recede_job_set_source(this->job, &this->source);
  command_signals_enter(this->job);
  if (status == RECEDE_OK) status = recede_job_fill(this->job, view);
  int number = command_signals_leave();
  command_exit code = command_finish(this->job, status, this->given);
  if (number) return (command_exit)(128 + number);
  if (code == EXIT_DONE && this->stored.data)
    pixels_premultiply_filled(view, &this->stored, &this->mask);
  return code;
}

command_exit command_fill(options *given) {
  fill this = {.given = given};
  command_exit code = command_check_outputs(given);
  if (code == EXIT_DONE) code = read_inputs(&this);
  if (code == EXIT_DONE) code = run(&this);
  if (code == EXIT_DONE) code = command_write(given, &this.file.view, &this.file, true);
  if (code == EXIT_DONE) code = command_report(given, recede_job_report(this.job), NULL);
  if (this.job) recede_job_free(&this.job);
  free(this.stored.data);
  free(this.mask.data);
  free(this.source.data);
  image_file_close(&this.file);
  return code;
}
