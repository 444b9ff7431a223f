/* Entry points of the library: validate, plan, run, write back. */
#include "recede.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/context.h"
#include "base/memory.h"
#include "image/view.h"
#include "orientation.h"
#include "synthesis/problem_build.h"
#include "synthesis/result.h"

struct recede_job {
  rc_context context;
  recede_params params;
  recede_view image, mask, source; /* data NULL: not set */
};

void recede_host_init(recede_host *host) {
  memset(host, 0, sizeof *host);
  host->struct_size = sizeof *host;
  host->kernel = -1;
}

recede_job *recede_job_new(const recede_host *host) {
  recede_job *job = calloc(1, sizeof *job);
  if (!job) return NULL;
  rc_context_init(&job->context, host);
  recede_params_init(&job->params);
  return job;
}

void recede_job_free(recede_job **job) {
  if (!*job) return;
  rc_context_clear(&(*job)->context);
  free(*job);
  *job = NULL;
}

const char *recede_job_message(const recede_job *job) { return job->context.message; }
const recede_report *recede_job_report(const recede_job *job) { return &job->context.report; }
void recede_job_cancel(recede_job *job) { atomic_store(job->context.cancelled, 1); }

static recede_status set_view(recede_job *job, recede_view *held, const recede_view *view,
                              const char *name, int channels) {
  job->context.message[0] = '\0';
  RC_TRY(rc_view_check(&job->context, view, name, channels));
  *held = *view;
  job->context.message[0] = '\0';
  return RECEDE_OK;
}

recede_status recede_job_set_image(recede_job *job, const recede_view *image) {
  return set_view(job, &job->image, image, "Image", 0);
}
recede_status recede_job_set_mask(recede_job *job, const recede_view *mask) {
  return set_view(job, &job->mask, mask, "Mask", 1);
}
recede_status recede_job_set_source(recede_job *job, const recede_view *source) {
  if (source) return set_view(job, &job->source, source, "Source mask", 1);
  job->source.data = NULL;
  job->context.message[0] = '\0';
  return RECEDE_OK;
}

recede_status recede_job_set_params(recede_job *job, const recede_params *params) {
  recede_params checked;
  char text[256], message[400];
  if (params->struct_size != sizeof *params)
    return rc_fail(&job->context, RECEDE_ARGUMENT,
                   "Parameters: their struct_size is %zu, not %zu. Make them with "
                   "recede_params_init() of the library that is used.",
                   params->struct_size, sizeof *params);
  size_t rows;
  const recede_param_info *table = recede_param_table(&rows);
  recede_params_init(&checked);
  for (size_t i = 0; i < rows; i++) {
    recede_params_get(params, table[i].key, text, sizeof text);
    if (recede_params_set(&checked, table[i].key, text, message, sizeof message) != RECEDE_OK)
      return rc_fail(&job->context, RECEDE_ARGUMENT, "%s.", message);
  }
  job->params = *params;
  job->context.message[0] = '\0';
  return RECEDE_OK;
}

static recede_status begin(recede_job *job) {
  rc_context *context = &job->context;
  rc_release(context, NULL);
  memset(&context->report, 0, sizeof context->report);
  context->message[0] = '\0';
  context->peak_bytes = context->allocations = 0;
  context->fraction = context->last_poll = 0;
  rc_span(context, 0, 1);
  context->stage = NULL;
  context->report.threads = context->threads;
  context->report.seed = job->params.seed;
  context->report.method = job->params.method;
  context->report.surface = job->params.surface;
  if (!job->image.data) return rc_fail(context, RECEDE_ARGUMENT, "No image was given.");
  return RECEDE_OK;
}

/* Every way out of a run. */
static recede_status end(recede_job *job, recede_status status) {
  rc_context *context = &job->context;
  rc_stage_end(context);
  context->report.peak_bytes = context->peak_bytes;
  rc_release(context, NULL);
  atomic_store(context->cancelled, 0);
  if (status == RECEDE_OK) context->message[0] = '\0';
  return status;
}

/* Of calls that write no pixels, and may be over before they ask. */
static recede_status end_if_not_cancelled(recede_job *job, recede_status status) {
  if (status == RECEDE_OK && rc_cancelled(&job->context))
    status = rc_fail(&job->context, RECEDE_CANCELLED, "Cancelled.");
  return end(job, status);
}

