#include "synthesis/structure/edges.h"

#include <math.h>
#include <string.h>

#include "base/spread.h"

/* A change's direction is that of the edge so far outwards. */
#define FOLLOWED_PX 7.f
/* A straight edge is told by so much of it, that lies in a wedge which begins with so many px to
 * each side and gets wider by so much, and leads by no more than 20 degrees another way than where
 * the edge begins (a cosine); else by half as much. */
#define STRAIGHT_PX 20.f
#define WEDGE_PX 1.5f
#define WEDGE .05f
#define STRAIGHT_ON .94f
/* An arc is told by so much of each edge, which a circle must fit nearly as well as straight lines:
 * no more than so many times their square is left, of a right angle 1.4 to 2.5. Seen at a slant it
 * is one of an ellipse: where neither edge is straight so far, half as much will do. In the mean
 * square the edges' pixels, which lie to both sides of them, are no farther than this from the
 * circle, and farther than that from a straight line; they lead along it within 45 degrees (a
 * cosine). An arc that bulges less is as good as straight; of more than half a circle too little is
 * seen. */
#define ARC_PX 20
#define MOST_OFF_PX 1.05
#define STRAIGHT_OFF_PX .7
#define TIMES_STRAIGHT 1.3
#define LEAST_ARC_PIXELS 16
#define ALONG .7f
#define LEAST_SAGITTA_PX 1.5f
#define MOST_SWEEP 3.2f
/* Changes are the middles of several pixels: so far they may lie off their circle. */
#define ENDS_OFF_PX 4.f
/* Pieces of an arc span no more than this, or as many as there may be. */
#define PIECE_RAD .3f

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
    rc_spread spread;
    if (!rc_spread_of(xx, xy, yy, &spread)) return line;
    double sign = spread.x * (double)c->ux + spread.y * (double)c->uy < 0 ? -1 : 1;
    line = (rc_change){(float)x, (float)y, (float)(sign * spread.x), (float)(sign * spread.y)};
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

/* The edge's pixels. */
typedef struct trace {
  int x[(2 * ARC_PX + 1) * (2 * ARC_PX + 1)], y[(2 * ARC_PX + 1) * (2 * ARC_PX + 1)];
  int count;
} trace;

/* What is connected to what lies beside the change, and no farther from it than so many px. */
static void follow_pixels(const rc_labels *f, const rc_change *c, int reach, trace *t) {
  uint8_t seen[2 * ARC_PX + 1][2 * ARC_PX + 1];
  int cx = (int)(c->x + .5f), cy = (int)(c->y + .5f);
  memset(seen, 0, sizeof seen);
  t->count = 0;
  for (int y = -RC_BORDER_PX; y <= RC_BORDER_PX; y++)
    for (int x = -RC_BORDER_PX; x <= RC_BORDER_PX; x++)
      if (on_edge(f, cx + x, cy + y)) {
        seen[y + ARC_PX][x + ARC_PX] = 1;
        t->x[t->count] = cx + x, t->y[t->count++] = cy + y;
      }
  for (int first = 0; first < t->count; first++)
    for (int y = t->y[first] - 1; y <= t->y[first] + 1; y++)
      for (int x = t->x[first] - 1; x <= t->x[first] + 1; x++) {
        int dx = x - cx, dy = y - cy;
        if (dx * dx + dy * dy > reach * reach || seen[dy + ARC_PX][dx + ARC_PX] ||
            !on_edge(f, x, y))
          continue;
        seen[dy + ARC_PX][dx + ARC_PX] = 1;
        t->x[t->count] = x, t->y[t->count++] = y;
      }
}

typedef struct circle {
  double x, y, radius;
} circle;

/* The circle x^2 + y^2 = 2 a x + 2 b y + c of least squares, both edges weighing the same, from
 * their middle so that the sums do not lose their digits. */
static bool fit_circle(const trace edges[2], circle *to) {
  double mx = 0, my = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, z = 0;
  for (int e = 0; e < 2; e++)
    for (int i = 0; i < edges[e].count; i++)
      mx += .5 * edges[e].x[i] / edges[e].count, my += .5 * edges[e].y[i] / edges[e].count;
  for (int e = 0; e < 2; e++)
    for (int i = 0; i < edges[e].count; i++) {
      double x = edges[e].x[i] - mx, y = edges[e].y[i] - my, weight = .5 / edges[e].count;
      xx += weight * x * x, xy += weight * x * y, yy += weight * y * y;
      xz += weight * x * (x * x + y * y), yz += weight * y * (x * x + y * y);
      z += weight * (x * x + y * y);
    }
  double det = 2 * (xx * yy - xy * xy);
  if (!(det > 1e-6 * z * z)) return false; /* all on one straight line */
  double a = (xz * yy - yz * xy) / det, b = (yz * xx - xz * xy) / det;
  *to = (circle){mx + a, my + b, sqrt(a * a + b * b + z)};
  return true;
}

