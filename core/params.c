/* The one table of parameters: the command's options, the GIMP procedures' arguments, the dialog's
 * widgets and the JSON are made from it; the man page is held against it. */
#include <errno.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "recede.h"

#define N_(text) text

static const char *const orientations[] = {"auto", "angles", "frontal", "horizon", "quad", NULL};
static const char *const orientation_labels[] = {N_("Estimate from the picture"),
                                                 N_("Slant and tilt"),
                                                 N_("Frontal (no perspective)"),
                                                 N_("Horizon line"),
                                                 N_("Four points"),
                                                 NULL};
static const char *const surfaces[] = {"flat", "raised", "auto", NULL};
static const char *const surface_labels[] = {N_("Flat pattern (tiles, planks, markings)"),
                                             N_("Raised (stones, grass, waves)"),
                                             N_("Choose by the picture"), NULL};
static const char *const methods[] = {"plane", "paper", "kwatra", NULL};
static const char *const method_labels[] = {N_("Copies within the plane"),
                                            N_("Scale-guided optimization (2014 paper)"),
                                            N_("Texture optimization (baseline)"), NULL};
static const char *const exemplars[] = {"receding", "frontal", NULL};
static const char *const exemplar_labels[] = {N_("In perspective, as the new image shows it"),
                                              N_("From the front"), NULL};
static const char *const qualities[] = {"draft", "normal", "best", NULL};
static const char *const quality_labels[] = {N_("Draft"), N_("Normal"), N_("Best"), NULL};

#define COMMON (RECEDE_PARAM_COMMAND | RECEDE_PARAM_HOST)
#define AT(field) offsetof(recede_params, field)
#define CHOICE(key, field, label, help, first, nicks, labels, flags)                              \
  {                                                                                               \
    key, label, help, "", RECEDE_PARAM_CHOICE, 0, sizeof nicks / sizeof *nicks - 2, first, nicks, \
        labels, flags, 1, AT(field)                                                               \
  }
#define DOUBLE(key, field, label, help, unit, low, high, value, flags) \
  { key, label, help, unit, RECEDE_PARAM_DOUBLE, low, high, value, NULL, NULL, flags, 1, AT(field) }
#define INT(key, field, label, help, low, high, value, flags) \
  { key, label, help, "", RECEDE_PARAM_INT, low, high, value, NULL, NULL, flags, 1, AT(field) }
#define POINTS(key, field, label, help, n)                                                       \
  {                                                                                              \
    key, label, help, "px", RECEDE_PARAM_POINTS, -1e7, 1e7, 0, NULL, NULL, RECEDE_PARAM_COMMAND, \
        n, AT(field)                                                                             \
  }
#define STAGE(key, field, help) INT(key, field, "", help, 0, 1, 1, RECEDE_PARAM_DEVELOPER)