static recede_status check_same_size(recede_job *job, const recede_view *view, const char *name) {
  if (!view->data || (view->width == job->image.width && view->height == job->image.height))
    return RECEDE_OK;
  return rc_fail(&job->context, RECEDE_ARGUMENT,
                 "The %s is %d x %d px, the image %d x %d: they must be the same size.", name,
                 view->width, view->height, job->image.width, job->image.height);
}

static rc_views views_of(const recede_job *job) {
  return (rc_views){&job->image, job->mask.data ? &job->mask : NULL,
                    job->source.data ? &job->source : NULL};
}

/* ----------------------------------------------------------------------------- orientation -- */

static recede_status orient(recede_job *job, recede_orientation *orientation) {
  /* A horizon alone: the plane is what lies at the bottom. */
  double on[2] = {(job->image.width - 1) / 2., job->image.height - 1};
  rc_views views = views_of(job);
  rc_target_summary summary;
  RC_TRY(check_same_size(job, &job->mask, "mask"));
  RC_TRY(check_same_size(job, &job->source, "source mask"));
  if (job->mask.data) {
    RC_TRY(rc_summarize_target(&job->context, &job->mask, &summary));
    on[0] = summary.x, on[1] = summary.y;
  }
  return rc_resolve_orientation(&job->context, &job->params, &views, job->image.width,
                                job->image.height, on, orientation);
}

recede_status recede_job_orient(recede_job *job, recede_orientation *orientation) {
  recede_orientation found;
  recede_status status = begin(job);
  if (status == RECEDE_OK) status = orient(job, &found);
  status = end_if_not_cancelled(job, status);
  if (status == RECEDE_OK) *orientation = found;
  return status;
}

/* ------------------------------------------------------------------------------------ fill -- */

static uint64_t pixels_in(rc_box box) {
  return (uint64_t)(box.x1 - box.x0) * (uint64_t)(box.y1 - box.y0);
}

/* pixels: looked at, in rows of so many; columns and rows: of the target's bounding box. */
static uint64_t bytes_of_fill(const recede_job *job, uint64_t pixels, uint64_t row,
                              uint64_t columns, uint64_t rows) {
  int colours = job->image.channels < 3 ? 1 : 3;
  uint64_t reading = (uint64_t)job->context.threads * row * (uint64_t)(job->image.channels + 1) * 4;
  uint64_t problem = pixels * (uint64_t)(colours * 4 + 1) + ((uint64_t)4 << 20) + reading;
  uint64_t method =
      job->params.method == RECEDE_METHOD_PLANE
          ? rc_plane_bytes(pixels, columns, rows, colours, &job->params)
          : pixels * (uint64_t)(colours * 4) + rc_paper_bytes(pixels, colours, &job->params);
  uint64_t before =
      rc_orientation_bytes(&job->params, job->image.width, job->image.height, job->context.threads);
  return problem + method > before ? problem + method : before;
}

/* Of a pixel the core keeps its index as an int32_t. */
static recede_status refuse_too_large(rc_context *context, uint64_t bytes, uint64_t pixels) {
  context->report.estimated_bytes = bytes;
  if (pixels > INT32_MAX)
    return rc_fail(context, RECEDE_TOO_LARGE,
                   "This fill would look at %llu million pixels, the limit is %d million. Fill a "
                   "smaller region or scale the picture down.",
                   (unsigned long long)(pixels / 1000000), INT32_MAX / 1000000);
  if (bytes <= context->limit_bytes) return RECEDE_OK;
  return rc_fail(context, RECEDE_TOO_LARGE,
                 "This fill needs up to %llu MiB, the limit is %llu MiB. Raise the limit, fill a "
                 "smaller region or scale the picture down.",
                 (unsigned long long)(bytes >> 20) + 1,
                 (unsigned long long)(context->limit_bytes >> 20));
}

static recede_status plan_fill(recede_job *job, rc_target_summary *summary) {
  if (!job->mask.data)
    return rc_fail(&job->context, RECEDE_ARGUMENT, "No mask was given: nothing says what to fill.");
  RC_TRY(check_same_size(job, &job->mask, "mask"));
  RC_TRY(check_same_size(job, &job->source, "source mask"));
  RC_TRY(rc_summarize_target(&job->context, &job->mask, summary));
  rc_views views = views_of(job);
  RC_TRY(rc_look_around(&job->context, &views, summary));
  rc_box box = summary->looked_at, target = summary->box;
  uint64_t bytes =
      bytes_of_fill(job, pixels_in(box), (uint64_t)(box.x1 - box.x0),
                    (uint64_t)(target.x1 - target.x0), (uint64_t)(target.y1 - target.y0));
  return refuse_too_large(&job->context, bytes, pixels_in(box));
}

