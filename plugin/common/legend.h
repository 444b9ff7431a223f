/* legend.h - in words: what the preview shows and what the user can do with it. */
#ifndef RP_LEGEND_H
#define RP_LEGEND_H

#include "scene.h"

const char *rp_legend(const rp_scene *scene);

#endif
