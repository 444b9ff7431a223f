/* recede.h - perspective texture synthesis: the one public header of librecede.
 *
 * What it does. Fills a region of a picture of a receding plane (a street, a floor, a beach) so
 * that the texture gets smaller towards the horizon, or makes a larger picture of such a plane from
 * an exemplar.
 *
 * How it is used.
 *     recede_job *job = recede_job_new(NULL);
 *     recede_params params;
 *     recede_params_init(&params);
 *     recede_job_set_params(job, &params);
 *     recede_job_set_image(job, &image);
 *     recede_job_set_mask(job, &mask);
 *     if (recede_job_fill(job, &result) != RECEDE_OK) puts(recede_job_message(job));
 *     recede_job_free(&job);
 *
 * Ownership. The caller owns every view's pixels, the job owns everything else.
 * Coordinates. x right, y down, pixel centres at integers. Angles in degrees.
 * Slant: angle between the view axis and the plane's normal, 0 <= slant < 180; above 90 the image's
 * centre lies beyond the horizon. Tilt: the image direction in which the plane recedes, clockwise
 * from up (0 a floor, 90 recedes to the right, 180 a ceiling). Field of view: across the long side.
 * Threads. Different jobs may be used in different threads; one job is not thread-safe, except for
 * recede_job_cancel(). The same input gives the same bytes for any number of threads.
 * Errors. On any status but RECEDE_OK the output is unchanged and recede_job_message() tells why
 * and what to do. The library never prints, aborts, exits or changes the locale.
 */
#ifndef RECEDE_H
#define RECEDE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RECEDE_VERSION "0.1.0"

#if defined(__GNUC__)
#define RECEDE_API __attribute__((visibility("default")))
#else
#define RECEDE_API
#endif

typedef enum recede_status {
  RECEDE_OK = 0,
  RECEDE_CANCELLED,    /* recede_job_cancel() or a progress callback asked for it */
  RECEDE_ARGUMENT,     /* a parameter or a view is out of range */
  RECEDE_TOO_LARGE,    /* the estimate of memory exceeds the limit; nothing was done */
  RECEDE_NO_MEMORY,    /* an allocation failed */
  RECEDE_EMPTY_TARGET, /* the mask selects nothing to fill on the plane */
  RECEDE_EMPTY_SOURCE, /* nothing is left to copy from */
  RECEDE_NO_PLANE,     /* the orientation cannot be read from the picture or is degenerate */
  RECEDE_INTERNAL      /* a fault of ours */
} recede_status;

/* ---------------------------------------------------------------------------------- pixels -- */

typedef enum recede_type { RECEDE_U8, RECEDE_U16, RECEDE_HALF, RECEDE_FLOAT } recede_type;

/* Borrowed pixels, rows top to bottom, channels interleaved.
 * channels: 1 gray, 2 gray + alpha, 3 RGB, 4 RGB + alpha (alpha not premultiplied).
 * Integer types span 0..1; floats may be negative or above 1. Encoded as seen (sRGB-like), not
 * linear light: distances are taken between the values as they are. */
typedef struct recede_view {
  void *data;
  size_t stride_bytes;
  int width, height, channels;
  recede_type type;
} recede_view;

/* ----------------------------------------------------------------------------------- plane -- */

/* A plane seen by a pinhole camera whose axis passes the image's centre.
 * w(x, y) = normal . ((x - cx) / f, (y - cy) / f, 1),  cx = (width - 1) / 2, cy = (height - 1) / 2,
 * is proportional to 1 / depth: positive on the plane, 0 on the horizon, negative beyond it. */
typedef struct recede_plane {
  int width, height;
  double focal_px;
  double normal[3]; /* unit length; (0, 0, 1) is frontal */
} recede_plane;

/* ALL: RECEDE_ARGUMENT for a size below 1, or a value that is out of range or not finite. */

/* slant_deg in [0, 180), tilt_deg in [-180, 180], fov_deg in [1, 170]. */
RECEDE_API recede_status recede_plane_from_angles(int width, int height, double slant_deg,
                                                  double tilt_deg, double fov_deg,
                                                  recede_plane *plane);
/* The horizon through (x1, y1) and (x2, y2); (on_x, on_y) is any image point on the plane's side.
 * RECEDE_NO_PLANE when the two points coincide or the third lies on the line. */
RECEDE_API recede_status recede_plane_from_horizon(int width, int height, double fov_deg, double x1,
                                                   double y1, double x2, double y2, double on_x,
                                                   double on_y, recede_plane *plane);