/* Of one edge's pixels. */
static double off_circle(const trace *edge, const circle *c) {
  double sum = 0;
  for (int i = 0; i < edge->count; i++) {
    double dx = edge->x[i] - c->x, dy = edge->y[i] - c->y, off = sqrt(dx * dx + dy * dy);
    sum += (off - c->radius) * (off - c->radius) / edge->count;
  }
  return sqrt(sum);
}

/* Of one edge's pixels from the straight line of least squares. */
static double off_straight(const trace *edge) {
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0, n = edge->count;
  for (int i = 0; i < edge->count; i++) x += edge->x[i] / n, y += edge->y[i] / n;
  for (int i = 0; i < edge->count; i++) {
    double dx = edge->x[i] - x, dy = edge->y[i] - y;
    xx += dx * dx / n, xy += dx * dy / n, yy += dy * dy / n;
  }
  rc_spread spread;
  rc_spread_of(xx, xy, yy, &spread);
  return sqrt(spread.little);
}

static bool fit_edges(const rc_labels *f, const rc_change *from, const rc_change *to, int reach,
                      trace edges[2], circle *c) {
  follow_pixels(f, from, reach, &edges[0]);
  follow_pixels(f, to, reach, &edges[1]);
  return edges[0].count >= LEAST_ARC_PIXELS && edges[1].count >= LEAST_ARC_PIXELS &&
         fit_circle(edges, c) && off_circle(&edges[0], c) <= MOST_OFF_PX &&
         off_circle(&edges[1], c) <= MOST_OFF_PX;
}

/* Whether the circle fits both edges nearly as well as straight lines do, which may meet in a
 * corner but say less together. */
static bool are_bent(const trace edges[2], const circle *c) {
  double round = 0, straight = 0;
  for (int e = 0; e < 2; e++) {
    round += off_circle(&edges[e], c) * off_circle(&edges[e], c);
    straight += off_straight(&edges[e]) * off_straight(&edges[e]);
  }
  return round < TIMES_STRAIGHT * straight;
}

/* The circle that both edges lie on. */
static bool find_circle(const rc_labels *f, const rc_change *from, const rc_change *to, circle *c) {
  trace edges[2];
  if (fit_edges(f, from, to, ARC_PX, edges, c)) return are_bent(edges, c);
  return off_straight(&edges[0]) > STRAIGHT_OFF_PX && off_straight(&edges[1]) > STRAIGHT_OFF_PX &&
         fit_edges(f, from, to, ARC_PX / 2, edges, c);
}

int rc_edge_arc(const rc_labels *labels, const rc_change *from, const rc_change *to,
                rc_change points[RC_MOST_ARC_PIECES + 1]) {
  circle c;
  if (!find_circle(labels, from, to, &c)) return 0;
  float ax = from->x - (float)c.x, ay = from->y - (float)c.y;
  float bx = to->x - (float)c.x, by = to->y - (float)c.y;
  /* Inwards from one end; along from there to the other, whose direction is outwards. */
  float turn = ay * from->ux - ax * from->uy > 0 ? 1.f : -1.f;
  float a = sqrtf(ax * ax + ay * ay), b = sqrtf(bx * bx + by * by);
  float along_a = turn * (ay * from->ux - ax * from->uy) / a;
  float along_b = turn * (bx * to->uy - by * to->ux) / b;
  float sweep = turn * atan2f(ax * by - ay * bx, ax * bx + ay * by);
  if (sweep < 0) sweep += 2 * (float)M_PI;
  if (!(along_a >= ALONG && along_b >= ALONG && sweep <= MOST_SWEEP) ||
      (float)c.radius * (1 - cosf(sweep / 2)) < LEAST_SAGITTA_PX ||
      fabsf(a - (float)c.radius) > ENDS_OFF_PX || fabsf(b - (float)c.radius) > ENDS_OFF_PX)
    return 0;
  int pieces = (int)fminf(fmaxf(ceilf(sweep / PIECE_RAD), 3), RC_MOST_ARC_PIECES);
  for (int i = 0; i <= pieces; i++) {
    float part = (float)i / (float)pieces, angle = turn * sweep * part;
    float scale = 1 - part + part * b / a; /* from one end's radius to the other's */
    float x = scale * (ax * cosf(angle) - ay * sinf(angle));
    float y = scale * (ax * sinf(angle) + ay * cosf(angle));
    points[i] = (rc_change){(float)c.x + x, (float)c.y + y, 0, 0};
  }
  return pieces;
}
