#include "base/memory.h"

#include <stdlib.h>

struct rc_block {
  rc_block *older, *newer;
  size_t bytes;
  void *from; /* what the C library gave */
};

/* The block's head takes one alignment unit, so that the memory behind it stays aligned. */
#define ALIGNMENT ((size_t)64)
#define HEAD ALIGNMENT

static recede_status no_memory(rc_context *context, size_t bytes) {
  return rc_fail(context, RECEDE_NO_MEMORY,
                 "Out of memory: %zu MiB more could not be had. Close other programs or fill a "
                 "smaller region.",
                 (bytes >> 20) + 1);
}

/* Large zeroed memory comes from the system, whose pages are zero when they are first touched: by
 * the thread that needs them, or never. */
static rc_block *block_of_zeros(size_t bytes) {
  char *from = calloc(1, bytes + ALIGNMENT - 1);
  if (!from) return NULL;
  rc_block *block =
      (rc_block *)(void *)(from + (ALIGNMENT - (uintptr_t)from % ALIGNMENT) % ALIGNMENT);
  block->from = from;
  return block;
}

static rc_block *block_of(size_t bytes) {
  rc_block *block = aligned_alloc(ALIGNMENT, bytes);
  if (block) block->from = block;
  return block;
}

static recede_status allocate(rc_context *context, size_t count, size_t size, bool zero,
                              void **memory) {
  size_t bytes;
  *memory = NULL;
  if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX / 2)
    return rc_fail(context, RECEDE_TOO_LARGE, "The picture is too large for this machine.");
  bytes = (bytes + HEAD + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  if (context->used_bytes + bytes > context->limit_bytes)
    return rc_fail(context, RECEDE_TOO_LARGE,
                   "The memory limit of %llu MiB does not suffice (%llu MiB are needed at least). "
                   "Raise the limit or fill a smaller region.",
                   (unsigned long long)(context->limit_bytes >> 20),
                   (unsigned long long)((context->used_bytes + bytes) >> 20) + 1);
  context->allocations++;
  if (context->allocations == context->host.fail_allocation) return no_memory(context, bytes);
  rc_block *block = zero ? block_of_zeros(bytes) : block_of(bytes);
  if (!block) return no_memory(context, bytes);
  block->bytes = bytes;
  block->newer = NULL;
  block->older = context->blocks;
  if (context->blocks) context->blocks->newer = block;
  context->blocks = block;
  context->used_bytes += bytes;
  if (context->used_bytes > context->peak_bytes) context->peak_bytes = context->used_bytes;
  *memory = (char *)block + HEAD;
  return RECEDE_OK;
}

recede_status rc_allocate(rc_context *context, size_t count, size_t size, void **memory) {
  return allocate(context, count, size, false, memory);
}

recede_status rc_allocate_zero(rc_context *context, size_t count, size_t size, void **memory) {
  return allocate(context, count, size, true, memory);
}

static void free_block(rc_context *context, rc_block *block) {
  if (block->older) block->older->newer = block->newer;
  if (block->newer) block->newer->older = block->older;
  if (context->blocks == block) context->blocks = block->older;
  context->used_bytes -= block->bytes;
  free(block->from);
}

void rc_free(rc_context *context, void **memory) {
  if (*memory) free_block(context, (rc_block *)(void *)((char *)*memory - HEAD));
  *memory = NULL;
}

void rc_release(rc_context *context, rc_block *mark) {
  while (context->blocks && context->blocks != mark) free_block(context, context->blocks);
}
