#include "orientation.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "plane/estimate.h"
#include "synthesis/problem_build.h"

/* Orientation is read from a copy of the picture no longer than this: the estimate's accuracy does
 * not gain from more, its time does. */
#define ESTIMATE_LONGEST_PX 1000

/* What stands on a floor reaches above the floor's horizon: so much of a hole below it is its foot,
 * and tells the plane's side. A hole in a ceiling hardly reaches that far down. */
#define LEAST_FOOT .1

/* A reading that the source tells is given up for the whole picture's where that leaves so little
 * of its doubt. A pier's planks alone were trusted by .54 to .89 and wrong, all of it by .99 and
 * right. */
#define MUCH_SURER .1
/* And so sure a source is not doubted: asking again takes as long. */
#define SURE .9

/* Of 10 degrees: readings farther apart are of another plane. */
#define ANOTHER_PLANE_COSINE .985

/* A picture much larger than the frame it is the middle of would be seen at 180 degrees: the
 * parameter's own limits. */
#define LEAST_FOV_DEG 1
#define MOST_FOV_DEG 170

/* Measured, of the small copy: 37 bytes a pixel, and for each thread .3 and 60 KB. Of a row of the
 * picture: five floats a pixel and what they are. */
#define BYTES_PER_PX 40
#define BYTES_PER_PX_OF_ROW 21
#define FIXED_BYTES (1 << 20)
#define THREADS_SHARE 3 /* a thread's part of a byte a pixel is 1 of so many */
#define FIXED_BYTES_OF_THREAD (96 << 10)

static int longer(int width, int height) { return width > height ? width : height; }

static int shrink_factor(int width, int height) {
  return (longer(width, height) + ESTIMATE_LONGEST_PX - 1) / ESTIMATE_LONGEST_PX;
}

/* From the source's pixels, where there is a source; whether it was chosen. The plane gets the
 * frame's size and a focal length by the frame's field of view. */
static recede_status read_plane(rc_context *context, double fov_deg, const rc_views *views,
                                int width, int height, const double on[2], bool *chosen,
                                recede_orientation *orientation) {
  const recede_view *picture = views->image;
  int longest = longer(picture->width, picture->height);
  int factor = shrink_factor(picture->width, picture->height);
  rc_image image;
  rc_mask flags;
  recede_plane *plane = &orientation->plane, frame;
  const double small_on[2] = {(on[0] + .5) / factor - .5, (on[1] + .5) / factor - .5};
  RC_TRY(recede_plane_from_angles(width, height, 0, 0, fov_deg, &frame));
  double fov_of_picture = 2 * atan(.5 * longest / frame.focal_px) * (180 / 3.14159265358979323846);
  fov_of_picture = fmin(fmax(fov_of_picture, LEAST_FOV_DEG), MOST_FOV_DEG);
  rc_block *mark = rc_mark(context);
  RC_TRY(rc_shrink(context, views, factor, &image, &flags));
  *chosen = rc_sources_are_chosen(&flags);
  RC_TRY(rc_estimate_plane(context, &image, &flags, fov_of_picture, views->mask ? small_on : NULL,
                           plane, &orientation->confidence));
  rc_release(context, mark);
  plane->focal_px = frame.focal_px;
  plane->width = width;
  plane->height = height;
  return RECEDE_OK;
}

uint64_t rc_orientation_bytes(const recede_params *params, int width, int height, int threads) {
  if (params->orientation != RECEDE_ORIENTATION_AUTO) return 0;
  int factor = shrink_factor(width, height);
  uint64_t small = (uint64_t)((width + factor - 1) / factor) * ((height + factor - 1) / factor);
  return small * BYTES_PER_PX + (uint64_t)width * BYTES_PER_PX_OF_ROW + FIXED_BYTES +
         (uint64_t)threads * (small / THREADS_SHARE + FIXED_BYTES_OF_THREAD);
}

static bool lie_apart(const recede_plane *a, const recede_plane *b) {
  double dot = 0;
  for (int k = 0; k < 3; k++) dot += a->normal[k] * b->normal[k];
  return dot < ANOTHER_PLANE_COSINE;
}

static bool all_tells_more(const recede_orientation *source, const recede_orientation *all,
                           bool beside_a_hole) {
  if (all->confidence < RECEDE_CONFIDENCE_LOW) return false;
  if (source->confidence < RECEDE_CONFIDENCE_LOW) return true;
  return beside_a_hole && 1 - all->confidence < MUCH_SURER * (1 - source->confidence);
}

/* Where there is a chosen source all of the picture is asked, too: a source may leave out the edges
 * of a pier, which tell where it leads. Where there is a hole, a wall as source is not lost among
 * floors: what lies beside the hole contradicts them. */
