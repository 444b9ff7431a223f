/* The widget around a scene. */
#include "preview.h"

#include "intl.h"

#define REACH_PX 10 /* of a handle, on the screen */

typedef struct {
  rp_painter painter;
  rp_scene *scene;
  rp_angles_func dragged;
  gpointer user;
  rp_grab grab;
  int pointed_at; /* what the cursor has been set for; -1: nothing yet */
  recede_plane start;
  double from[2];
} preview;

static rp_fit fit_of(GtkWidget *area, const preview *p) {
  GtkAllocation space;
  gtk_widget_get_allocation(area, &space);
  return rp_scene_fit(p->scene, space.width, space.height);
}

static rp_grab grab_at(GtkWidget *area, const preview *p, double x, double y, double at[2]) {
  rp_fit fit = fit_of(area, p);
  at[0] = (x - fit.x) / fit.zoom;
  at[1] = (y - fit.y) / fit.zoom;
  return rp_scene_grab(p->scene, at[0], at[1], REACH_PX / fit.zoom);
}

static gboolean on_press(GtkWidget *area, GdkEventButton *event, gpointer data) {
  preview *p = data;
  if (event->button != 1 || event->type != GDK_BUTTON_PRESS) return FALSE;
  p->grab = grab_at(area, p, event->x, event->y, p->from);
  p->start = p->scene->plane;
  return TRUE;
}

static gboolean on_release(GtkWidget *area, GdkEventButton *event, gpointer data) {
  (void)area, (void)event;
  ((preview *)data)->grab = RP_GRAB_NOTHING;
  return TRUE;
}

static void show_cursor(GtkWidget *area, preview *p, rp_grab grab) {
  static const GdkCursorType shapes[] = {GDK_FLEUR, GDK_FLEUR, GDK_SB_V_DOUBLE_ARROW, GDK_CROSSHAIR,
                                         GDK_CROSSHAIR};
  if (p->pointed_at == (int)grab) return; /* the pointer moves far more often */
  rp_ui_set_cursor(area, shapes[grab]);
  p->pointed_at = (int)grab;
}

static gboolean on_motion(GtkWidget *area, GdkEventMotion *event, gpointer data) {
  preview *p = data;
  double at[2], slant_deg, tilt_deg;
  rp_grab grab = grab_at(area, p, event->x, event->y, at);
  if (p->grab == RP_GRAB_NOTHING)
    show_cursor(area, p, grab);
  else if (rp_scene_drag(p->scene, p->grab, &p->start, p->from, at, &slant_deg, &tilt_deg))
    p->dragged(p->user, slant_deg, tilt_deg);
  gdk_event_request_motions(event);
  return TRUE;
}

static void draw(cairo_t *cairo, int width, int height, gpointer data) {
  rp_scene_draw(((preview *)data)->scene, cairo, width, height);
}

GtkWidget *rp_preview_new(rp_scene *scene, rp_angles_func dragged, gpointer user) {
  preview *p = g_new0(preview, 1);
  *p = (preview){
      .painter = {draw, p}, .scene = scene, .dragged = dragged, .user = user, .pointed_at = -1};
  GtkWidget *area = gtk_drawing_area_new();
  rp_ui_on_draw(area, &p->painter);
  g_object_set_data_full(G_OBJECT(area), "recede-preview", p, g_free);
  gtk_widget_add_events(area, GDK_BUTTON_PRESS_MASK | GDK_BUTTON_RELEASE_MASK |
                                  GDK_POINTER_MOTION_MASK | GDK_POINTER_MOTION_HINT_MASK);
  g_signal_connect(area, "button-press-event", G_CALLBACK(on_press), p);
  g_signal_connect(area, "button-release-event", G_CALLBACK(on_release), p);
  g_signal_connect(area, "motion-notify-event", G_CALLBACK(on_motion), p);
  atk_object_set_name(gtk_widget_get_accessible(area), _("Preview"));
  return area;
}
