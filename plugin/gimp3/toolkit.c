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

GtkWidget *rp_ui_paragraph(GtkWidget **label) {
  *label = gtk_label_new("");
  gtk_label_set_line_wrap(GTK_LABEL(*label), TRUE);
  gtk_label_set_max_width_chars(GTK_LABEL(*label), 1); /* takes the width there is, asks for none */
  gtk_label_set_xalign(GTK_LABEL(*label), 0);
  gtk_label_set_yalign(GTK_LABEL(*label), 0);
  return *label;
}

#define FRAME 40 /* px for the window's own */

void rp_ui_open_so_large(GtkWidget *window) {
  GdkDisplay *display = gtk_widget_get_display(window);
  GtkRequisition size;
  GdkRectangle room;
  gtk_widget_get_preferred_size(window, NULL, &size);
  for (int i = 0; i < gdk_display_get_n_monitors(display); i++) {
    gdk_monitor_get_workarea(gdk_display_get_monitor(display, i), &room);
    size.width = MIN(size.width, room.width - FRAME);
    size.height = MIN(size.height, room.height - FRAME);
  }
  gtk_window_set_default_size(GTK_WINDOW(window), size.width, size.height);
}

void rp_ui_set_cursor(GtkWidget *widget, GdkCursorType type) {
  GdkCursor *cursor = gdk_cursor_new_for_display(gtk_widget_get_display(widget), type);
  gdk_window_set_cursor(gtk_widget_get_window(widget), cursor);
  g_object_unref(cursor);
}
