/* toolkit.h - the few things that GTK 2 and GTK 3 do differently; gimp2/ and gimp3/ each have a
 * toolkit.c. */
#ifndef RP_TOOLKIT_H
#define RP_TOOLKIT_H

#include <gtk/gtk.h>

GtkWidget *rp_ui_box(GtkOrientation orientation, int spacing);
typedef struct {
  void (*draw)(cairo_t *cairo, int width, int height, gpointer user);
  gpointer user;
} rp_painter;

/* Whenever the area is to be drawn, painter draws it; it must outlive the area. */
void rp_ui_on_draw(GtkWidget *area, rp_painter *painter);
/* Room for some lines of text, from the top left, broken where its width ends; *label takes the
 * text.
 */
GtkWidget *rp_ui_paragraph(GtkWidget **label);
/* The window opens as large as what is in it asks for now, or as the screen has room for. */
void rp_ui_open_so_large(GtkWidget *window);
void rp_ui_set_cursor(GtkWidget *widget, GdkCursorType type);

#endif
