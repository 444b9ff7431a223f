/* GTK 3's ways. */
#include "../common/toolkit.h"

GtkWidget *rp_ui_box(GtkOrientation orientation, int spacing) {
  return gtk_box_new(orientation, spacing);
}

static gboolean on_draw(GtkWidget *area, cairo_t *cairo, gpointer data) {
  const rp_painter *painter = data;
  painter->draw(cairo, gtk_widget_get_allocated_width(area), gtk_widget_get_allocated_height(area),
                painter->user);
  return TRUE;
}

void rp_ui_on_draw(GtkWidget *area, rp_painter *painter) {
  g_signal_connect(area, "draw", G_CALLBACK(on_draw), painter);
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
