/* command.h - what the subcommands of `recede` share: exit codes, messages, a run of the core. */
#ifndef RECEDE_COMMAND_H
#define RECEDE_COMMAND_H

#include "image_file.h"
#include "options.h"
#include "recede.h"
#include "report.h"

typedef enum command_exit {
  EXIT_DONE = 0,
  EXIT_FAILED = 1, /* processing failed */
  EXIT_USAGE = 2,  /* unknown option, a value out of range */
  EXIT_INPUT = 3,  /* missing, malformed, nothing to fill or to copy from */
  EXIT_OUTPUT = 4, /* exists without --force, no such folder, disk full ... */
  EXIT_LIMIT = 5   /* memory, or an image too large */
} command_exit;    /* a signal: 128 + its number */

/* One line on stderr: "recede: NAME: text"; name may be NULL. Control characters are escaped. */
void command_complain(const char *name, const char *text);
/* The same, unless --quiet. */
void command_warn(const options *given, const char *name, const char *text);

/* A complaint about an image file, and the exit code that belongs to it. */
command_exit command_refuse_image(const char *name, image_status status,
                                  const image_message *message);

/* Whether the output, and the JSON file, could be written; asked before any work. */
command_exit command_check_outputs(const options *given);

/* Whether the output's format can hold a result of that size made from the picture, and its file
 * may be replaced by it; says what the format will do to it. Asked before any pixel is read. */
command_exit command_check_format(const options *given, const image_file *file, int width,
                                  int height);

/* Opens the picture's header; its pixels are limited by --memory, else to 1 GiB. */
command_exit command_open(const char *path, const options *given, image_file *file);
/* Reads its pixels; colours that are stored multiplied by alpha are divided by it, as the core
 * wants them. stored: gets a copy of those as they were, to be freed by the caller, or {NULL} where
 * none were divided; NULL: not wanted. */
command_exit command_read(image_file *file, recede_view *stored);
/* Reads a mask for the picture; *mask is to be freed by the caller. */
command_exit command_read_mask(const char *path, const options *given, const image_file *picture,
                               recede_view *mask);

/* A job with the host and the parameters that the options ask for. NULL: no memory, said. */
recede_job *command_job(const options *given);
/* The exit code for a status, after saying why on stderr. */
command_exit command_finish(const recede_job *job, recede_status status, const options *given);

/* Encodes and writes the output; everything the format does to the picture is said. keep: whether
 * the result is the same picture, so that its Exif, XMP and IPTC stay; else only its profile. */
command_exit command_write(const options *given, const recede_view *result, const image_file *like,
                           bool keep);

/* Whether all that was printed arrived. */
command_exit command_end_output(void);

/* Says that an estimated orientation is not to be trusted, where that is so. */
void command_doubt(const options *given, const recede_orientation *orientation);

/* Says the run's warnings and writes the JSON report, where asked for. scale: NULL but for
 * scale-map. */
command_exit command_report(const options *given, const recede_report *report,
                            const report_scale *scale);

/* Signals while the core runs cancel it; at other times they remove the temporary file and end the
 * process. Between these two calls the job must not be freed. */
void command_signals_init(void);
void command_signals_enter(recede_job *job);
/* The signal that came in the meantime, or 0. */
int command_signals_leave(void);

/* Progress on a terminal. */
int command_progress(void *user, const char *stage, double fraction);
void command_progress_clear(void);

command_exit command_fill(options *given);
command_exit command_synthesize(options *given);
command_exit command_scale_map(options *given);
command_exit command_orient(options *given);

#endif
