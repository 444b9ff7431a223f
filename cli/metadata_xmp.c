/* Pictures of the picture within XMP: they would show what was removed. */
#include <string.h>

#include "metadata_parts.h"

/* Ends of the names of what holds them: Adobe's thumbnails, whatever their prefix, their bytes, and
 * the original that phones keep beside a blurred picture. */
static const char *const holders[] = {":Thumbnails", "GImg:image", "GImage:Data"};

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

static bool clean_of(GByteArray *xmp, const char *holder) {
  const char *found;
  for (size_t from = 0; (found = find(xmp, from, holder));) {
    const char *start = (const char *)xmp->data;
    size_t begin = (size_t)(found - start), end = begin + strlen(holder), cut_to;
    while (begin > 0 && is_name(start[begin - 1])) begin--;
    bool longer = end < xmp->len && is_name(start[end]); /* another name */
    char before = begin > 0 ? start[begin - 1] : '\0';
    from = end;
    if (longer || (before != '<' && !g_ascii_isspace(before))) continue;
    char *name = g_strndup(start + begin, end - begin);
    cut_to = before == '<' ? end_of_element(xmp, end, name) : end_of_attribute(xmp, end);
    g_free(name);
    if (!cut_to) return false;
    if (before == '<') begin--;
    g_byte_array_remove_range(xmp, (guint)begin, (guint)(cut_to - begin));
    from = begin;
  }
  return true;
}

bool metadata_clean_xmp(GByteArray *xmp) {
  for (size_t i = 0; i < G_N_ELEMENTS(holders); i++)
    if (!clean_of(xmp, holders[i])) return false;
  return true;
}
