/* GTK 3's ways. */
#include "../common/toolkit.h"

typedef struct {
  void (*draw)(cairo_t *cairo, int width, int height, gpointer user);
  gpointer user;
} painter;

GtkWidget *rp_ui_box(GtkOrientation orientation, int spacing) {
  return gtk_box_new(orientation, spacing);
}

static gboolean on_draw(GtkWidget *area, cairo_t *cairo, gpointer data) {
  painter *p = data;
  p->draw(cairo, gtk_widget_get_allocated_width(area), gtk_widget_get_allocated_height(area),
          p->user);
  return TRUE;
}

GtkWidget *rp_ui_drawing_area(void (*draw)(cairo_t *cairo, int width, int height, gpointer user),
                              gpointer user) {
  GtkWidget *area = gtk_drawing_area_new();
  painter *p = g_new(painter, 1);
  *p = (painter){draw, user};
  g_signal_connect(area, "draw", G_CALLBACK(on_draw), p);
  g_object_set_data_full(G_OBJECT(area), "recede-painter", p, g_free);
  return area;
}