static const recede_param_info table[] = {
    CHOICE("orientation", orientation, N_("Orientat_ion"),
           N_("Where the orientation of the plane comes from"), 0, orientations, orientation_labels,
           COMMON),
    DOUBLE("slant", slant_deg, N_("Sl_ant"),
           N_("Angle between the view axis and the plane's normal: 0 is seen from the front; above "
              "90 the image's centre lies beyond the horizon"),
           "°", 0, 179.9, 45, COMMON),
    DOUBLE(
        "tilt", tilt_deg, N_("_Tilt"),
        N_("Direction in which the plane recedes, clockwise from up: 0 a floor, 90 to the right"),
        "°", -180, 180, 0, COMMON),
    DOUBLE("fov", fov_deg, N_("_Field of view"),
           N_("Field of view of the picture's long side; it matters little"), "°", 1, 170, 50,
           COMMON),
    CHOICE("surface", surface, N_("S_urface"),
           N_("Whether the texture is painted on the plane or stands up from it"), 2, surfaces,
           surface_labels, COMMON),
    CHOICE("method", method, N_("_Method"), N_("How the region is filled"), 0, methods,
           method_labels, COMMON),
    CHOICE("quality", quality, N_("_Quality"),
           N_("Draft is for previews; best leads seams between stones or leaves in finer "
              "detail, too, and takes longer"),
           1, qualities, quality_labels, COMMON),
    INT("seed", seed, N_("See_d"), N_("Another seed gives another fill"), 0, 2147483647, 0, COMMON),
    CHOICE("exemplar", exemplar, N_("Te_xture is seen"),
           N_("Whether the exemplar shows the plane receding, as the result does, or from the "
              "front, to be laid onto it"),
           0, exemplars, exemplar_labels, COMMON | RECEDE_PARAM_SYNTHESIS),
    POINTS("horizon", horizon, N_("Horizon"), N_("Two points of the horizon: X1,Y1,X2,Y2"), 4),
    POINTS("quad", quad, N_("Quad"),
           N_("Four corners of a rectangle on the plane: X1,Y1,X2,Y2,X3,Y3,X4,Y4"), 8),
    INT("paper-literal", paper_literal, "", N_("Method paper as printed, without the repairs"), 0,
        1, 0, RECEDE_PARAM_COMMAND),
    INT("paper-levels", paper_levels, "",
        "pyramid levels; 0: 3 literal, 4 repaired, a repaired fill by its hole", 0, 8, 0,
        RECEDE_PARAM_DEVELOPER),
    INT("paper-width", paper_width, "", "neighbourhood at the finest level, px; 0: 8", 0, 32, 0,
        RECEDE_PARAM_DEVELOPER),
    INT("paper-width-coarse", paper_width_coarse, "",
        "neighbourhood before the last sweep, px; 0: 8 literal, 16 repaired", 0, 64, 0,
        RECEDE_PARAM_DEVELOPER),
    INT("paper-coherence", paper_coherence, "", "try the neighbours' matches; -1: not literal", -1,
        1, -1, RECEDE_PARAM_DEVELOPER),
    INT("paper-scale-in-pca", paper_scale_in_pca, "", "S inside the PCA vector; -1: literal", -1, 1,
        -1, RECEDE_PARAM_DEVELOPER),
    DOUBLE("paper-histogram-gain", paper_histogram_gain, "",
           "factor of eq. 9's sum; -1: 1 literal, 10 repaired", "", -1, 1000, -1,
           RECEDE_PARAM_DEVELOPER),
    DOUBLE("paper-exponent", paper_exponent, "", "r of eq. 5", "", .1, 2, .8,
           RECEDE_PARAM_DEVELOPER),
    INT("paper-iterations", paper_iterations, "", "of one sweep, at most; 0: by method", 0, 1000, 0,
        RECEDE_PARAM_DEVELOPER),
    STAGE("engine-tone", engine_tone,
          "search and copy without the brightness that drifts across the picture"),
    STAGE("engine-near", engine_near, "copy only from around the hole"),
    STAGE("engine-alike", engine_alike, "copy only what looks like something beside the hole"),
    STAGE("engine-spots", engine_spots,
          "copy nothing that stands out, by contrast or colour, more than all near the hole"),
    STAGE("engine-kin", engine_kin,
          "copy into each part of the hole what looks like something beside it nearby"),
    STAGE("engine-focus", engine_focus, "copy what is as sharp as what lies around"),
    STAGE("engine-light", engine_light,
          "copy what lies in the same light, or nearly, where no plane recedes"),
    STAGE("engine-layers", engine_layers,
          "copy what lies as high in the picture, or nearly, where no plane recedes"),
    STAGE("engine-periods", engine_periods, "candidates at the texture's periods"),
    STAGE("engine-lattice", engine_lattice,
          "copy what repeats both ways by whole periods, bent as it lies"),
    STAGE("engine-regular", engine_regular,
          "of what comes again both ways, or in a row, copy anything by whole periods"),
    STAGE("engine-joints", engine_joints, "and what does so by its joints alone"),
    STAGE("engine-lines", engine_lines, "continue straight lines that cross the hole"),
    STAGE("engine-branches", engine_branches,
          "and those that end in it, at one of these or at each other"),
    STAGE("engine-rails", engine_rails,
          "copy boards and what else runs along its lines along them"),
    STAGE("engine-gauge", engine_gauge, "and from other rows where boards have one width"),
    STAGE("engine-boundary", engine_boundary,
          "keep two textures to their sides of the straight line where they meet"),
    STAGE("engine-regions", engine_regions,
          "keep two textures to their sides where they meet in another way"),
    STAGE("engine-tracks", engine_tracks,
          "lead faint bands of tone that run along the plane through the hole"),
    STAGE("engine-dashes", engine_dashes, "continue rows of dashes, and copy them nowhere else"),
    STAGE("engine-standing", engine_standing,
          "copy near the horizon upright where things stand there"),
    STAGE("engine-texture", engine_texture,
          "coarse levels compare the finer detail too, by strength and direction"),
    STAGE("engine-whole", engine_whole, "few whole copies start what lines cross (boards always)"),
    STAGE("engine-cuts", engine_cuts, "lead seams where the copies on both sides look alike"),
    STAGE("engine-coherence", engine_coherence, "a price on neighbours with other displacements"),
    STAGE("engine-beside", engine_beside,
          "copy near the horizon what lies beside the hole, as far away"),
    STAGE("engine-steps", engine_steps,
          "fill what is too far away for any source from what is filled by then"),
    STAGE("engine-usage", engine_usage, "a price on taking the same source often"),
    STAGE("engine-confidence", engine_confidence, "pixels count less the deeper in the hole"),
    STAGE("engine-composition", engine_composition, "compose whole copies instead of votes"),
    STAGE("engine-join", engine_join, "screened Poisson join of the copies"),
    STAGE("engine-detail", engine_detail, "match the detail's strength to known pixels"),
    STAGE("engine-spline", engine_spline, "sample by cubic B-spline instead of bilinear"),
    INT("engine-starts", engine_starts, "",
        "starts of the coarsest level, of which the best is kept; 0: by quality", 0, 64, 0,
        RECEDE_PARAM_DEVELOPER),
    INT("engine-iterations", engine_iterations, "",
        "iterations at the coarsest level; 0: by quality", 0, 100, 0, RECEDE_PARAM_DEVELOPER),
};
#define ROWS (sizeof table / sizeof *table)

