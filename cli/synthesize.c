/* recede synthesize EXEMPLAR --size WxH -o OUT */
#include <stdlib.h>

#include "command.h"
#include "pixels.h"

typedef struct synthesis {
  options *given;
  image_file file;
  recede_view source, result;
  recede_view stored; /* the exemplar's premultiplied colours; data NULL: it has none */
  recede_job *job;
} synthesis;

/* Before any pixel is read; see fill. */
static command_exit check_memory(synthesis *this) {
  uint64_t bytes;
  double seconds;
  const recede_view *view = &this->file.view;
  recede_view shape = pixels_new(view->width, view->height, view->channels, view->type);
  if (!shape.data) {
    command_complain(this->file.path, "not enough memory for its pixels");
    return EXIT_LIMIT;
  }
  recede_status status = recede_job_set_image(this->job, &shape);
  if (status == RECEDE_OK)
    status = recede_job_estimate_synthesize(this->job, this->given->width, this->given->height,
                                            &bytes, &seconds);
  free(shape.data);
  return command_finish(this->job, status, this->given);
}

static command_exit read_inputs(synthesis *this) {
  options *given = this->given;
  command_exit code = command_open(given->input, given, &this->file);
  if (code == EXIT_DONE)
    code = command_check_format(given, &this->file, given->width, given->height);
  if (code == EXIT_DONE && !(this->job = command_job(given))) code = EXIT_LIMIT;
  if (code == EXIT_DONE)
    code = command_finish(this->job, recede_job_set_params(this->job, &given->params), given);
  if (code == EXIT_DONE) code = check_memory(this);
  if (code == EXIT_DONE && given->source)
    code = command_read_mask(given->source, given, &this->file, &this->source);
  if (code == EXIT_DONE) code = command_read(&this->file, &this->stored);
  return code;
}

static command_exit run(synthesis *this) {
  const recede_view *view = &this->file.view;
  this->result = pixels_new(this->given->width, this->given->height, view->channels, view->type);
  if (!this->result.data) {
    command_complain(NULL, "not enough memory for the result");
    return EXIT_LIMIT;
  }
  recede_status status = recede_job_set_image(this->job, view);
  if (status == RECEDE_OK && this->source.data)
    status = recede_job_set_source(this->job, &this->source);
  command_signals_enter(this->job);
  if (status == RECEDE_OK) status = recede_job_synthesize(this->job, &this->result);
  int number = command_signals_leave();
  command_exit code = command_finish(this->job, status, this->given);
  if (number) return (command_exit)(128 + number);
  if (code == EXIT_DONE && this->stored.data)
    pixels_premultiply_around(&this->result, view, &this->stored);
  return code;
}

command_exit command_synthesize(options *given) {
  synthesis this = {.given = given};
  command_exit code = command_check_outputs(given);
  if (code == EXIT_DONE) code = read_inputs(&this);
  if (code == EXIT_DONE) code = run(&this);
  if (code == EXIT_DONE) code = command_write(given, &this.result, &this.file, false);
  if (code == EXIT_DONE) code = command_report(given, recede_job_report(this.job), NULL);
  if (this.job) recede_job_free(&this.job);
  free(this.result.data);
  free(this.source.data);
  free(this.stored.data);
  image_file_close(&this.file);
  return code;
}