static recede_status estimate(rc_context *context, double fov_deg, const rc_views *views, int width,
                              int height, const double on[2], recede_orientation *orientation) {
  rc_views all = *views;
  recede_orientation of_all = *orientation;
  bool chosen;
  RC_TRY(rc_stage(context, "orientation", 0, .03));
  rc_block *mark = rc_mark(context);
  recede_status status =
      read_plane(context, fov_deg, views, width, height, on, &chosen, orientation);
  rc_release(context, mark);
  bool read = status == RECEDE_OK;
  if (!read && status != RECEDE_NO_PLANE) return status;
  if (!views->source || (read && (!chosen || orientation->confidence >= SURE))) return status;
  all.source = NULL;
  status = read_plane(context, fov_deg, &all, width, height, on, &chosen, &of_all);
  rc_release(context, mark);
  if (status == RECEDE_NO_PLANE) return read ? RECEDE_OK : status;
  if (status != RECEDE_OK || (read && !all_tells_more(orientation, &of_all, views->mask)))
    return status;
  if (of_all.confidence >= RECEDE_CONFIDENCE_LOW &&
      (!read || lie_apart(&orientation->plane, &of_all.plane)))
    rc_warn(context,
            "The source tells less of how the plane lies than the whole picture, from which the "
            "orientation was read. Give slant and tilt, or a horizon, if another plane is meant.");
  *orientation = of_all;
  return RECEDE_OK;
}

static recede_status explain(rc_context *context, recede_status status, const char *what) {
  return status == RECEDE_OK
             ? RECEDE_OK
             : rc_fail(context, status,
                       "The %s does not give a plane: its points must be distinct, in order around "
                       "it, and apart from what is filled.",
                       what);
}

/* (on) becomes the middle of what the mask has below a horizon h, if that is its foot. */
static recede_status move_to_foot(rc_context *context, const recede_view *mask, const double h[4],
                                  double on[2]) {
  rc_target_summary all, below;
  rc_box whole = {0, 0, mask->width, mask->height};
  /* Where it is steeper neither side is below. */
  if (!(fabs(h[3] - h[1]) <= fabs(h[2] - h[0]))) return RECEDE_OK;
  RC_TRY(rc_sum_target(context, mask, whole, NULL, &all));
  RC_TRY(rc_sum_target(context, mask, all.box, h, &below));
  if ((double)below.pixels > LEAST_FOOT * (double)all.pixels) on[0] = below.x, on[1] = below.y;
  return RECEDE_OK;
}

static recede_status find_plane(rc_context *context, const recede_params *p, const rc_views *views,
                                int width, int height, const double on[2],
                                recede_orientation *orientation) {
  recede_plane *plane = &orientation->plane;
  const double *h = p->horizon;
  double side[2] = {on[0], on[1]};
  orientation->confidence = 1;
  switch (p->orientation) {
    case RECEDE_ORIENTATION_ANGLES:
      return recede_plane_from_angles(width, height, p->slant_deg, p->tilt_deg, p->fov_deg, plane);
    case RECEDE_ORIENTATION_FRONTAL:
      return recede_plane_from_angles(width, height, 0, 0, p->fov_deg, plane);
    case RECEDE_ORIENTATION_HORIZON:
      if (views->mask) RC_TRY(move_to_foot(context, views->mask, h, side));
      return explain(context,
                     recede_plane_from_horizon(width, height, p->fov_deg, h[0], h[1], h[2], h[3],
                                               side[0], side[1], plane),
                     "horizon");
    case RECEDE_ORIENTATION_QUAD:
      return explain(context, recede_plane_from_quad(width, height, p->fov_deg, p->quad, 1, plane),
                     "quad");
    default: orientation->estimated = 1;
  }
  return estimate(context, p->fov_deg, views, width, height, on, orientation);
}

static void describe(recede_orientation *orientation) {
  recede_plane_angles(&orientation->plane, &orientation->slant_deg, &orientation->tilt_deg,
                      &orientation->fov_deg);
  if (!recede_plane_horizon(&orientation->plane, orientation->horizon))
    for (int i = 0; i < 4; i++) orientation->horizon[i] = NAN;
}

recede_status rc_resolve_orientation(rc_context *context, const recede_params *params,
                                     const rc_views *views, int width, int height,
                                     const double on[2], recede_orientation *orientation) {
  memset(orientation, 0, sizeof *orientation);
  RC_TRY(find_plane(context, params, views, width, height, on, orientation));
  describe(orientation);
  return RECEDE_OK;
}

recede_status rc_trusted_orientation(rc_context *context, const recede_params *params,
                                     const rc_views *views, int width, int height,
                                     const double on[2], recede_orientation *orientation) {
  recede_status status =
      rc_resolve_orientation(context, params, views, width, height, on, orientation);
  if (!orientation->estimated) return status;
  if (status != RECEDE_OK && status != RECEDE_NO_PLANE) return status;
  if (status != RECEDE_OK) orientation->confidence = 0;
  if (orientation->confidence >= RECEDE_CONFIDENCE_LOW) return RECEDE_OK;
  rc_warn(
      context,
      "The orientation could not be read from the picture with confidence (%.2f); it was filled "
      "without perspective. Give slant and tilt, or a horizon.",
      orientation->confidence);
  RC_TRY(recede_plane_from_angles(width, height, 0, 0, params->fov_deg, &orientation->plane));
  describe(orientation);
  return RECEDE_OK;
}
