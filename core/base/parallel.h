/* The only file that knows threads. Plain pthreads that sleep while there is nothing to do:
 * OpenMP's spinning threads cost seconds on a loaded machine, and its races cannot be told from
 * false ones by ThreadSanitizer. */
#ifndef RECEDE_BASE_PARALLEL_H
#define RECEDE_BASE_PARALLEL_H

#include "base/context.h"

/* Calls work(user, item, thread) once for each item in 0..count-1, in any order, on
 * context->threads threads; thread is 0..threads-1 and names scratch memory. Items must write
 * disjoint memory and read nothing that another item writes: then the result is the same for any
 * number of threads. work must not allocate, fail or call the host. Between items of its own, and
 * while it waits for others', the calling thread polls the host; RECEDE_CANCELLED leaves the rest
 * undone. */
typedef void rc_work(void *user, int item, int thread);
recede_status rc_parallel(rc_context *context, int count, rc_work *work, void *user);

/* The same for work that allocates, fails and asks the host as any stage does: it is given a
 * context of its own for that, one of so many lanes, 0..lanes-1; one alone is the context itself,
 * with all its threads. Nothing of an item's memory is left for the next one, or after it. All
 * lanes together must keep to the limit. What the first item that failed says is what this says. */
typedef recede_status rc_task(rc_context *own, void *user, int item, int lane);
recede_status rc_parallel_tasks(rc_context *context, int count, int lanes, rc_task *task,
                                void *user);
void rc_pool_free(rc_context *context);

#endif