/* quad = x1,y1 .. x4,y4 in order around it: the image of a parallelogram on the plane. With
 * right_angles nonzero it is the image of a rectangle, and the field of view follows from it where
 * both vanishing points are finite; else fov_deg is used.
 * RECEDE_NO_PLANE when the quad is not convex or has no area. */
RECEDE_API recede_status recede_plane_from_quad(int width, int height, double fov_deg,
                                                const double quad[8], int right_angles,
                                                recede_plane *plane);
RECEDE_API void recede_plane_angles(const recede_plane *plane, double *slant_deg, double *tilt_deg,
                                    double *fov_deg);
/* Two points of the horizon: the foot of the centre on it, one focal length to either side (tilt's
 * left to its right). Returns 0, and leaves ends alone, when there is none (slant 0). */
RECEDE_API int recede_plane_horizon(const recede_plane *plane, double ends[4]);
/* The image of a square on the plane around the image point (x, y), size_px wide there (across the
 * tilt, one side along it). Returns 0 when a corner would lie on or beyond the horizon. */
RECEDE_API int recede_plane_quad(const recede_plane *plane, double x, double y, double size_px,
                                 double quad[8]);
RECEDE_API double recede_plane_w(const recede_plane *plane, double x, double y);

typedef enum recede_scale_kind {
  RECEDE_SCALE_ACROSS, /* px per texel across the tilt: w / w0 */
  RECEDE_SCALE_ALONG,  /* along it: w^2 / w0 */
  RECEDE_SCALE_AREA,   /* w^3 / w0^2 */
  RECEDE_SCALE_PAPER   /* the paper's S(p), eqs 1-3 read correctly; slant < 90 only */
} recede_scale_kind;

/* Scale at (x, y) for a texel that is 1 px across the tilt at (ref_x, ref_y), where w = w0;
 * at slant < 90 with the centre as reference: across 1 - kq, along cos(slant) (1 - kq)^2, area
 * cos(slant) (1 - kq)^3 with k = tan(slant) / f. NaN on and beyond the horizon. The paper's map has
 * no reference and no horizon. */
RECEDE_API double recede_scale_at(const recede_plane *plane, recede_scale_kind kind, double ref_x,
                                  double ref_y, double x, double y);
/* Fills a RECEDE_FLOAT view of one channel, the size of the plane's image. */
RECEDE_API recede_status recede_scale_map(const recede_plane *plane, recede_scale_kind kind,
                                          double ref_x, double ref_y, const recede_view *out);

/* ------------------------------------------------------------------------------ parameters -- */

typedef enum recede_orientation_source {
  RECEDE_ORIENTATION_AUTO, /* estimated from the picture */
  RECEDE_ORIENTATION_ANGLES,
  RECEDE_ORIENTATION_FRONTAL,
  RECEDE_ORIENTATION_HORIZON,
  RECEDE_ORIENTATION_QUAD
} recede_orientation_source;
typedef enum recede_surface {
  RECEDE_SURFACE_FLAT,
  RECEDE_SURFACE_RAISED,
  RECEDE_SURFACE_AUTO
} recede_surface;
typedef enum recede_method {
  RECEDE_METHOD_PLANE,
  RECEDE_METHOD_PAPER,
  RECEDE_METHOD_KWATRA
} recede_method;
/* Of a synthesis by method plane. RECEDING: a picture of the plane by the result's camera, it
 * becomes the result's middle. FRONTAL: a picture of the texture from the front, it is laid onto
 * the plane, where that comes nearest one px across for each of its own. */
typedef enum recede_exemplar { RECEDE_EXEMPLAR_RECEDING, RECEDE_EXEMPLAR_FRONTAL } recede_exemplar;
typedef enum recede_quality {
  RECEDE_QUALITY_DRAFT,
  RECEDE_QUALITY_NORMAL,
  RECEDE_QUALITY_BEST
} recede_quality;

/* Every parameter; ranges, defaults and meaning stand in the one table, core/params.c.
 * Make it with recede_params_init(). */
