/* scene.h - what the preview draws: the photo, and the plane that the user is to judge by eye.
 *
 * Cairo only, no toolkit. Coordinates are the proxy's pixels; rp_scene_draw() fits them into a
 * widget with a margin, so that a horizon a little outside the picture can be seen and dragged. */
#ifndef RP_SCENE_H
#define RP_SCENE_H

#include <cairo.h>

#include "proxy.h"

typedef enum { RP_SHOW_GRID, RP_SHOW_SCALE, RP_SHOW_DRAFT } rp_show;

typedef enum {
  RP_GRAB_NOTHING,
  RP_GRAB_PLANE,
  RP_GRAB_HORIZON,
  RP_GRAB_LEFT,
  RP_GRAB_RIGHT
} rp_grab;

/* What seldom changes, and its copy at the widget's size: scaling is what drawing costs most. */
typedef struct {
  cairo_surface_t *pixels, *fitted; /* NULL: not there yet */
  double zoom;                      /* of fitted */
} rp_layer;

typedef struct {
  rp_proxy proxy;
  /* A texture seen from the front: the proxy is the new image's, blank, and the draft, which is
   * always shown then, has this laid onto the plane. All 0: there is none. */
  rp_proxy texture;
  int new_width, new_height; /* of the new image; 0 when nothing is laid */
  double centre_x, centre_y; /* of the hole: the grid lies around it */
  recede_plane plane;        /* of the proxy's image */
  rp_show show;
  rp_layer photo, outline, draft;
  cairo_surface_t *shade; /* NULL: nothing to shade */
  gboolean shade_is_old;
} rp_scene;

typedef struct {
  double x, y, zoom; /* widget = (x, y) + zoom * proxy */
} rp_fit;

/* Of a fill: the picture with its hole. Of a texture: the picture that it is, whose selected part
 * is copied from; or, when it is to be laid, the new image. FALSE: no memory. */
gboolean rp_scene_new(const rp_settings *settings, const rp_picture *picture, rp_scene *scene);
gboolean rp_scene_is_laid(const rp_scene *scene);
/* It is still what these settings ask for: laid or not, and as large. */
gboolean rp_scene_is_of(const rp_scene *scene, const rp_settings *settings);
void rp_scene_clear(rp_scene *scene);
/* FALSE, and the scene stays as it is: these angles make no plane. */
gboolean rp_scene_set_angles(rp_scene *scene, double slant_deg, double tilt_deg, double fov_deg);
/* Nothing of the plane is in sight: the picture lies beyond the horizon. */
gboolean rp_scene_is_beyond(const rp_scene *scene);
/* Angles that put a horizon in sight above the hole, for the user to drag from there; FALSE: one is
 * in sight already. */
gboolean rp_scene_first_guess(const rp_scene *scene, double *slant_deg, double *tilt_deg);
void rp_scene_set_source(rp_scene *scene, const rp_picture *picture);
/* pixels: R'G'B'A, the proxy's size; NULL: none. */
void rp_scene_set_draft(rp_scene *scene, const guchar *pixels);

rp_fit rp_scene_fit(const rp_scene *scene, int width, int height);
void rp_scene_draw(rp_scene *scene, cairo_t *cairo, int width, int height);

/* What lies at a point of the proxy; reach in proxy pixels. */
rp_grab rp_scene_grab(const rp_scene *scene, double x, double y, double reach);
/* The angles after dragging from one point to another; start is the plane when the button went
 * down. FALSE: that makes no plane. */
gboolean rp_scene_drag(const rp_scene *scene, rp_grab grab, const recede_plane *start,
                       const double from[2], const double to[2], double *slant_deg,
                       double *tilt_deg);

#endif
