/* GTK 2's ways. */
#include "../common/toolkit.h"

GtkWidget *rp_ui_box(GtkOrientation orientation, int spacing) {
  return orientation == GTK_ORIENTATION_HORIZONTAL ? gtk_hbox_new(FALSE, spacing)
                                                   : gtk_vbox_new(FALSE, spacing);
}

static gboolean on_expose(GtkWidget *area, GdkEventExpose *event, gpointer data) {
  const rp_painter *painter = data;
  GtkAllocation space;
  gtk_widget_get_allocation(area, &space);
  cairo_t *cairo = gdk_cairo_create(gtk_widget_get_window(area));
  gdk_cairo_region(cairo, event->region);
  cairo_clip(cairo);
  painter->draw(cairo, space.width, space.height, painter->user);
  cairo_destroy(cairo);
  return TRUE;
}

void rp_ui_on_draw(GtkWidget *area, rp_painter *painter) {
  g_signal_connect(area, "expose-event", G_CALLBACK(on_expose), painter);
}

GtkWidget *rp_ui_paragraph(void) {
  GtkWidget *label = gtk_label_new("\n");
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_misc_set_alignment(GTK_MISC(label), 0, 0);
  return label;
}

void rp_ui_set_cursor(GtkWidget *widget, GdkCursorType type) {
  GdkCursor *cursor = gdk_cursor_new_for_display(gtk_widget_get_display(widget), type);
  gdk_window_set_cursor(gtk_widget_get_window(widget), cursor);
  gdk_cursor_unref(cursor);
}
