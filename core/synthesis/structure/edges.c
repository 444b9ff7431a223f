#include "synthesis/structure/edges.h"

#include <math.h>

/* A change's direction is that of the edge so far outwards. */
#define FOLLOWED_PX 7.f
/* A straight edge is told by so much of it, that lies in a wedge which begins with so many px to
 * each side and gets wider by so much, and leads by no more than 20 degrees another way than where
 * the edge begins (a cosine); else by half as much. */
#define STRAIGHT_PX 20.f
#define WEDGE_PX 1.5f
#define WEDGE .05f
#define STRAIGHT_ON .94f

bool rc_on_border(const rc_labels *labels, int x, int y) {
  const rc_around *a = labels->around;
  size_t at = (size_t)y * (size_t)a->width + (size_t)x;
  return rc_inside(a->width, a->height, x, y) && labels->label[at] && a->from_hole[at] &&
         a->from_hole[at] <= RC_BORDER_PX;
}

bool rc_labels_differ(const rc_labels *labels, int x, int y, int other_x, int other_y) {
  const rc_around *a = labels->around;
  if (!rc_inside(a->width, a->height, x, y) || !rc_inside(a->width, a->height, other_x, other_y))
    return false;
  int8_t here = labels->label[y * a->width + x],
         there = labels->label[other_y * a->width + other_x];
  return here && there == -here;
}

/* Between two known labels. */
static bool on_edge(const rc_labels *f, int x, int y) {
  const rc_around *a = f->around;
  return rc_inside(a->width, a->height, x, y) && a->from_hole[y * a->width + x] &&
         (rc_labels_differ(f, x, y, x - 1, y) || rc_labels_differ(f, x, y, x + 1, y) ||
          rc_labels_differ(f, x, y, x, y - 1) || rc_labels_differ(f, x, y, x, y + 1));
}

void rc_edge_follow(const rc_labels *f, rc_change *c) {
  int reach = (int)FOLLOWED_PX, cx = (int)(c->x + .5f), cy = (int)(c->y + .5f);
  for (int y = cy - reach; y <= cy + reach; y++)
    for (int x = cx - reach; x <= cx + reach; x++) {
      float dx = (float)x - c->x, dy = (float)y - c->y;
      if (dx * dx + dy * dy > FOLLOWED_PX * FOLLOWED_PX || !on_edge(f, x, y)) continue;
      c->ux += dx, c->uy += dy;
    }
  float length = sqrtf(c->ux * c->ux + c->uy * c->uy);
  bool leads = length > .5f; /* px; else it leads nowhere */
  c->ux = leads ? c->ux / length : 0, c->uy = leads ? c->uy / length : 0;
}

/* The straight line that an edge follows so far, from its direction nearby: what lies in a narrow
 * wedge along that. x, y: a place on it. */
static rc_change fit_edge(const rc_labels *f, const rc_change *c, float far_px) {
  int reach = (int)far_px;
  rc_change line = *c;
  for (int round = 0; round < 2; round++) {
    double sum = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (int j = -reach; j <= reach; j++)
      for (int i = -reach; i <= reach; i++) {
        int px = (int)(c->x + .5f) + i, py = (int)(c->y + .5f) + j;
        float dx = (float)px - line.x, dy = (float)py - line.y;
        float along = ((float)px - c->x) * line.ux + ((float)py - c->y) * line.uy;
        float across = fabsf(dx * line.uy - dy * line.ux);
        if (along < 0 || along > far_px || across > WEDGE_PX + WEDGE * along) continue;
        if (!on_edge(f, px, py)) continue;
        sum++, x += px, y += py;
        xx += (double)px * px, xy += (double)px * py, yy += (double)py * py;
      }
    if (sum < 2) return line;
    x /= sum, y /= sum, xx = xx / sum - x * x, xy = xy / sum - x * y, yy = yy / sum - y * y;
    /* The greater axis of what they spread by. */
    double root = sqrt((xx - yy) * (xx - yy) / 4 + xy * xy), great = (xx + yy) / 2 + root;
    double ux = xx > yy ? great - yy : xy, uy = xx > yy ? xy : great - xx;
    double length = sqrt(ux * ux + uy * uy);
    if (!(length > 0)) return line;
    if (ux * (double)c->ux + uy * (double)c->uy < 0) length = -length;
    line = (rc_change){(float)x, (float)y, (float)(ux / length), (float)(uy / length)};
  }
  return line;
}

rc_change rc_edge_straight(const rc_labels *f, const rc_change *c) {
  for (float far_px = STRAIGHT_PX; far_px > FOLLOWED_PX; far_px /= 2) {
    rc_change line = fit_edge(f, c, far_px);
    if (line.ux * c->ux + line.uy * c->uy > STRAIGHT_ON) return line;
  }
  return *c;
}
