#include "base/parallel.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

#include "base/memory.h"

#define ASKED_AFTER_NS 30000000

struct rc_pool {
  pthread_mutex_t lock;
  pthread_cond_t wake, done;
  pthread_t threads[64];
  int thread_count, started;
  bool stop;
  unsigned round; /* counts calls of rc_parallel; a worker works once a round */
  int busy;
  rc_context *context;
  rc_work *work;
  void *user;
  int count;
  atomic_int next;
};

static void take_items(rc_pool *pool, int thread) {
  for (;;) {
    if (rc_cancelled(pool->context)) return;
    int item = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
    if (item >= pool->count) return;
    pool->work(pool->user, item, thread);
    if (thread == 0) rc_poll(pool->context);
  }
}

static void *worker(void *argument) {
  rc_pool *pool = argument;
  pthread_mutex_lock(&pool->lock);
  int thread = ++pool->started;
  unsigned seen = 0;
  for (;;) {
    while (!pool->stop && pool->round == seen) pthread_cond_wait(&pool->wake, &pool->lock);
    if (pool->stop) break;
    seen = pool->round;
    pthread_mutex_unlock(&pool->lock);
    take_items(pool, thread);
    pthread_mutex_lock(&pool->lock);
    if (--pool->busy == 0) pthread_cond_signal(&pool->done);
  }
  pthread_mutex_unlock(&pool->lock);
  return NULL;
}

/* Workers take no signals: they belong to the host's own threads. */
static void start_workers(rc_pool *pool, int wanted) {
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &old);
  while (pool->thread_count < wanted &&
         pthread_create(&pool->threads[pool->thread_count], NULL, worker, pool) == 0)
    pool->thread_count++;
  pthread_sigmask(SIG_SETMASK, &old, NULL);
}

/* NULL when there is no memory for it: the calling thread then does all the work. */
static rc_pool *pool_of(rc_context *context) {
  if (context->pool || context->threads < 2) return context->pool;
  rc_pool *pool = calloc(1, sizeof *pool);
  if (!pool) return NULL;
  pthread_mutex_init(&pool->lock, NULL);
  pthread_cond_init(&pool->wake, NULL);
  pthread_condattr_t monotonic;
  pthread_condattr_init(&monotonic);
  pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
  pthread_cond_init(&pool->done, &monotonic);
  pthread_condattr_destroy(&monotonic);
  context->pool = pool;
  start_workers(pool, context->threads - 1);
  return pool;
}

/* The host wants to be asked meanwhile. */
static void wait_for_others(rc_pool *pool) {
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_nsec += ASKED_AFTER_NS;
  if (until.tv_nsec >= 1000000000) until.tv_sec++, until.tv_nsec -= 1000000000;
  if (pthread_cond_timedwait(&pool->done, &pool->lock, &until) != ETIMEDOUT) return;
  pthread_mutex_unlock(&pool->lock);
  rc_poll(pool->context);
  pthread_mutex_lock(&pool->lock);
}

recede_status rc_parallel(rc_context *context, int count, rc_work *work, void *user) {
  rc_pool *pool = count > 1 ? pool_of(context) : NULL;
  rc_pool alone = {.context = context};
  if (!pool) pool = &alone;
  if (pool != &alone) pthread_mutex_lock(&pool->lock);
  pool->context = context;
  pool->work = work;
  pool->user = user;
  pool->count = count;
  atomic_store(&pool->next, 0);
  pool->busy = pool->thread_count;
  if (pool != &alone) {
    pool->round++;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
  }
  take_items(pool, 0);
  if (pool != &alone) {
    pthread_mutex_lock(&pool->lock);
    while (pool->busy > 0) wait_for_others(pool);
    pthread_mutex_unlock(&pool->lock);
  }
  return rc_cancelled(context) ? rc_poll(context) : RECEDE_OK;
}

typedef struct lanes {
  rc_context *context, *contexts; /* of all, of each lane */
  rc_task *task;
  void *user;
  recede_status *status; /* of each item */
  int *lane;             /* where it was done */
  int count;
  atomic_int next, failed;
} lanes;

static void run_lane(void *user, int lane, int thread) {
  lanes *l = user;
  rc_context *own = &l->contexts[lane];
  if (thread == 0) own->parent = l->context;
  while (!atomic_load_explicit(&l->failed, memory_order_relaxed)) {
    int item = atomic_fetch_add_explicit(&l->next, 1, memory_order_relaxed);
    if (item >= l->count) return;
    l->lane[item] = lane;
    l->status[item] = l->task(own, l->user, item, lane);
    rc_release(own, NULL);
    if (l->status[item] != RECEDE_OK) atomic_store(&l->failed, 1);
  }
}

static recede_status one_after_another(rc_context *context, int count, rc_task *task, void *user) {
  for (int item = 0; item < count; item++) {
    rc_block *mark = rc_mark(context);
    RC_TRY(task(context, user, item, 0));
    rc_release(context, mark);
  }
  return RECEDE_OK;
}

recede_status rc_parallel_tasks(rc_context *context, int count, int lane_count, rc_task *task,
                                void *user) {
  lanes l = {.context = context, .task = task, .user = user, .count = count};
  recede_status status;
  if (lane_count == 1) return one_after_another(context, count, task, user);
  rc_block *mark = rc_mark(context);
  RC_TRY(RC_NEW(context, lane_count, &l.contexts));
  RC_TRY(RC_NEW_ZERO(context, count, &l.status));
  RC_TRY(RC_NEW_ZERO(context, count, &l.lane));
  for (int i = 0; i < lane_count; i++) rc_context_part(context, &l.contexts[i]);
  status = rc_parallel(context, lane_count, run_lane, &l);
  for (int i = 0; i < count && status == RECEDE_OK; i++)
    if (l.status[i] != RECEDE_OK)
      status = rc_fail(context, l.status[i], "%s", l.contexts[l.lane[i]].message);
  rc_context_join(context, l.contexts, lane_count);
  rc_release(context, mark);
  return status;
}

void rc_pool_free(rc_context *context) {
  rc_pool *pool = context->pool;
  if (!pool) return;
  pthread_mutex_lock(&pool->lock);
  pool->stop = true;
  pthread_cond_broadcast(&pool->wake);
  pthread_mutex_unlock(&pool->lock);
  for (int i = 0; i < pool->thread_count; i++) pthread_join(pool->threads[i], NULL);
  pthread_cond_destroy(&pool->wake);
  pthread_cond_destroy(&pool->done);
  pthread_mutex_destroy(&pool->lock);
  free(pool);
  context->pool = NULL;
}
