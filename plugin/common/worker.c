/* One run of the core in a thread of its own. */
#include "worker.h"

struct rp_worker {
  GThread *thread;
  recede_job *job;
  rp_request *request;
  GMutex mutex; /* guards state */
  GCond changed;
  rp_state state;
};

static int on_progress(void *user, const char *stage, double fraction) {
  rp_worker *worker = user;
  g_mutex_lock(&worker->mutex);
  worker->state.stage = stage;
  worker->state.fraction = fraction;
  g_mutex_unlock(&worker->mutex);
  return 0;
}

static recede_status prepare(recede_job *job, const rp_request *request) {
  recede_status status = recede_job_set_params(job, &request->params);
  if (status == RECEDE_OK) status = recede_job_set_image(job, &request->image);
  if (status == RECEDE_OK && request->mask.data) status = recede_job_set_mask(job, &request->mask);
  if (status == RECEDE_OK && request->source.data)
    status = recede_job_set_source(job, &request->source);
  return status;
}

static recede_status run(recede_job *job, rp_request *request) {
  recede_status status = prepare(job, request);
  if (status != RECEDE_OK) return status;
  switch (request->run) {
    case RP_RUN_FILL: return recede_job_fill(job, &request->result);
    case RP_RUN_SYNTHESIZE: return recede_job_synthesize(job, &request->result);
    default: return recede_job_orient(job, &request->orientation);
  }
}

static gpointer work(gpointer data) {
  rp_worker *worker = data;
  rp_request *request = worker->request;
  request->status = run(worker->job, request);
  request->report = *recede_job_report(worker->job);
  if (request->run != RP_RUN_ORIENT) request->orientation = request->report.orientation;
  g_strlcpy(request->message, recede_job_message(worker->job), sizeof request->message);
  g_mutex_lock(&worker->mutex);
  worker->state.finished = TRUE;
  g_cond_signal(&worker->changed);
  g_mutex_unlock(&worker->mutex);
  return NULL;
}

rp_worker *rp_worker_start(rp_request *request) {
  rp_worker *worker = g_new0(rp_worker, 1);
  recede_host host;
  recede_host_init(&host);
  host.threads = request->threads;
  host.progress = on_progress;
  host.user = worker;
  g_mutex_init(&worker->mutex);
  g_cond_init(&worker->changed);
  worker->request = request;
  worker->state.stage = "prepare";
  worker->job = recede_job_new(&host);
  if (worker->job) {
    worker->thread = g_thread_new("recede", work, worker);
  } else {
    request->status = RECEDE_NO_MEMORY;
    worker->state.finished = TRUE;
  }
  return worker;
}

rp_state rp_worker_state(rp_worker *worker) {
  g_mutex_lock(&worker->mutex);
  rp_state state = worker->state;
  g_mutex_unlock(&worker->mutex);
  return state;
}

void rp_worker_cancel(rp_worker *worker) {
  if (worker->job) recede_job_cancel(worker->job);
}

void rp_worker_finish(rp_worker **worker) {
  if (!*worker) return;
  if ((*worker)->thread) g_thread_join((*worker)->thread);
  recede_job_free(&(*worker)->job);
  g_mutex_clear(&(*worker)->mutex);
  g_cond_clear(&(*worker)->changed);
  g_free(*worker);
  *worker = NULL;
}

rp_state rp_worker_wait(rp_worker *worker) {
  gint64 until = g_get_monotonic_time() + RP_TELL_EVERY_MS * G_TIME_SPAN_MILLISECOND;
  g_mutex_lock(&worker->mutex);
  while (!worker->state.finished)
    if (!g_cond_wait_until(&worker->changed, &worker->mutex, until)) break;
  rp_state state = worker->state;
  g_mutex_unlock(&worker->mutex);
  return state;
}