typedef struct recede_params {
  size_t struct_size;
  recede_orientation_source orientation;
  double slant_deg, tilt_deg, fov_deg;
  double horizon[4]; /* x1, y1, x2, y2 px */
  double quad[8];    /* x1, y1 .. x4, y4 px */
  recede_surface surface;
  recede_method method;
  recede_quality quality;
  int64_t seed;
  recede_exemplar exemplar;
  int paper_literal; /* 1: the paper as printed; 0: repaired (docs in core/synthesis/paper) */
  /* Developers' parameters: 0 switches a stage off or, where the table says so, means "by
   * quality". */
  int paper_levels;            /* pyramid levels; 0: by paper_literal */
  int paper_width;             /* neighbourhood at the finest level, px; 0: by paper_literal */
  int paper_width_coarse;      /* and at the coarser ones */
  int paper_coherence;         /* -1: by paper_literal */
  int paper_scale_in_pca;      /* -1: by paper_literal */
  double paper_histogram_gain; /* eq. 9's sum times this; -1: by paper_literal */
  double paper_exponent;       /* r of eq. 5 */
  int paper_iterations;        /* of one sweep, at most; 0: by method */
  int engine_near, engine_tone, engine_alike, engine_periods, engine_lattice, engine_regular,
      engine_joints, engine_lines, engine_branches, engine_rails, engine_gauge, engine_spots,
      engine_kin, engine_focus, engine_light, engine_layers, engine_boundary, engine_regions,
      engine_tracks, engine_dashes, engine_standing, engine_texture, engine_whole, engine_cuts,
      engine_coherence, engine_beside, engine_steps, engine_usage, engine_confidence,
      engine_composition, engine_join, engine_detail,
      engine_spline;     /* stages of the plane engine, 1 = on */
  int engine_starts;     /* trials of the coarsest level; 0: by quality */
  int engine_iterations; /* EM iterations at the coarsest level; 0: by quality */
} recede_params;

typedef enum recede_param_type {
  RECEDE_PARAM_DOUBLE,
  RECEDE_PARAM_INT,
  RECEDE_PARAM_CHOICE,
  RECEDE_PARAM_POINTS /* numbers separated by commas, count of them */
} recede_param_type;

typedef enum recede_param_flags {
  RECEDE_PARAM_COMMAND = 1,   /* an option of the command */
  RECEDE_PARAM_HOST = 2,      /* an argument of the GIMP procedures, in the table's order */
  RECEDE_PARAM_DEVELOPER = 4, /* reachable as "key=value" only */
  RECEDE_PARAM_SYNTHESIS = 8  /* says something of a synthesis alone */
} recede_param_flags;

typedef struct recede_param_info {
  const char *key;   /* "slant" */
  const char *label; /* "_Slant": for a dialog; to be translated */
  const char *help;  /* one sentence; to be translated */
  const char *unit;  /* "°", "px" or "" */
  recede_param_type type;
  double minimum, maximum, default_value; /* for a choice: its index */
  const char *const *choices;             /* NULL-terminated nicks, or NULL */
  const char *const *choice_labels;       /* to be translated */
  unsigned flags;
  int count;     /* numbers it holds: 1, POINTS more */
  size_t offset; /* in recede_params: double, int or int64_t (seed), the enum, double[count] */
} recede_param_info;

/* The table, read-only, *count rows. */
RECEDE_API const recede_param_info *recede_param_table(size_t *count);
RECEDE_API void recede_params_init(recede_params *params);
/* Reads and writes one parameter as locale-independent text ("0.5", "flat"). set: RECEDE_ARGUMENT
 * with a sentence in message for an unknown key, a value that does not parse, is not finite or is
 * out of range; params unchanged. get: the length that text needs, as snprintf; negative for an
 * unknown key. */
RECEDE_API recede_status recede_params_set(recede_params *params, const char *key,
                                           const char *value, char *message, size_t message_size);
RECEDE_API int recede_params_get(const recede_params *params, const char *key, char *text,
                                 size_t text_size);

/* ------------------------------------------------------------------------------------- job -- */

typedef struct recede_host {
  size_t struct_size;
  int threads;           /* 0 = all; clamped to 1..64 */
  uint64_t memory_bytes; /* limit of the core's memory; 0 = three quarters of what there is */
  /* Called from the thread that called run, several times a second. stage is a fixed English name,
   * fraction runs 0..1 over the whole run. Nonzero cancels. */
  int (*progress)(void *user, const char *stage, double fraction);
  void *user;
  uint64_t fail_allocation; /* tests: the n-th allocation fails; 0 = none */
  int kernel;               /* tests: -1 the best for this machine, else see core/kernels */
} recede_host;

