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

static void on_width(GtkWidget *layout, GtkAllocation *space, gpointer label) {
  (void)layout;
  gtk_widget_set_size_request(label, space->width, -1);
}

/* A label breaks its lines at the width it asks for. In a layout it can ask for what there is, and
 * the window can shrink again. */
GtkWidget *rp_ui_paragraph(GtkWidget **label) {
  GtkWidget *layout = gtk_layout_new(NULL, NULL);
  *label = gtk_label_new("");
  gtk_label_set_line_wrap(GTK_LABEL(*label), TRUE);
  gtk_misc_set_alignment(GTK_MISC(*label), 0, 0);
  gtk_layout_put(GTK_LAYOUT(layout), *label, 0, 0);
  g_signal_connect(layout, "size-allocate", G_CALLBACK(on_width), *label);
  return layout;
}

/* px for the window's frame and the desktop's bars, which GTK 2 does not tell. */
#define AROUND 60

void rp_ui_open_so_large(GtkWidget *window) {
  GdkScreen *screen = gtk_widget_get_screen(window);
  GtkRequisition size;
  GdkRectangle monitor;
  gtk_widget_size_request(window, &size);
  for (int i = 0; i < gdk_screen_get_n_monitors(screen); i++) {
    gdk_screen_get_monitor_geometry(screen, i, &monitor);
    size.width = MIN(size.width, monitor.width - AROUND);
    size.height = MIN(size.height, monitor.height - AROUND);
  }
  gtk_window_set_default_size(GTK_WINDOW(window), size.width, size.height);
}

void rp_ui_set_cursor(GtkWidget *widget, GdkCursorType type) {
  GdkCursor *cursor = gdk_cursor_new_for_display(gtk_widget_get_display(widget), type);
  gdk_window_set_cursor(gtk_widget_get_window(widget), cursor);
  gdk_cursor_unref(cursor);
}
