/* The preview's state and its handles. */
#include "scene.h"

#include <math.h>
#include <string.h>

#include "grid.h"
#include "surface.h"

#define PROXY_LONGEST_PX 720

static void clear_layer(rp_layer *layer) {
  g_clear_pointer(&layer->pixels, cairo_surface_destroy);
  g_clear_pointer(&layer->fitted, cairo_surface_destroy);
}

/* What was read as the mask is where the texture is copied from; nothing is filled. */
static void make_exemplar(rp_proxy *proxy) {
  proxy->source = proxy->mask;
  proxy->mask = g_malloc0((gsize)proxy->width * (gsize)proxy->height);
  rp_proxy_find_ends(proxy);
}

static gboolean new_laid(const rp_settings *settings, const rp_picture *picture, rp_scene *scene) {
  scene->new_width = (int)rp_settings_get(settings, "width");
  scene->new_height = (int)rp_settings_get(settings, "height");
  if (!rp_proxy_new_blank(scene->new_width, scene->new_height, PROXY_LONGEST_PX, &scene->proxy))
    return FALSE;
  int longest = MAX(picture->area.width, picture->area.height);
  int shrunk = MAX(1, (int)lround(longest / scene->proxy.shrink));
  if (!rp_proxy_new(picture, shrunk, &scene->texture)) {
    rp_proxy_clear(&scene->proxy);
    return FALSE;
  }
  if (picture->mask.view.data) make_exemplar(&scene->texture);
  return TRUE;
}

static gboolean new_seen(const rp_settings *settings, const rp_picture *picture, rp_scene *scene) {
  rp_proxy *proxy = &scene->proxy;
  if (!rp_proxy_new(picture, PROXY_LONGEST_PX, proxy)) return FALSE;
  rp_proxy_centre(proxy, &scene->centre_x, &scene->centre_y);
  scene->photo.pixels = rp_surface_of_pixels(proxy->rgba, proxy->width, proxy->height);
  scene->outline.pixels = rp_surface_of_outline(proxy);
  if (settings->procedure == RP_SYNTHESIZE) make_exemplar(proxy);
  return TRUE;
}

gboolean rp_scene_new(const rp_settings *settings, const rp_picture *picture, rp_scene *scene) {
  memset(scene, 0, sizeof *scene);
  gboolean laid = rp_settings_lay(settings);
  if (!(laid ? new_laid : new_seen)(settings, picture, scene)) return FALSE;
  if (laid) rp_proxy_centre(&scene->proxy, &scene->centre_x, &scene->centre_y);
  scene->shade_is_old = TRUE;
  return rp_scene_set_angles(scene, 0, 0, 50);
}

gboolean rp_scene_is_of(const rp_scene *scene, const rp_settings *settings) {
  if (!rp_settings_lay(settings)) return !rp_scene_is_laid(scene);
  return rp_scene_is_laid(scene) && scene->new_width == (int)rp_settings_get(settings, "width") &&
         scene->new_height == (int)rp_settings_get(settings, "height");
}

gboolean rp_scene_is_laid(const rp_scene *scene) { return scene->texture.rgba != NULL; }

void rp_scene_clear(rp_scene *scene) {
  rp_proxy_clear(&scene->texture);
  clear_layer(&scene->photo);
  clear_layer(&scene->outline);
  clear_layer(&scene->draft);
  g_clear_pointer(&scene->shade, cairo_surface_destroy);
  rp_proxy_clear(&scene->proxy);
}

gboolean rp_scene_set_angles(rp_scene *scene, double slant_deg, double tilt_deg, double fov_deg) {
  recede_plane plane;
  if (recede_plane_from_angles(scene->proxy.width, scene->proxy.height, slant_deg, tilt_deg,
                               fov_deg, &plane) != RECEDE_OK)
    return FALSE;
  scene->plane = plane;
  scene->shade_is_old = TRUE;
  return TRUE;
}

gboolean rp_scene_is_beyond(const rp_scene *scene) {
  double ends[4], quad[8];
  return !rp_grid_horizon(&scene->plane, ends) &&
         !recede_plane_quad(&scene->plane, scene->centre_x, scene->centre_y, 1, quad);
}

/* Where photographers like to have it, and clear of the hole. */
#define GUESSED_HORIZON .3
#define ABOVE_HOLE .2