const recede_param_info *recede_param_table(size_t *count) {
  *count = ROWS;
  return table;
}

static const recede_param_info *find(const char *key) {
  for (size_t i = 0; i < ROWS; i++)
    if (strcmp(table[i].key, key) == 0) return &table[i];
  return NULL;
}

static void *field(recede_params *params, const recede_param_info *row) {
  return (char *)params + row->offset;
}

static void store(recede_params *params, const recede_param_info *row, double value) {
  switch (row->type) {
    case RECEDE_PARAM_DOUBLE: *(double *)field(params, row) = value; break;
    case RECEDE_PARAM_INT:
      if (row->offset == AT(seed))
        params->seed = (int64_t)value;
      else
        *(int *)field(params, row) = (int)value;
      break;
    case RECEDE_PARAM_CHOICE: {
      unsigned index = (unsigned)value; /* every enum here starts at 0 and has int's size */
      memcpy(field(params, row), &index, sizeof index);
      break;
    }
    case RECEDE_PARAM_POINTS:
      for (int i = 0; i < row->count; i++) ((double *)field(params, row))[i] = value;
      break;
  }
}

void recede_params_init(recede_params *params) {
  memset(params, 0, sizeof *params);
  params->struct_size = sizeof *params;
  for (size_t i = 0; i < ROWS; i++) store(params, &table[i], table[i].default_value);
}

/* strtod and printf must see the C locale; only this thread's is changed, and put back. */
static locale_t enter_c_locale(locale_t *old) {
  locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  if (c) *old = uselocale(c);
  return c;
}
static void leave_c_locale(locale_t c, locale_t old) {
  if (!c) return;
  uselocale(old);
  freelocale(c);
}

