/* Pictures of the picture within XMP, which would show what was removed; and what it says of those
 * that are not carried. */
#include <string.h>

#include "metadata_parts.h"

/* Ends of the names of what holds them: Adobe's thumbnails, whatever their prefix, their bytes, and
 * the original that phones keep beside a blurred picture, and how far away all in it is. */
static const char *const holders[] = {":Thumbnails", "GImg:image", "GImage:Data", "GDepth:Data"};
/* And of those that promise a gain map or a video behind the picture, where we write none. */
static const char *const promises[] = {"hdrgm:Version",       ":HDRGainMapVersion",
                                       "Container:Directory", "Camera:MotionPhoto",
                                       "Camera:MicroVideo",   "Camera:MicroVideoOffset"};

static char *find(const GByteArray *in, size_t from, const char *what) {
  return from < in->len ? memmem(in->data + from, in->len - from, what, strlen(what)) : NULL;
}

static bool is_name(char letter) { return g_ascii_isalnum(letter) || strchr("_-.:", letter); }

/* Where the element of this name that begins before `from` ends; 0: nowhere. */
static size_t end_of_element(const GByteArray *xmp, size_t from, const char *name) {
  const char *start = (const char *)xmp->data;
  const char *head_end = find(xmp, from, ">");
  if (!head_end) return 0;
  if (head_end[-1] == '/') return (size_t)(head_end + 1 - start);
  char *closing = g_strconcat("</", name, NULL);
  const char *tail = find(xmp, from, closing);
  const char *end = tail ? find(xmp, (size_t)(tail - start), ">") : NULL;
  g_free(closing);
  return end ? (size_t)(end + 1 - start) : 0;
}

/* Where the attribute whose name ends at `from` does; 0: it is none. */
static size_t end_of_attribute(const GByteArray *xmp, size_t from) {
  size_t at = from;
  while (at < xmp->len && g_ascii_isspace((char)xmp->data[at])) at++;
  if (at >= xmp->len || xmp->data[at] != '=') return 0;
  at++;
  while (at < xmp->len && g_ascii_isspace((char)xmp->data[at])) at++;
  if (at >= xmp->len || (xmp->data[at] != '"' && xmp->data[at] != '\'')) return 0;
  char quote[2] = {(char)xmp->data[at], '\0'};
  const char *end = find(xmp, at + 1, quote);
  return end ? (size_t)(end + 1 - (const char *)xmp->data) : 0;
}

/* What stays is copied once, piece by piece: taking each find out would move the rest for each. */
static bool clean_of(GByteArray *xmp, const char *holder) {
  GByteArray *kept = g_byte_array_new();
  const char *start = (const char *)xmp->data, *found;
  size_t copied = 0, name_from = 0; /* where the name begins that reaches to the last find's end */
  bool clear = true;
  for (size_t from = 0; clear && (found = find(xmp, from, holder));) {
    size_t begin = (size_t)(found - start), end = begin + strlen(holder);
    while (begin > from && is_name(start[begin - 1])) begin--;
    if (begin == from) begin = name_from;
    name_from = begin;
    bool longer = end < xmp->len && is_name(start[end]); /* another name */
    char before = begin > 0 ? start[begin - 1] : '\0';
    from = end;
    if (longer || (before != '<' && !g_ascii_isspace(before))) continue;
    char *name = g_strndup(start + begin, end - begin);
    from = before == '<' ? end_of_element(xmp, end, name) : end_of_attribute(xmp, end);
    g_free(name);
    clear = from > 0;
    if (before == '<') begin--;
    g_byte_array_append(kept, xmp->data + copied, (guint)(begin - copied));
    copied = name_from = from;
  }
  if (copied > 0) {
    g_byte_array_append(kept, xmp->data + copied, (guint)(xmp->len - copied));
    g_byte_array_set_size(xmp, 0);
    g_byte_array_append(xmp, kept->data, kept->len);
  }
  g_byte_array_unref(kept);
  return clear;
}

bool metadata_clean_xmp(GByteArray *xmp) {
  if (xmp->len > METADATA_LONGEST_TEXT) return false;
  for (size_t i = 0; i < G_N_ELEMENTS(holders); i++)
    if (!clean_of(xmp, holders[i])) return false;
  for (size_t i = 0; i < G_N_ELEMENTS(promises); i++)
    if (!clean_of(xmp, promises[i])) return false;
  return true;
}