gboolean rp_scene_first_guess(const rp_scene *scene, double *slant_deg, double *tilt_deg) {
  const rp_proxy *proxy = &scene->proxy;
  double ends[4], fov_deg, slant, tilt;
  double y = fmin(GUESSED_HORIZON * proxy->height, scene->centre_y - ABOVE_HOLE * proxy->height);
  recede_plane plane;
  if (rp_grid_horizon(&scene->plane, ends)) return FALSE;
  recede_plane_angles(&scene->plane, &slant, &tilt, &fov_deg);
  if (recede_plane_from_horizon(proxy->width, proxy->height, fov_deg, 0, y, proxy->width, y,
                                scene->centre_x, scene->centre_y, &plane) != RECEDE_OK)
    return FALSE;
  recede_plane_angles(&plane, slant_deg, tilt_deg, &fov_deg);
  return TRUE;
}

void rp_scene_set_source(rp_scene *scene, const rp_picture *picture) {
  rp_proxy_set_source(&scene->proxy, picture);
  scene->shade_is_old = TRUE;
}

void rp_scene_set_draft(rp_scene *scene, const guchar *pixels) {
  clear_layer(&scene->draft);
  if (!pixels) return;
  scene->draft.pixels = rp_surface_of_pixels(pixels, scene->proxy.width, scene->proxy.height);
}

/* ---------------------------------------------------------------------------------- handles -- */

typedef struct {
  double x, y;
} point;

/* The horizon's two handles, a quarter and three quarters along what is seen of it. */
static gboolean handles(const rp_scene *scene, point *left, point *right) {
  double ends[4];
  if (!rp_grid_horizon(&scene->plane, ends)) return FALSE;
  left->x = ends[0] + (ends[2] - ends[0]) * .25, left->y = ends[1] + (ends[3] - ends[1]) * .25;
  right->x = ends[0] + (ends[2] - ends[0]) * .75, right->y = ends[1] + (ends[3] - ends[1]) * .75;
  return TRUE;
}

static double distance_to_line(point a, point b, double x, double y) {
  double dx = b.x - a.x, dy = b.y - a.y;
  return fabs((x - a.x) * dy - (y - a.y) * dx) / fmax(hypot(dx, dy), 1e-9);
}

rp_grab rp_scene_grab(const rp_scene *scene, double x, double y, double reach) {
  point left, right;
  if (!handles(scene, &left, &right)) return RP_GRAB_PLANE;
  if (hypot(x - left.x, y - left.y) < reach) return RP_GRAB_LEFT;
  if (hypot(x - right.x, y - right.y) < reach) return RP_GRAB_RIGHT;
  if (distance_to_line(left, right, x, y) < reach * .7) return RP_GRAB_HORIZON;
  return RP_GRAB_PLANE;
}

static void ray(const recede_plane *plane, const double at[2], double out[3]) {
  out[0] = (at[0] - (plane->width - 1) / 2.) / plane->focal_px;
  out[1] = (at[1] - (plane->height - 1) / 2.) / plane->focal_px;
  out[2] = 1;
  double length = sqrt(out[0] * out[0] + out[1] * out[1] + 1);
  for (int i = 0; i < 3; i++) out[i] /= length;
}

/* Turns the plane as a ball under the pointer: the rotation that takes one ray to the other. */
static void turn(const recede_plane *start, const double from[2], const double to[2],
                 recede_plane *plane) {
  double a[3], b[3];
  const double *n = start->normal;
  ray(start, from, a);
  ray(start, to, b);
  double axis[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                    a[0] * b[1] - a[1] * b[0]};
  double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  double along = (axis[0] * n[0] + axis[1] * n[1] + axis[2] * n[2]) / (1 + cosine);
  double cross[3] = {axis[1] * n[2] - axis[2] * n[1], axis[2] * n[0] - axis[0] * n[2],
                     axis[0] * n[1] - axis[1] * n[0]};
  *plane = *start; /* Rodrigues, with |axis| = sine */
  for (int i = 0; i < 3; i++) plane->normal[i] = n[i] * cosine + cross[i] + axis[i] * along;
}

static gboolean bend(const rp_scene *scene, rp_grab grab, const recede_plane *start,
                     const double to[2], recede_plane *plane) {
  point left, right;
  double fov_deg, slant_deg, tilt_deg;
  rp_scene then = *scene;
  then.plane = *start;
  if (!handles(&then, &left, &right)) return FALSE;
  point *moved = grab == RP_GRAB_LEFT ? &left : &right;
  moved->x = to[0], moved->y = to[1];
  recede_plane_angles(start, &slant_deg, &tilt_deg, &fov_deg);
  return recede_plane_from_horizon(start->width, start->height, fov_deg, left.x, left.y, right.x,
                                   right.y, scene->centre_x, scene->centre_y, plane) == RECEDE_OK;
}

