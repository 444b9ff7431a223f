#include "base/context.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/machine.h"
#include "base/memory.h"
#include "base/parallel.h"

#define POLL_SECONDS 0.03 /* cancel is promised within 0.1 s */

double rc_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int resolved_threads(int asked) {
  if (asked <= 0) asked = rc_machine_processors();
  return asked < 1 ? 1 : asked > 64 ? 64 : asked;
}

void rc_context_init(rc_context *context, const recede_host *host) {
  memset(context, 0, sizeof *context);
  recede_host_init(&context->host);
  if (host)
    memcpy(&context->host, host,
           host->struct_size < sizeof *host ? host->struct_size : sizeof *host);
  context->cancelled = &context->cancel_flag;
  context->threads = resolved_threads(context->host.threads);
  context->limit_bytes =
      context->host.memory_bytes ? context->host.memory_bytes : rc_machine_memory_bytes() / 4 * 3;
}

void rc_context_clear(rc_context *context) {
  rc_pool_free(context);
  rc_release(context, NULL);
}

void rc_context_part(const rc_context *context, rc_context *part) {
  memset(part, 0, sizeof *part);
  part->host = context->host;
  part->host.progress = NULL;
  part->threads = 1;
  part->cancelled = context->cancelled;
  part->limit_bytes = context->limit_bytes;
  part->used_bytes = part->peak_bytes = context->used_bytes;
  part->allocations = context->allocations;
}

void rc_context_join(rc_context *context, rc_context *parts, int count) {
  uint64_t peak = context->used_bytes, allocations = context->allocations;
  for (int i = 0; i < count; i++) {
    peak += parts[i].peak_bytes - context->used_bytes;
    if (parts[i].allocations > allocations) allocations = parts[i].allocations;
    rc_context_clear(&parts[i]);
  }
  if (peak > context->peak_bytes) context->peak_bytes = peak;
  context->allocations = allocations;
}

recede_status rc_fail(rc_context *context, recede_status status, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(context->message, sizeof context->message, format, arguments);
  va_end(arguments);
  return status;
}

void rc_warn(rc_context *context, const char *format, ...) {
  char *warning = context->report.warning;
  size_t used = strlen(warning), size = sizeof context->report.warning;
  if (used && used + 1 < size) warning[used++] = ' ';
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(warning + used, size - used, format, arguments);
  va_end(arguments);
}

static void add_stage_seconds(recede_report *report, const char *name, double seconds) {
  int i = 0;
  while (i < report->stage_count && strcmp(report->stages[i].name, name) != 0) i++;
  if (i == RECEDE_MAX_STAGES) return;
  if (i == report->stage_count) {
    report->stages[i].name = name;
    report->stages[i].seconds = 0;
    report->stage_count++;
  }
  report->stages[i].seconds += seconds;
}

void rc_stage_end(rc_context *context) {
  if (context->stage)
    add_stage_seconds(&context->report, context->stage, rc_seconds() - context->stage_start);
  context->stage = NULL;
}

recede_status rc_stage(rc_context *context, const char *name, double from, double to) {
  rc_stage_end(context);
  context->stage = name;
  context->stage_start = rc_seconds();
  double span = context->span_to - context->span_from;
  context->fraction_from = context->span_from + from * span;
  context->fraction_to = context->span_from + to * span;
  return rc_progress(context, 0);
}

void rc_span(rc_context *context, double from, double to) {
  context->span_from = from;
  context->span_to = to;
}

static recede_status ask_host(rc_context *context) {
  context->last_poll = rc_seconds();
  if (context->host.progress &&
      context->host.progress(context->host.user, context->stage ? context->stage : "",
                             context->fraction))
    atomic_store(context->cancelled, 1);
  return rc_cancelled(context) ? rc_fail(context, RECEDE_CANCELLED, "Cancelled.") : RECEDE_OK;
}

/* What the parent said. */
static recede_status told(rc_context *context, recede_status status) {
  return status == RECEDE_OK ? status : rc_fail(context, status, "%s", context->parent->message);
}

recede_status rc_progress(rc_context *context, double fraction) {
  if (context->parent) return told(context, rc_progress(context->parent, fraction));
  double now = context->fraction_from + fraction * (context->fraction_to - context->fraction_from);
  if (now > context->fraction) context->fraction = fmin(now, 1);
  return fraction == 0 ? ask_host(context) : rc_poll(context);
}

recede_status rc_poll(rc_context *context) {
  if (context->parent) return told(context, rc_poll(context->parent));
  if (rc_cancelled(context) || rc_seconds() - context->last_poll > POLL_SECONDS)
    return ask_host(context);
  return RECEDE_OK;
}
