/* What the preview shows, in words. */
#include "legend.h"

#include "intl.h"

const char *rp_legend(const rp_scene *scene) {
  if (scene->show == RP_SHOW_SCALE)
    return _("Blue: the texture gets smaller; orange: larger than in the selection; red: it "
             "would have to be magnified; grey: beyond the horizon.");
  if (rp_scene_is_laid(scene) && scene->draft.pixels)
    return _("The new image, as a draft. Drag the horizon, its handles or the grid to tilt it.");
  if (scene->show == RP_SHOW_DRAFT && scene->draft.pixels)
    return _("Draft: the real fill at the preview's size.");
  if (rp_scene_is_beyond(scene))
    return _("The picture lies beyond the horizon of this plane, so nothing can be filled. Choose "
             "a smaller slant.");
  return _("Drag the horizon, its handles or the grid to lay the plane on the picture.");
}