gboolean rp_scene_drag(const rp_scene *scene, rp_grab grab, const recede_plane *start,
                       const double from[2], const double to[2], double *slant_deg,
                       double *tilt_deg) {
  recede_plane plane;
  double fov_deg;
  if (grab == RP_GRAB_LEFT || grab == RP_GRAB_RIGHT) {
    if (!bend(scene, grab, start, to, &plane)) return FALSE;
  } else {
    turn(start, from, to, &plane);
  }
  recede_plane_angles(&plane, slant_deg, tilt_deg, &fov_deg);
  return isfinite(*slant_deg) && isfinite(*tilt_deg) && *slant_deg < 179;
}

/* ---------------------------------------------------------------------------------- drawing -- */

#define MARGIN .07 /* of the widget, around the photo */

rp_fit rp_scene_fit(const rp_scene *scene, int width, int height) {
  double inner_width = width * (1 - 2 * MARGIN), inner_height = height * (1 - 2 * MARGIN);
  double zoom = fmin(inner_width / scene->proxy.width, inner_height / scene->proxy.height);
  /* Whole pixels, so that fitted layers are painted as they are. */
  return (rp_fit){floor((width - zoom * scene->proxy.width) / 2),
                  floor((height - zoom * scene->proxy.height) / 2), zoom};
}

static void refresh_shade(rp_scene *scene) {
  if (!scene->shade_is_old) return;
  g_clear_pointer(&scene->shade, cairo_surface_destroy);
  scene->shade =
      scene->show == RP_SHOW_SCALE
          ? rp_surface_of_scale(&scene->proxy, &scene->plane, scene->centre_x, scene->centre_y)
          : rp_surface_of_magnified(&scene->proxy, &scene->plane);
  scene->shade_is_old = FALSE;
}

static void paint_scaled(cairo_t *cairo, cairo_surface_t *surface, double zoom,
                         cairo_filter_t filter) {
  cairo_save(cairo);
  cairo_scale(cairo, zoom, zoom);
  cairo_set_source_surface(cairo, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), filter);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

static void fit_layer(cairo_t *cairo, rp_layer *layer, double zoom) {
  int width = (int)ceil(cairo_image_surface_get_width(layer->pixels) * zoom);
  int height = (int)ceil(cairo_image_surface_get_height(layer->pixels) * zoom);
  g_clear_pointer(&layer->fitted, cairo_surface_destroy);
  layer->fitted = cairo_surface_create_similar(cairo_get_target(cairo), CAIRO_CONTENT_COLOR_ALPHA,
                                               width, height);
  layer->zoom = zoom;
  cairo_t *on_fitted = cairo_create(layer->fitted);
  paint_scaled(on_fitted, layer->pixels, zoom, CAIRO_FILTER_GOOD);
  cairo_destroy(on_fitted);
}

static void paint_layer(cairo_t *cairo, rp_layer *layer, double zoom) {
  if (!layer->pixels) return;
  if (!layer->fitted || layer->zoom != zoom) fit_layer(cairo, layer, zoom);
  cairo_set_source_surface(cairo, layer->fitted, 0, 0);
  cairo_paint(cairo);
}

static void draw_handles(const rp_scene *scene, cairo_t *cairo, double zoom) {
  point left, right;
  if (!handles(scene, &left, &right)) return;
  for (int i = 0; i < 2; i++) {
    point at = i ? right : left;
    cairo_arc(cairo, at.x, at.y, 6 / zoom, 0, 2 * G_PI);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_fill_preserve(cairo);
    cairo_set_line_width(cairo, 2 / zoom);
    cairo_set_source_rgb(cairo, .8, .1, .1);
    cairo_stroke(cairo);
  }
}

static void draw_plane(rp_scene *scene, cairo_t *cairo, double zoom) {
  refresh_shade(scene);
  if (scene->shade) paint_scaled(cairo, scene->shade, zoom, CAIRO_FILTER_BILINEAR);
  cairo_save(cairo);
  cairo_scale(cairo, zoom, zoom);
  rp_grid_draw(&scene->plane, cairo, scene->centre_x, scene->centre_y, zoom,
               scene->show == RP_SHOW_GRID);
  draw_handles(scene, cairo, zoom);
  cairo_restore(cairo);
}

void rp_scene_draw(rp_scene *scene, cairo_t *cairo, int width, int height) {
  rp_fit fit = rp_scene_fit(scene, width, height);
  gboolean draft = (scene->show == RP_SHOW_DRAFT || rp_scene_is_laid(scene)) && scene->draft.pixels;
  cairo_set_source_rgb(cairo, .2, .2, .2);
  cairo_paint(cairo);
  cairo_translate(cairo, fit.x, fit.y);
  paint_layer(cairo, draft ? &scene->draft : &scene->photo, fit.zoom);
  if (scene->show != RP_SHOW_DRAFT) draw_plane(scene, cairo, fit.zoom);
  if (!draft) paint_layer(cairo, &scene->outline, fit.zoom);
}
