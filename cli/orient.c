/* recede orient IMAGE */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

typedef struct orient {
  options *given;
  image_file file;
  recede_view mask, source;
  recede_job *job;
  recede_report report;
} orient;

static command_exit read_inputs(orient *this) {
  options *given = this->given;
  command_exit code = command_open(given->input, given, &this->file);
  if (code == EXIT_DONE && given->mask)
    code = command_read_mask(given->mask, given, &this->file, &this->mask);
  if (code == EXIT_DONE && given->source)
    code = command_read_mask(given->source, given, &this->file, &this->source);
  if (code == EXIT_DONE) code = command_read(&this->file, NULL);
  if (code == EXIT_DONE && !(this->job = command_job(given))) code = EXIT_LIMIT;
  return code;
}

static command_exit run(orient *this) {
  recede_status status = recede_job_set_params(this->job, &this->given->params);
  if (status == RECEDE_OK) status = recede_job_set_image(this->job, &this->file.view);
  if (status == RECEDE_OK && this->mask.data) status = recede_job_set_mask(this->job, &this->mask);
  if (status == RECEDE_OK && this->source.data)
    status = recede_job_set_source(this->job, &this->source);
  command_signals_enter(this->job);
  recede_orientation orientation;
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

/* For people; scripts use --json. */
static command_exit say(const orient *this) {
  const recede_orientation *found = &this->report.orientation;
  printf("slant %.1f°, tilt %.1f°, field of view %.0f°\n", found->slant_deg, found->tilt_deg,
         found->fov_deg);
  if (isfinite(found->horizon[0]))
    printf("horizon %.0f,%.0f,%.0f,%.0f\n", found->horizon[0], found->horizon[1], found->horizon[2],
           found->horizon[3]);
  printf("confidence %.2f\n", found->confidence);
  return command_end_output();
}

command_exit command_orient(options *given) {
  orient this = {.given = given};
  command_exit code = command_check_outputs(given);
  if (code == EXIT_DONE) code = read_inputs(&this);
  if (code == EXIT_DONE) code = run(&this);
  bool json_to_stdout = given->json && strcmp(given->json, "-") == 0;
  if (code == EXIT_DONE && !json_to_stdout && !given->quiet) code = say(&this);
  if (code == EXIT_DONE) code = command_report(given, &this.report, NULL);
  if (this.job) recede_job_free(&this.job);
  free(this.mask.data);
  free(this.source.data);
  image_file_close(&this.file);
  return code;
}