static recede_status refuse(char *message, size_t size, const recede_param_info *row,
                            const char *value) {
  if (!message) return RECEDE_ARGUMENT;
  if (row->type == RECEDE_PARAM_CHOICE) {
    int used = snprintf(message, size, "%s: '%s' is not one of", row->key, value);
    for (int i = 0; row->choices[i] && used > 0 && (size_t)used < size; i++)
      used += snprintf(message + used, size - (size_t)used, "%s %s", i ? "," : "", row->choices[i]);
  } else if (row->type == RECEDE_PARAM_POINTS) {
    snprintf(message, size, "%s: '%s' is not %d numbers separated by commas, each within %g..%g",
             row->key, value, row->count, row->minimum, row->maximum);
  } else {
    snprintf(message, size, "%s: '%s' is not %s within %.15g..%.15g", row->key, value,
             row->type == RECEDE_PARAM_INT ? "a whole number" : "a number", row->minimum,
             row->maximum);
  }
  return RECEDE_ARGUMENT;
}

/* Also strtod's blanks, hexadecimals and names are no numbers here. */
static const char number_signs[] = "+-.0123456789eE";

static int parse_numbers(const recede_param_info *row, const char *value, double *numbers) {
  for (int i = 0; i < row->count; i++) {
    char *end;
    numbers[i] = strtod(value, &end);
    if (end == value || end > value + strspn(value, number_signs)) return 0;
    if (!(numbers[i] >= row->minimum && numbers[i] <= row->maximum)) return 0;
    if (row->type == RECEDE_PARAM_INT && numbers[i] != floor(numbers[i])) return 0;
    if (*end != (i + 1 < row->count ? ',' : '\0')) return 0;
    value = end + 1;
  }
  return 1;
}

static recede_status set_row(recede_params *params, const recede_param_info *row, const char *value,
                             char *message, size_t size) {
  double numbers[8];
  if (row->type == RECEDE_PARAM_CHOICE) {
    for (int i = 0; row->choices[i]; i++)
      if (strcmp(row->choices[i], value) == 0) return store(params, row, i), RECEDE_OK;
    return refuse(message, size, row, value);
  }
  if (!parse_numbers(row, value, numbers)) return refuse(message, size, row, value);
  if (row->type == RECEDE_PARAM_POINTS)
    memcpy(field(params, row), numbers, (size_t)row->count * sizeof *numbers);
  else
    store(params, row, numbers[0]);
  return RECEDE_OK;
}

recede_status recede_params_set(recede_params *params, const char *key, const char *value,
                                char *message, size_t message_size) {
  const recede_param_info *row = find(key);
  if (!row) {
    if (message) snprintf(message, message_size, "there is no parameter '%s'", key);
    return RECEDE_ARGUMENT;
  }
  locale_t old = (locale_t)0, c = enter_c_locale(&old);
  recede_status status = set_row(params, row, value, message, message_size);
  leave_c_locale(c, old);
  return status;
}

static int get_row(const recede_params *params, const recede_param_info *row, char *text,
                   size_t size) {
  const char *at = (const char *)params + row->offset;
  unsigned choice;
  int used = 0;
  switch (row->type) {
    case RECEDE_PARAM_CHOICE:
      memcpy(&choice, at, sizeof choice);
      return snprintf(text, size, "%s", choice <= row->maximum ? row->choices[choice] : "?");
    case RECEDE_PARAM_INT:
      return snprintf(text, size, "%lld",
                      row->offset == AT(seed) ? (long long)params->seed
                                              : (long long)*(const int *)(const void *)at);
    default:
      for (int i = 0; i < row->count; i++)
        used += snprintf(used < (int)size ? text + used : NULL,
                         used < (int)size ? size - (size_t)used : 0, i ? ",%.17g" : "%.17g",
                         ((const double *)(const void *)at)[i]);
      return used;
  }
}

int recede_params_get(const recede_params *params, const char *key, char *text, size_t text_size) {
  const recede_param_info *row = find(key);
  if (!row) return -1;
  locale_t old = (locale_t)0, c = enter_c_locale(&old);
  int length = get_row(params, row, text, text_size);
  leave_c_locale(c, old);
  return length;
}
