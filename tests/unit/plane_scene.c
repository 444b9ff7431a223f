#include "plane_scene.h"

#include <math.h>
#include <string.h>

#define FOV_DEG 50
#define SAMPLES 4 /* each way, of one pixel */

static gsize type_bytes(recede_type type) {
  return type == RECEDE_U8 ? 1 : type == RECEDE_FLOAT ? 4 : 2;
}

picture picture_new(int width, int height, int channels, recede_type type) {
  gsize stride = (gsize)width * (gsize)channels * type_bytes(type);
  picture p = {.pixels = g_malloc0(stride * (gsize)height)};
  p.view = (recede_view){p.pixels, stride, width, height, channels, type};
  return p;
}

picture picture_copy(const picture *from) {
  picture p =
      picture_new(from->view.width, from->view.height, from->view.channels, from->view.type);
  memcpy(p.pixels, from->pixels, picture_bytes(from));
  return p;
}

void picture_clear(picture *p) {
  g_free(p->pixels);
  p->pixels = NULL;
}

gsize picture_bytes(const picture *p) { return p->view.stride_bytes * (gsize)p->view.height; }

static gsize index_of(const picture *p, int x, int y, int k) {
  return ((gsize)y * (gsize)p->view.width + (gsize)x) * (gsize)p->view.channels + (gsize)k;
}

float picture_get(const picture *p, int x, int y, int k) {
  gsize i = index_of(p, x, y, k);
  if (p->view.type == RECEDE_U8) return (float)p->pixels[i] / 255.f;
  return ((const float *)(const void *)p->pixels)[i];
}

void picture_set(picture *p, int x, int y, int k, float value) {
  gsize i = index_of(p, x, y, k);
  if (p->view.type == RECEDE_U8)
    p->pixels[i] = (guint8)(CLAMP(value, 0.f, 1.f) * 255.f + .5f);
  else
    ((float *)(void *)p->pixels)[i] = value;
}

void picture_fill(picture *p, area a, float value) {
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x < a.x1; x++)
      for (int k = 0; k < p->view.channels; k++) picture_set(p, x, y, k, value);
}

double noise_at(int x, int y, int n) {
  guint32 h = (guint32)x * 374761393u + (guint32)y * 668265263u + (guint32)n * 2246822519u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  return (double)(h ^ (h >> 16)) / 4294967296.;
}

double smooth_noise(double u, double v, double per_texel, int n) {
  double x = u * per_texel, y = v * per_texel, fx = x - floor(x), fy = y - floor(y);
  int i = (int)floor(x), j = (int)floor(y);
  double upper = noise_at(i, j, n) * (1 - fx) + noise_at(i + 1, j, n) * fx;
  double lower = noise_at(i, j + 1, n) * (1 - fx) + noise_at(i + 1, j + 1, n) * fx;
  return upper * (1 - fy) + lower * fy - .5;
}

/* Strictly periodic: two bricks wide, two courses high. */
double bricks(double u, double v, int k) {
  double row = floor(v), shifted = u * .5 + .5 * fmod(fabs(row), 2);
  double in = shifted - floor(shifted);
  bool joint = in < .06 || v - row < .12;
  static const double brick[3] = {.62, .36, .28};
  return joint ? .85 : brick[k] + .12 * sin(2 * G_PI * in) + .1 * (v - row);
}

/* A grain of its own shade in every texel, smoothly joined. */
double grains(double u, double v, int k) {
  int iu = (int)floor(u), iv = (int)floor(v);
  double fu = u - iu, fv = v - iv, sum = 0;
  for (int j = 0; j < 2; j++)
    for (int i = 0; i < 2; i++)
      sum += (i ? fu : 1 - fu) * (j ? fv : 1 - fv) * noise_at(iu + i, iv + j, k / 2);
  return .2 + .6 * sum;
}

typedef struct camera {
  recede_plane plane;
  double across[2], along[2], texel_px;
} camera;

static camera camera_of(int width, int height, double slant, double tilt, double texel_px) {
  camera c = {.texel_px = texel_px};
  double radians = tilt * G_PI / 180;
  g_assert_cmpint(recede_plane_from_angles(width, height, slant, tilt, FOV_DEG, &c.plane), ==,
                  RECEDE_OK);
  c.along[0] = sin(radians), c.along[1] = -cos(radians);
  c.across[0] = -c.along[1], c.across[1] = c.along[0];
  return c;
}

