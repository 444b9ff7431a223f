/* What the user reads. The core speaks English; here stands what is to be translated. */
#include "messages.h"

#include <math.h>
#include <string.h>

#include "intl.h"
#include "pixels.h"

const char *rp_target_refusal(const rp_target *target, gboolean writes, gboolean new_layer) {
  if (target->elsewhere)
    return _(
        "The layer belongs to another image than the one given. Give the image that it is in.");
  if (target->group)
    return _("A layer group has no pixels of its own. Select one layer inside the group.");
  if (target->indexed)
    return _("The image is indexed: the fill needs colours that its palette lacks. Change it with "
             "Image > Mode > RGB first.");
  if (target->floating)
    return _("A floating selection cannot be filled. Anchor it first: Layer > Anchor Layer.");
  if (new_layer && !target->is_layer)
    return _("A channel or layer mask can only be filled in place: put the fill into it, not into "
             "a new layer.");
  if (new_layer && target->filtered)
    return _("The layer has filters, which a new layer would lack. Merge them first, in the menu "
             "of the layer's fx icon in the Layers dialog, or fill into this layer.");
  if (!writes || new_layer) return NULL;
  if (target->text)
    return _("This is a text layer. Choose Layer > Discard Text Information first, or fill into a "
             "new layer.");
  if (target->locked)
    return _(
        "The pixels of the layer, or of a group around it, are locked. Unlock them in the Layers "
        "dialog, or fill into a new layer.");
  return NULL;
}

const char *rp_layer_gone(void) {
  return _("The layer is gone: it was deleted, or its image was closed. There is nothing to fill.");
}

const char *rp_no_selection(void) {
  return _("Nothing is selected. Select what is to be filled, for instance with the free select "
           "tool, and start again.");
}

const char *rp_selection_outside(void) {
  return _("The selection lies outside the layer. Select the layer it belongs to, or enlarge the "
           "layer with Layer > Layer to Image Size.");
}

const char *rp_one_layer_only(void) {
  return _("Several layers are selected. Select exactly one and start again.");
}

const char *rp_no_memory(void) {
  return _("There is not enough memory for this picture. Close other images or scale it down.");
}

const char *rp_not_taken(void) {
  return _("GIMP did not let the layer be changed, and nothing was written. See whether it is "
           "locked, and start again.");
}

static const struct {
  const char *stage, *label;
} stages[] = {
    {"prepare", N_("Preparing")},
    {"orientation", N_("Reading the orientation")},
    {"tone", N_("Evening out the light")},
    {"pyramid", N_("Making smaller copies")},
    {"scale map", N_("Measuring the scale")},
    {"start", N_("Making a first guess")},
    {"search", N_("Searching for texture")},
    {"composition", N_("Putting pieces together")},
    {"join", N_("Hiding the seams")},
    {"detail", N_("Matching the detail")},
    {"write", N_("Writing")},
};

const char *rp_title(const rp_request *request) {
  return request->run == RP_RUN_SYNTHESIZE ? _("Perspective Texture") : _("Perspective Fill");
}

const char *rp_stage_label(const char *stage) {
  for (gsize i = 0; i < G_N_ELEMENTS(stages); i++)
    if (strcmp(stages[i].stage, stage) == 0) return _(stages[i].label);
  return _("Filling");
}

static char *empty_source(const rp_request *request) {
  if (request->run == RP_RUN_SYNTHESIZE)
    return g_strdup(_("Too little of the texture is selected, or opaque, to copy from. Select "
                      "more."));
  const recede_view *mask = &request->mask;
  gsize left = 0;
  for (int y = 0; y < mask->height; y++)
    for (int x = 0; x < mask->width; x++) left += !(rp_mask_value(mask, x, y) > 0);
  if (left == 0 && !request->source.data)
    return g_strdup(
        _("The selection covers all of the layer that is selected, so nothing of it is left "
          "to copy from. Select the layer that is to be filled, select less, or choose "
          "another source."));
  return g_strdup(_("Nothing is left to copy from. Select less, or choose another source."));
}

static char *wrong_arguments(const rp_request *request) {
  const recede_params *params = &request->params;
  gboolean laid = request->run == RP_RUN_SYNTHESIZE && params->exemplar == RECEDE_EXEMPLAR_FRONTAL;
  if (laid && params->orientation == RECEDE_ORIENTATION_AUTO)
    return g_strdup(_("A texture seen from the front does not tell how the plane lies. Set slant "
                      "and tilt."));
  if (laid && params->method != RECEDE_METHOD_PLANE)
    return g_strdup(_("This method needs a texture seen in perspective. Choose the one that copies "
                      "within the plane, or another view of the texture."));
  return g_strdup(request->message);
}

char *rp_failure(const rp_request *request) {
  switch (request->status) {
    case RECEDE_NO_MEMORY: return g_strdup(rp_no_memory());
    case RECEDE_EMPTY_TARGET:
      return g_strdup(_("Nothing of the selection lies on the plane: it is all beyond the horizon. "
                        "Check the horizon in the preview, or change slant and tilt."));
    case RECEDE_ARGUMENT: return wrong_arguments(request);
    case RECEDE_EMPTY_SOURCE: return empty_source(request);
    case RECEDE_NO_PLANE:
      if (request->params.orientation != RECEDE_ORIENTATION_AUTO)
        return g_strdup(_("The new image lies beyond the horizon of this plane. Choose a smaller "
                          "slant."));
      return g_strdup(_("The orientation of the plane could not be read from the picture. Set "
                        "slant and tilt."));
    case RECEDE_TOO_LARGE:
      return g_strdup_printf(_("This needs more memory than there is (%.0f MiB). Select less or "
                               "scale the picture down."),
                             ceil((double)request->report.estimated_bytes / (1 << 20)));
    default: return g_strdup(request->message[0] ? request->message : _("An unknown fault."));
  }
}

/* A few magnified pixels in a hundred are never seen. */
#define WORTH_TELLING 50

static void add_sentence(GString *text, char *sentence) {
  if (text->len) g_string_append_c(text, ' ');
  g_string_append(text, sentence);
  g_free(sentence);
}

char *rp_warning(const rp_request *request) {
  const recede_report *report = &request->report;
  GString *text = g_string_new(NULL);
  if (report->orientation.estimated && report->orientation.confidence < RECEDE_CONFIDENCE_LOW)
    add_sentence(text, g_strdup(_("The orientation could not be read from the picture with "
                                  "confidence; it was filled without perspective. Set slant and "
                                  "tilt.")));
  if (report->refused_pixels > 0 && request->run == RP_RUN_SYNTHESIZE)
    add_sentence(text, g_strdup_printf(_("%.0f pixels lie beyond the horizon and are empty."),
                                       (double)report->refused_pixels));
  else if (report->refused_pixels > 0)
    add_sentence(text, g_strdup_printf(_("%.0f selected pixels lie beyond the horizon and were "
                                         "left as they are."),
                                       (double)report->refused_pixels));
  if (report->magnified_pixels * WORTH_TELLING > report->filled_pixels)
    add_sentence(text,
                 g_strdup_printf(_("%.0f pixels had to be magnified (up to %.1f times), for "
                                   "lack of nearer texture; they may look soft."),
                                 (double)report->magnified_pixels, report->largest_magnification));
  if (report->nonfinite_pixels > 0)
    add_sentence(text, g_strdup_printf(_("%.0f pixels are not numbers and were not copied from."),
                                       (double)report->nonfinite_pixels));
  return text->len ? g_string_free(text, FALSE) : (g_string_free(text, TRUE), NULL);
}
