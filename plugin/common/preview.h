/* preview.h - the widget around a scene: draws it and turns drags into angles. */
#ifndef RP_PREVIEW_H
#define RP_PREVIEW_H

#include "scene.h"
#include "toolkit.h"

typedef void (*rp_angles_func)(gpointer user, double slant_deg, double tilt_deg);

/* dragged is called for every motion of a drag. */
GtkWidget *rp_preview_new(rp_scene *scene, rp_angles_func dragged, gpointer user);

#endif