typedef struct recede_orientation {
  double slant_deg, tilt_deg, fov_deg;
  double horizon[4]; /* two points, px of the whole image; NaN when there is none */
  double confidence; /* 0..1; below RECEDE_CONFIDENCE_LOW do not trust it. 1 when given */
  int estimated;     /* 1: read from the picture */
  recede_plane plane;
} recede_orientation;

#define RECEDE_CONFIDENCE_LOW 0.5

#define RECEDE_MAX_STAGES 24

typedef struct recede_report {
  recede_orientation orientation;
  recede_method method;
  recede_surface surface; /* the one used: FLAT or RAISED; methods paper and kwatra: as asked for */
  int64_t seed;
  int threads;
  int stage_count;
  struct {
    const char *name;
    double seconds;
  } stages[RECEDE_MAX_STAGES];
  uint64_t estimated_bytes, peak_bytes;
  uint64_t output_hash;      /* of the result's pixel values, the same on every machine */
  uint64_t filled_pixels;    /* target pixels that were filled */
  uint64_t refused_pixels;   /* target pixels on or beyond the horizon: left as they were */
  uint64_t magnified_pixels; /* filled from a source of less than .8 of the resolution needed */
  double largest_magnification;
  uint64_t nonfinite_pixels; /* NaN, infinite or beyond +-1e9: never a source */
  double energy;             /* methods paper and kwatra: the last energy, eq. 8 */
  int iterations;
  char warning[512]; /* "" or sentences to show the user, English */
} recede_report;

typedef struct recede_job recede_job;

RECEDE_API void recede_host_init(recede_host *host);
/* NULL host = defaults. NULL when there is no memory. */
RECEDE_API recede_job *recede_job_new(const recede_host *host);
/* The views stay the caller's and must live until the job is freed or another is set.
 * mask and source: one channel, the image's size; the mask's value is how much of the fill is
 * blended in (any value above 0 is filled and never a source); source above one half may be copied
 * from; source NULL = everything. Method plane copies from what is near, while that is enough. */
RECEDE_API recede_status recede_job_set_image(recede_job *job, const recede_view *image);
RECEDE_API recede_status recede_job_set_mask(recede_job *job, const recede_view *mask);
RECEDE_API recede_status recede_job_set_source(recede_job *job, const recede_view *source);
RECEDE_API recede_status recede_job_set_params(recede_job *job, const recede_params *params);
/* The orientation that the job's parameters ask for: converted, or estimated from the picture
 * (RECEDE_ORIENTATION_AUTO; only pixels outside the mask are looked at, and first only those inside
 * the source, which is taken to lie on the plane, all of it, if it has less than 70 % of them; then
 * the others are asked, too, unless it is sure, and believed where they are far surer). */
RECEDE_API recede_status recede_job_orient(recede_job *job, recede_orientation *orientation);
/* What fill (or synthesize, to a width and height) would take: memory in bytes, at the most; time
 * in seconds, roughly, by method plane at normal quality. Of the pixels only the masks' are read.
 * Both are told on RECEDE_TOO_LARGE, too. */
RECEDE_API recede_status recede_job_estimate_fill(recede_job *job, uint64_t *bytes,
                                                  double *seconds);
RECEDE_API recede_status recede_job_estimate_synthesize(recede_job *job, int width, int height,
                                                        uint64_t *bytes, double *seconds);
/* result: size, channels and type of the image; may be the image's own memory. Outside the mask it
 * receives the image's pixels bit for bit. Filled pixels become opaque. */
RECEDE_API recede_status recede_job_fill(recede_job *job, const recede_view *result);
/* The image is the exemplar; result has its channels and type and any size. The orientation is the
 * result's (methods paper and kwatra: the exemplar's). What lies beyond the horizon becomes 0,
 * transparent where there is alpha. RECEDE_ARGUMENT for a frontal exemplar without an orientation,
 * or with another method than plane. */
RECEDE_API recede_status recede_job_synthesize(recede_job *job, const recede_view *result);
/* Of the last run. */
RECEDE_API const recede_report *recede_job_report(const recede_job *job);
/* Why the last call failed and what to do, English, one line; "" after RECEDE_OK. */
RECEDE_API const char *recede_job_message(const recede_job *job);
/* Makes a running call return RECEDE_CANCELLED soon, or the next one where none is running. Safe
 * from other threads and signal handlers. */
RECEDE_API void recede_job_cancel(recede_job *job);
RECEDE_API void recede_job_free(recede_job **job);

#ifdef __cplusplus
}
#endif
#endif