recede_status recede_job_estimate_fill(recede_job *job, uint64_t *bytes, double *seconds) {
  rc_target_summary summary;
  recede_status status = begin(job);
  if (status == RECEDE_OK) status = plan_fill(job, &summary);
  if (status == RECEDE_OK || status == RECEDE_TOO_LARGE) {
    *bytes = job->context.report.estimated_bytes;
    *seconds = 1e-5 * (double)summary.pixels; /* measured: about 10 us a target pixel */
  }
  return end_if_not_cancelled(job, status);
}

static recede_status check_result(recede_job *job, const recede_view *result, bool same_size) {
  RC_TRY(rc_view_check(&job->context, result, "Result", job->image.channels));
  if (result->type != job->image.type ||
      (same_size && (result->width != job->image.width || result->height != job->image.height)))
    return rc_fail(&job->context, RECEDE_ARGUMENT, "Result: its %s must be the image's.",
                   result->type != job->image.type ? "type" : "size");
  return RECEDE_OK;
}

/* Method plane works in the problem's own pixels: a copy of 12 MP is 144 MB. */
static recede_status run_method(recede_job *job, const rc_problem *problem, rc_image *filled) {
  rc_context *context = &job->context;
  *filled = problem->image;
  if (job->params.method == RECEDE_METHOD_PLANE)
    return rc_fill_in_steps(context, problem, &job->params, filled);
  RC_TRY(rc_image_new(context, problem->image.width, problem->image.height, problem->image.channels,
                      filled));
  memcpy(filled->data, problem->image.data,
         (size_t)filled->width * (size_t)filled->height * (size_t)filled->channels * sizeof(float));
  return rc_fill_paper(context, problem, &job->params, filled);
}

static recede_status fill(recede_job *job, const recede_view *result) {
  rc_context *context = &job->context;
  rc_target_summary summary;
  rc_problem problem;
  rc_image filled;
  recede_orientation *orientation = &context->report.orientation;
  RC_TRY(rc_stage(context, "prepare", 0, .01));
  RC_TRY(check_result(job, result, true));
  RC_TRY(plan_fill(job, &summary));
  rc_views views = views_of(job);
  const double on[2] = {summary.x, summary.y};
  RC_TRY(rc_trusted_orientation(context, &job->params, &views, job->image.width, job->image.height,
                                on, orientation));
  RC_TRY(rc_stage(context, "prepare", .03, .05));
  RC_TRY(rc_problem_of_fill(context, &views, &orientation->plane, &summary, &problem));
  RC_TRY(run_method(job, &problem, &filled));
  RC_TRY(rc_stage(context, "write", .97, 1));
  rc_write_fill(&views, &problem, &filled, result);
  context->report.output_hash = rc_view_hash(result);
  return RECEDE_OK;
}

recede_status recede_job_fill(recede_job *job, const recede_view *result) {
  recede_status status = begin(job);
  return end(job, status == RECEDE_OK ? fill(job, result) : status);
}

/* ------------------------------------------------------------------------------ synthesize -- */

static recede_status check_frontal(recede_job *job) {
  if (job->params.orientation == RECEDE_ORIENTATION_AUTO)
    return rc_fail(&job->context, RECEDE_ARGUMENT,
                   "An exemplar seen from the front does not tell how the plane lies: give slant "
                   "and tilt, a horizon or a quad.");
  if (job->params.method != RECEDE_METHOD_PLANE)
    return rc_fail(&job->context, RECEDE_ARGUMENT,
                   "Methods paper and kwatra need an exemplar in perspective: use method plane for "
                   "one seen from the front.");
  return RECEDE_OK;
}

static recede_status plan_synthesis(recede_job *job, int width, int height) {
  if (width < 1 || height < 1 || width > 1 << 20 || height > 1 << 20)
    return rc_fail(&job->context, RECEDE_ARGUMENT, "The size %d x %d is outside 1..1048576.", width,
                   height);
  RC_TRY(check_same_size(job, &job->source, "source mask"));
  if (job->params.exemplar == RECEDE_EXEMPLAR_FRONTAL) RC_TRY(check_frontal(job));
  uint64_t pixels = (uint64_t)width * (uint64_t)height;
  uint64_t exemplar = (uint64_t)job->image.width * (uint64_t)job->image.height;
  bool in_plane = job->params.method == RECEDE_METHOD_PLANE;
  int row = job->image.width > width ? job->image.width : width;
  uint64_t bytes = bytes_of_fill(job, in_plane ? pixels : pixels + exemplar, (uint64_t)row,
                                 (uint64_t)width, (uint64_t)height);
  /* As floats with flags; laid at all sizes, with what is scratch at the largest. */
  uint64_t of_pixel = (job->image.channels < 3 ? 1 : 3) * sizeof(float) + 1;
  if (in_plane) bytes += exemplar * of_pixel * 4 / 3 + exemplar * 2 + ((uint64_t)64 << 10);
  return refuse_too_large(&job->context, bytes, pixels > exemplar ? pixels : exemplar);
}

