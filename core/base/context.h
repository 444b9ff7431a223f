/* What every stage of a run is given: memory, threads, progress, cancel, message. */
#ifndef RECEDE_BASE_CONTEXT_H
#define RECEDE_BASE_CONTEXT_H

#include <stdatomic.h>
#include <stdbool.h>

#include "recede.h"

typedef struct rc_block rc_block;
typedef struct rc_pool rc_pool;

typedef struct rc_context rc_context;
struct rc_context {
  recede_host host;
  rc_context *parent; /* of a part on the calling thread: it is asked instead of the host */
  int threads;        /* resolved: 1..64 */
  atomic_int cancel_flag, *cancelled; /* its own, or the one of what it is a part of */
  rc_block *blocks;                   /* newest first */
  uint64_t used_bytes, peak_bytes, limit_bytes, allocations;
  rc_pool *pool;
  char message[512];
  recede_report report;
  double stage_start, last_poll;
  const char *stage;
  double fraction, fraction_from, fraction_to;
  double span_from, span_to; /* of the run, what stages are fractions of */
};

/* Passes any status but RECEDE_OK on to the caller. Memory needs no clean-up on the way: it belongs
 * to the context (base/memory.h). */
#define RC_TRY(expression)                          \
  do {                                              \
    recede_status rc_status_ = (expression);        \
    if (rc_status_ != RECEDE_OK) return rc_status_; \
  } while (0)

void rc_context_init(rc_context *context, const recede_host *host);
void rc_context_clear(rc_context *context);
/* A part of it, for one thread: memory counts as if it were alone, and nobody is asked. */
void rc_context_part(const rc_context *context, rc_context *part);
/* Gives a part's memory back. Parts count their allocations from the same number on, and all may
 * have had the most they ever had at once. */
void rc_context_join(rc_context *context, rc_context *parts, int count);

/* Formats the message that recede_job_message() shows and returns status. */
recede_status rc_fail(rc_context *context, recede_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Appends a sentence to the report's warnings. */
void rc_warn(rc_context *context, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Opens the stage of that name (a string constant): its seconds are summed in the report, and
 * rc_progress() within it runs over from..to of the whole run. Stages do not nest. */
recede_status rc_stage(rc_context *context, const char *name, double from, double to);
void rc_stage_end(rc_context *context);
/* Fractions of the stages opened from now on are of that part of the run. */
void rc_span(rc_context *context, double from, double to);
/* fraction 0..1 of the stage. RECEDE_CANCELLED when the run is to stop. Calling thread only. */
recede_status rc_progress(rc_context *context, double fraction);
/* Cheap enough for inner loops of the calling thread: asks the host at most every 30 ms. */
recede_status rc_poll(rc_context *context);
/* Loops over single pixels, one after another, ask it every so many. */
#define RC_POLLED_PX 4096
static inline bool rc_cancelled(const rc_context *context) {
  return atomic_load_explicit(context->cancelled, memory_order_relaxed) != 0;
}
double rc_seconds(void);

#endif
