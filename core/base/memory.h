/* Memory of a run: counted against the limit, owned by the context, given back by mark and release.
 * One thread for each context. Nothing is freed one by one on error paths: whoever took a mark
 * releases. */
#ifndef RECEDE_BASE_MEMORY_H
#define RECEDE_BASE_MEMORY_H

#include "base/context.h"

/* count * size bytes, 64-byte aligned, into *memory; RECEDE_NO_MEMORY when there is none,
 * RECEDE_TOO_LARGE when the product overflows or the limit would be passed. */
recede_status rc_allocate(rc_context *context, size_t count, size_t size, void **memory);
recede_status rc_allocate_zero(rc_context *context, size_t count, size_t size, void **memory);
#define RC_NEW(context, count, pointer) \
  rc_allocate((context), (size_t)(count), sizeof **(pointer), (void **)(pointer))
#define RC_NEW_ZERO(context, count, pointer) \
  rc_allocate_zero((context), (size_t)(count), sizeof **(pointer), (void **)(pointer))
/* Frees one block and sets *memory to NULL; *memory may be NULL. */
void rc_free(rc_context *context, void **memory);
#define RC_FREE(context, pointer) rc_free((context), (void **)(pointer))

/* All blocks allocated after the mark was taken are freed by rc_release(context, mark). */
static inline rc_block *rc_mark(const rc_context *context) { return context->blocks; }
void rc_release(rc_context *context, rc_block *mark);

#endif