/* Where (x, y) lies in the plane, texels; false beyond the horizon. */
static bool unproject(const camera *c, double x, double y, double *u, double *v) {
  double w = recede_plane_w(&c->plane, x, y), w0 = fabs(c->plane.normal[2]);
  double px = x - (c->plane.width - 1) / 2., py = y - (c->plane.height - 1) / 2.;
  if (w <= 1e-3) return false;
  w0 = w0 < .05 ? .05 : w0;
  *u = (px * c->across[0] + py * c->across[1]) * w0 / w / c->texel_px;
  *v = (px * c->along[0] + py * c->along[1]) / w / c->texel_px;
  return true;
}

picture picture_of_plane(int width, int height, int channels, recede_type type, pattern *draw,
                         double texel_px, double slant_deg, double tilt_deg) {
  picture p = picture_new(width, height, channels, type);
  camera c = camera_of(width, height, slant_deg, tilt_deg, texel_px);
  int colours = channels < 3 ? 1 : 3;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      double sum[3] = {0, 0, 0}, u, v;
      for (int s = 0; s < SAMPLES * SAMPLES; s++) {
        double sx = x + (s % SAMPLES + .5) / SAMPLES - .5,
               sy = y + (s / SAMPLES + .5) / SAMPLES - .5;
        if (!unproject(&c, sx, sy, &u, &v)) continue;
        for (int k = 0; k < colours; k++) sum[k] += draw(u, v, k) / (SAMPLES * SAMPLES);
      }
      for (int k = 0; k < colours; k++) picture_set(&p, x, y, k, (float)sum[k]);
      if (colours < channels) picture_set(&p, x, y, colours, 1);
    }
  return p;
}

static void draw_disc(picture *p, double x, double y, double radius, double shade) {
  for (int py = (int)(y - radius); py <= (int)(y + radius); py++)
    for (int px = (int)(x - radius); px <= (int)(x + radius); px++) {
      double d = hypot(px - x, py - y) / radius;
      if (px < 0 || py < 0 || px >= p->view.width || py >= p->view.height || d > 1) continue;
      picture_set(p, px, py, 0, (float)(d > .8 ? shade * .4 : shade));
    }
}

/* From the horizon to the viewer, so that nearer ones cover those behind; as many of them to their
 * own size everywhere. */
picture picture_of_discs(int width, int height, double disc_px, double slant_deg) {
  picture p = picture_new(width, height, 1, RECEDE_U8);
  camera c = camera_of(width, height, slant_deg, 0, 1);
  int n = 0;
  for (double y = -disc_px; y < height + 3 * disc_px; y += .35) {
    double w = recede_plane_w(&c.plane, 0, y) / c.plane.normal[2];
    if (w <= .05) continue;
    double radius = .5 * disc_px * w, chance = .35 * width / (radius * radius);
    for (; chance > 0; chance -= 1, n++)
      if (noise_at(n, 0, 0) < chance)
        draw_disc(&p, noise_at(n, 0, 1) * width, y + .35 * noise_at(n, 0, 2), radius,
                  .3 + .65 * noise_at(n, 0, 3));
  }
  return p;
}

void task_set(task *t, const char *settings) {
  gchar **words = g_strsplit(settings, " ", -1);
  for (int i = 0; words[i] && *words[i]; i++) {
    gchar **pair = g_strsplit(words[i], "=", 2);
    char message[200];
    g_assert_cmpint(recede_params_set(&t->params, pair[0], pair[1], message, sizeof message), ==,
                    RECEDE_OK);
    g_strfreev(pair);
  }
  g_strfreev(words);
}

task task_new(picture image, const char *settings) {
  task t = {.image = image};
  t.mask = picture_new(image.view.width, image.view.height, 1, RECEDE_U8);
  recede_host_init(&t.host);
  t.host.threads = 1;
  recede_params_init(&t.params);
  task_set(&t, "orientation=angles surface=flat");
  task_set(&t, settings);
  return t;
}

void task_hole(task *t, area a) { picture_fill(&t->mask, a, 1); }

static recede_job *job_of(task *t) {
  recede_job *job = recede_job_new(&t->host);
  g_assert_nonnull(job);
  g_assert_cmpint(recede_job_set_image(job, &t->image.view), ==, RECEDE_OK);
  g_assert_cmpint(recede_job_set_params(job, &t->params), ==, RECEDE_OK);
  if (t->source.pixels) g_assert_cmpint(recede_job_set_source(job, &t->source.view), ==, RECEDE_OK);
  return job;
}

