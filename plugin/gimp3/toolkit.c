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

GtkWidget *rp_ui_paragraph(void) {
  GtkWidget *label = gtk_label_new("\n");
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_yalign(GTK_LABEL(label), 0);
  return label;
}

void rp_ui_set_cursor(GtkWidget *widget, GdkCursorType type) {
  GdkCursor *cursor = gdk_cursor_new_for_display(gtk_widget_get_display(widget), type);
  gdk_window_set_cursor(gtk_widget_get_window(widget), cursor);
  g_object_unref(cursor);
}