recede_status recede_job_estimate_synthesize(recede_job *job, int width, int height,
                                             uint64_t *bytes, double *seconds) {
  recede_status status = begin(job);
  if (status == RECEDE_OK) status = plan_synthesis(job, width, height);
  if (status == RECEDE_OK || status == RECEDE_TOO_LARGE) {
    *bytes = job->context.report.estimated_bytes;
    *seconds = 1e-5 * (double)width * height;
  }
  return end_if_not_cancelled(job, status);
}

static rc_views exemplar_of(const recede_job *job) {
  return (rc_views){&job->image, NULL, job->source.data ? &job->source : NULL};
}

static recede_status synthesize_in_plane(recede_job *job, const recede_plane *plane,
                                         const recede_view *result) {
  rc_views views = exemplar_of(job);
  rc_problem problem;
  rc_image filled;
  /* Seen from the front like the result it is the result's middle, pixel by pixel. */
  bool laid = job->params.exemplar == RECEDE_EXEMPLAR_FRONTAL &&
              (plane->normal[0] != 0 || plane->normal[1] != 0);
  RC_TRY(rc_problem_of_synthesis(&job->context, &views, plane, laid, &problem));
  RC_TRY(run_method(job, &problem, &filled));
  RC_TRY(rc_stage(&job->context, "write", .97, 1));
  float least = laid
                    ? problem.least
                    : rc_least_known(&job->image, &problem, problem.exemplar_x, problem.exemplar_y);
  rc_write_synthesis(&filled, &problem.flags, least, result);
  if (!laid) rc_write_exemplar(&job->image, &problem, result);
  return RECEDE_OK;
}

static recede_status synthesize_as_paper(recede_job *job, const recede_plane *plane,
                                         const recede_view *result) {
  rc_context *context = &job->context;
  rc_views views = exemplar_of(job);
  rc_image exemplar, made;
  rc_mask flags;
  RC_TRY(rc_shrink(context, &views, 1, &exemplar, &flags));
  RC_TRY(rc_image_new(context, result->width, result->height, exemplar.channels, &made));
  RC_TRY(rc_synthesize_paper(context, &exemplar, &flags, plane, &job->params, &made));
  RC_TRY(rc_stage(context, "write", .97, 1));
  context->report.filled_pixels = (uint64_t)made.width * (uint64_t)made.height;
  rc_write_synthesis(&made, NULL, -INFINITY, result);
  return RECEDE_OK;
}

/* Method plane: the orientation is the result's, the exemplar its middle, seen by the same camera.
 * The paper: it is the exemplar's, and its scale map is stretched to the result (its section 4). */
static recede_status synthesize(recede_job *job, const recede_view *result) {
  rc_context *context = &job->context;
  recede_orientation *orientation = &context->report.orientation;
  bool in_plane = job->params.method == RECEDE_METHOD_PLANE;
  const recede_view *framed = in_plane ? result : &job->image;
  RC_TRY(rc_stage(context, "prepare", 0, .01));
  RC_TRY(check_result(job, result, false));
  RC_TRY(plan_synthesis(job, result->width, result->height));
  rc_views views = exemplar_of(job);
  const double on[2] = {(framed->width - 1) / 2., (framed->height - 1) / 2.};
  RC_TRY(rc_trusted_orientation(context, &job->params, &views, framed->width, framed->height, on,
                                orientation));
  RC_TRY(rc_stage(context, "prepare", .03, .05));
  RC_TRY(in_plane ? synthesize_in_plane(job, &orientation->plane, result)
                  : synthesize_as_paper(job, &orientation->plane, result));
  context->report.output_hash = rc_view_hash(result);
  return RECEDE_OK;
}

recede_status recede_job_synthesize(recede_job *job, const recede_view *result) {
  recede_status status = begin(job);
  return end(job, status == RECEDE_OK ? synthesize(job, result) : status);
}