void task_round_hole(task *t, area a) {
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x < a.x1; x++)
      if (hypot((2. * x + 1 - a.x0 - a.x1) / (a.x1 - a.x0),
                (2. * y + 1 - a.y0 - a.y1) / (a.y1 - a.y0)) < 1)
        picture_set(&t->mask, x, y, 0, 1);
}

static void new_result(task *t, int width, int height) {
  picture_clear(&t->result);
  t->result = picture_new(width, height, t->image.view.channels, t->image.view.type);
  memset(t->result.pixels, 0xa5, picture_bytes(&t->result));
}

static void finish(task *t, recede_job *job) {
  t->report = *recede_job_report(job);
  g_strlcpy(t->message, recede_job_message(job), sizeof t->message);
  recede_job_free(&job);
}

void task_run(task *t) {
  recede_job *job = job_of(t);
  new_result(t, t->image.view.width, t->image.view.height);
  g_assert_cmpint(recede_job_set_mask(job, &t->mask.view), ==, RECEDE_OK);
  t->status = recede_job_fill(job, &t->result.view);
  finish(t, job);
}

void task_synthesize(task *t, int width, int height) {
  recede_job *job = job_of(t);
  new_result(t, width, height);
  t->status = recede_job_synthesize(job, &t->result.view);
  finish(t, job);
}

void task_succeeds(task *t) {
  task_run(t);
  g_assert_cmpstr(t->message, ==, "");
  g_assert_cmpint(t->status, ==, RECEDE_OK);
  g_assert_cmpuint(t->report.peak_bytes, <=, t->report.estimated_bytes);
  task_assert_outside(t);
}

void task_clear(task *t) {
  picture_clear(&t->image);
  picture_clear(&t->mask);
  picture_clear(&t->source);
  picture_clear(&t->result);
}

bool task_result_untouched(const task *t) {
  for (gsize i = 0; i < picture_bytes(&t->result); i++)
    if (t->result.pixels[i] != 0xa5) return false;
  return true;
}

void task_assert_outside(const task *t) {
  gsize pixel = (gsize)t->image.view.channels * type_bytes(t->image.view.type);
  gsize count = (gsize)t->image.view.width * (gsize)t->image.view.height, changed = 0;
  for (gsize i = 0; i < count; i++)
    if (!t->mask.pixels[i])
      changed += memcmp(t->image.pixels + i * pixel, t->result.pixels + i * pixel, pixel) != 0;
  g_assert_cmpuint(changed, ==, 0);
}

moments moments_of(const picture *p, const picture *mask, bool inside, area a, int k) {
  moments m = {.least = HUGE_VAL, .most = -HUGE_VAL};
  double square = 0;
  for (int y = MAX(a.y0, 0); y < MIN(a.y1, p->view.height); y++)
    for (int x = MAX(a.x0, 0); x < MIN(a.x1, p->view.width); x++) {
      if ((picture_get(mask, x, y, 0) > 0) != inside) continue;
      double v = picture_get(p, x, y, k);
      m.count++, m.mean += v, square += v * v;
      m.least = fmin(m.least, v), m.most = fmax(m.most, v);
    }
  g_assert_cmpfloat(m.count, >, 0);
  m.mean /= m.count;
  m.deviation = sqrt(fmax(square / m.count - m.mean * m.mean, 0));
  return m;
}

paint task_paint(const task *t, const picture *truth, area a) {
  paint p = {0, 0, 0};
  for (int y = a.y0; y < a.y1; y++)
    for (int x = a.x0; x < a.x1; x++) {
      float wanted = picture_get(truth, x, y, 0), got = picture_get(&t->result, x, y, 0);
      if (!(picture_get(&t->mask, x, y, 0) > 0) || (wanted > .5f && wanted < .8f)) continue;
      bool is_paint = wanted > .8f, good = fabsf(got - wanted) < .2f;
      p.right += is_paint && good, p.all += is_paint || !good, p.wrong += !is_paint && !good;
    }
  return p;
}

double masked_psnr(const picture *p, const picture *truth, const picture *mask) {
  double square = 0, count = 0;
  for (int y = 0; y < p->view.height; y++)
    for (int x = 0; x < p->view.width; x++)
      for (int k = 0; k < p->view.channels && picture_get(mask, x, y, 0) > 0; k++, count++) {
        double d = picture_get(p, x, y, k) - picture_get(truth, x, y, k);
        square += d * d;
      }
  return -10 * log10(square / count);
}
