#include "exif.h"

#include <string.h>

enum { POINTER_EXIF = 0x8769, POINTER_GPS = 0x8825, POINTER_INTEROP = 0xa005 };
enum { TIFF = 42, BIG_TIFF = 43 };
enum { SUB_FOLDERS = 330 };

static const uint8_t type_sizes[] = {0, 1, 1, 2, 4, 8, 1, 1, 2, 4, 8, 4, 8, 4, 0, 0, 8, 8, 8};
enum { TYPE_WORD = 16 }; /* and above: BigTIFF's numbers of 64 bits */
/* Of a tree: many times what cameras write, and two trees' fit the 16 bits of a folder's count. */
enum { MOST_ENTRIES = 16384 };

static size_t type_size(unsigned type) { return type < sizeof type_sizes ? type_sizes[type] : 0; }

/* ------------------------------------------------------------------------------------ read -- */

typedef struct source {
  const uint8_t *bytes;
  size_t size;
  bool big;  /* its bytes' order */
  bool wide; /* BigTIFF: counts and offsets have 64 bits */
} source;

static uint16_t get16(bool big, const uint8_t *at) {
  return (uint16_t)(big ? at[0] << 8 | at[1] : at[1] << 8 | at[0]);
}
static uint32_t get32(bool big, const uint8_t *at) {
  return big ? (uint32_t)get16(big, at) << 16 | get16(big, at + 2)
             : (uint32_t)get16(big, at + 2) << 16 | get16(big, at);
}
/* A count or an offset. */
static uint64_t get_word(const source *from, const uint8_t *at) {
  if (!from->wide) return get32(from->big, at);
  uint64_t first = get32(from->big, at), second = get32(from->big, at + 4);
  return from->big ? first << 32 | second : second << 32 | first;
}

static size_t word_size(const source *from) { return from->wide ? 8 : 4; }
static size_t count_size(const source *from) { return from->wide ? 8 : 2; }
static size_t entry_size(const source *from) { return from->wide ? 20 : 12; }

static bool open_source(const uint8_t *bytes, size_t size, source *from) {
  if (size < 8 || (memcmp(bytes, "II", 2) != 0 && memcmp(bytes, "MM", 2) != 0)) return false;
  bool big = bytes[0] == 'M';
  uint16_t version = get16(big, bytes + 2);
  *from = (source){bytes, size, big, version == BIG_TIFF};
  return version == TIFF || (version == BIG_TIFF && size >= 16);
}

static size_t first_folder(const source *from) {
  return get_word(from, from->bytes + (from->wide ? 8 : 4));
}

/* Entries of the folder at an offset; 0: it does not lie within the bytes. */
static size_t folder_size(const source *from, size_t offset) {
  size_t head = count_size(from);
  if (offset < 8 || offset >= from->size || head > from->size - offset) return 0;
  uint64_t count =
      from->wide ? get_word(from, from->bytes + offset) : get16(from->big, from->bytes + offset);
  return count <= (from->size - offset - head) / entry_size(from) ? count : 0;
}

static const uint8_t *entry_at(const source *from, size_t folder, size_t index) {
  return from->bytes + folder + count_size(from) + index * entry_size(from);
}

static bool read_entry(const source *from, const uint8_t *at, exif_entry *entry) {
  uint64_t count = get_word(from, at + 4);
  entry->tag = get16(from->big, at);
  entry->type = get16(from->big, at + 2);
  entry->value = at + 4 + word_size(from);
  if (count == 0 || count > from->size || !type_size(entry->type)) return false;
  entry->count = (uint32_t)count;
  entry->size = type_size(entry->type) * (size_t)count;
  if (entry->size <= word_size(from)) return true;
  size_t offset = get_word(from, entry->value);
  if (offset > from->size || entry->size > from->size - offset) return false;
  entry->value = from->bytes + offset;
  return true;
}

static bool is_pointer(uint16_t tag, exif_folder *folder) {
  *folder = tag == POINTER_EXIF ? EXIF_EXIF : tag == POINTER_GPS ? EXIF_GPS : EXIF_INTEROP;
  return tag == POINTER_EXIF || tag == POINTER_GPS || tag == POINTER_INTEROP;
}

/* What is done for one tree. */
typedef struct reading {
  const source *from;
  exif_tree *tree;
  bool followed[EXIF_FOLDERS]; /* each kind of folder once, so pointers in a circle end */
  size_t values;               /* bytes of those that do not fit into their entries */
} reading;

/* Values that do not overlap take no more than the bytes they are in. Were all of them the same
 * ones, a copy of each would fill the memory. */
static void take_entry(reading *now, const exif_entry *entry) {
  size_t apart = entry->size > word_size(now->from) ? entry->size : 0;
  if (now->tree->entries->len >= MOST_ENTRIES || apart > now->from->size - now->values) {
    now->tree->cut = true;
    return;
  }
  now->values += apart;
  g_array_append_val(now->tree->entries, *entry);
}

static void read_folder(reading *now, exif_folder folder, size_t offset) {
  const source *from = now->from;
  size_t count = folder_size(from, offset);
  for (size_t i = 0; i < count; i++) {
    exif_entry entry = {.folder = folder};
    exif_folder below;
    if (!read_entry(from, entry_at(from, offset, i), &entry)) continue;
    bool word = entry.type >= TYPE_WORD;
    if (!is_pointer(entry.tag, &below)) {
      if (!word) take_entry(now, &entry); /* a classic TIFF has no such numbers */
    } else if (below > folder && !now->followed[below] && (entry.size == 4 || entry.size == 8)) {
      now->followed[below] = true;
      read_folder(now, below, word ? get_word(from, entry.value) : get32(from->big, entry.value));
    }
  }
}

bool exif_read(const uint8_t *bytes, size_t size, exif_tree *tree) {
  source from;
  *tree = (exif_tree){.entries = g_array_new(FALSE, FALSE, sizeof(exif_entry))};
  if (!open_source(bytes, size, &from)) return false;
  tree->big_endian = from.big;
  reading now = {.from = &from, .tree = tree};
  read_folder(&now, EXIF_MAIN, first_folder(&from));
  return true;
}

void exif_clear(exif_tree *tree) { g_array_unref(tree->entries); }

const exif_entry *exif_find(const exif_tree *tree, exif_folder folder, uint16_t tag) {
  for (guint i = 0; i < tree->entries->len; i++) {
    const exif_entry *entry = &g_array_index(tree->entries, exif_entry, i);
    if (entry->folder == folder && entry->tag == tag) return entry;
  }
  return NULL;
}

void exif_remove(exif_tree *tree, exif_folder folder, uint16_t tag) {
  for (guint i = tree->entries->len; i-- > 0;) {
    const exif_entry *entry = &g_array_index(tree->entries, exif_entry, i);
    if (entry->folder == folder && entry->tag == tag) g_array_remove_index(tree->entries, i);
  }
}

void exif_remove_structure(exif_tree *tree) {
  static const uint16_t ranges[][2] = {{254, 259}, {262, 266},     {273, 273},     {277, 281},
                                       {284, 284}, {288, 293},     {301, 301},     {317, 317},
                                       {320, 325}, {330, 332},     {334, 347},     {512, 532},
                                       {559, 559}, {33421, 33422}, {34675, 34675}, {50674, 50674}};
  for (guint i = tree->entries->len; i-- > 0;) {
    const exif_entry *entry = &g_array_index(tree->entries, exif_entry, i);
    bool structure = false;
    for (size_t k = 0; k < G_N_ELEMENTS(ranges); k++)
      structure |= entry->tag >= ranges[k][0] && entry->tag <= ranges[k][1];
    if (structure && entry->folder == EXIF_MAIN) g_array_remove_index(tree->entries, i);
  }
}

/* ----------------------------------------------------------------------------------- write -- */

static void put16(GByteArray *to, unsigned value) {
  uint8_t bytes[2] = {(uint8_t)value, (uint8_t)(value >> 8)};
  g_byte_array_append(to, bytes, 2);
}
static void put32(GByteArray *to, uint32_t value) {
  put16(to, value & 0xffff);
  put16(to, value >> 16);
}
static void patch32(GByteArray *to, guint at, uint32_t value) {
  for (int i = 0; i < 4; i++) to->data[at + (guint)i] = (uint8_t)(value >> 8 * i);
}

static void put_value(GByteArray *to, const exif_entry *entry, bool big) {
  /* Rationals are two numbers. */
  size_t unit = entry->type == 5 || entry->type == 10 ? 4 : type_size(entry->type);
  guint at = to->len;
  g_byte_array_append(to, entry->value, (guint)entry->size);
  if (!big || unit == 1) return;
  for (size_t i = 0; i + unit <= entry->size; i += unit)
    for (size_t k = 0; k < unit; k++) to->data[at + i + k] = entry->value[i + unit - 1 - k];
}

typedef struct merged {
  const exif_entry *entry; /* NULL: a pointer to a folder below */
  bool big;
  uint16_t tag;
} merged;

static gint by_tag(gconstpointer a, gconstpointer b) {
  return (int)((const merged *)a)->tag - (int)((const merged *)b)->tag;
}

/* taken: by tag. */
static void take(const exif_tree *tree, exif_folder folder, bool *taken, GArray *all) {
  for (guint i = 0; i < tree->entries->len; i++) {
    const exif_entry *entry = &g_array_index(tree->entries, exif_entry, i);
    merged one = {entry, tree->big_endian, entry->tag};
    if (entry->folder != folder || taken[entry->tag]) continue;
    taken[entry->tag] = true;
    g_array_append_val(all, one);
  }
}

static bool has(const exif_tree *first, const exif_tree *second, exif_folder folder) {
  const exif_tree *trees[2] = {first, second};
  for (int t = 0; t < 2; t++)
    for (guint i = 0; trees[t] && i < trees[t]->entries->len; i++)
      if (g_array_index(trees[t]->entries, exif_entry, i).folder == folder) return true;
  return false;
}

static void add_pointer(GArray *all, uint16_t tag) {
  merged one = {NULL, false, tag};
  g_array_append_val(all, one);
}

static uint32_t append_folder(const exif_tree *first, const exif_tree *second, exif_folder folder,
                              GByteArray *to, guint start) {
  GArray *all = g_array_new(FALSE, FALSE, sizeof(merged));
  bool *taken = g_new0(bool, G_MAXUINT16 + 1);
  take(first, folder, taken, all);
  if (second) take(second, folder, taken, all);
  g_free(taken);
  if (folder == EXIF_MAIN && has(first, second, EXIF_EXIF)) add_pointer(all, POINTER_EXIF);
  if (folder == EXIF_MAIN && has(first, second, EXIF_GPS)) add_pointer(all, POINTER_GPS);
  if (folder == EXIF_EXIF && has(first, second, EXIF_INTEROP)) add_pointer(all, POINTER_INTEROP);
  g_array_sort(all, by_tag);
  while ((to->len - start) % 2) g_byte_array_append(to, (const guint8 *)"", 1);
  guint at = to->len;
  put16(to, all->len);
  g_byte_array_set_size(to, at + 2 + 12 * all->len + 4);
  memset(to->data + at + 2, 0, 12 * all->len + 4);
  for (guint i = 0; i < all->len; i++) {
    const merged *one = &g_array_index(all, merged, i);
    exif_folder below;
    GByteArray *head = g_byte_array_new();
    put16(head, one->tag);
    put16(head, one->entry ? one->entry->type : 4);
    put32(head, one->entry ? one->entry->count : 1);
    if (!one->entry) {
      is_pointer(one->tag, &below);
      put32(head, append_folder(first, second, below, to, start));
    } else if (one->entry->size <= 4) {
      put_value(head, one->entry, one->big);
    } else {
      while ((to->len - start) % 2) g_byte_array_append(to, (const guint8 *)"", 1);
      put32(head, to->len - start);
      put_value(to, one->entry, one->big);
    }
    memcpy(to->data + at + 2 + 12 * i, head->data, head->len);
    g_byte_array_unref(head);
  }
  g_array_unref(all);
  return at - start;
}

uint32_t exif_append(const exif_tree *first, const exif_tree *second, GByteArray *to, guint start) {
  uint32_t offset = append_folder(first, second, EXIF_MAIN, to, start);
  patch32(to, start + 4, offset);
  return offset;
}

/* ------------------------------------------------------------------------------ thumbnails -- */

/* Of a chain: two are usual, three are known. */
enum { MOST_FOLDERS = 16 };

typedef struct blanking {
  source from;
  uint8_t *bytes;
  size_t left; /* bytes that pictures may have: these do not overlap, so no more than there are */
  size_t folders[MOST_FOLDERS];
  unsigned count;
} blanking;

static size_t number_at(const source *from, const exif_entry *entry, size_t index) {
  const uint8_t *at = entry->value + index * type_size(entry->type);
  if (entry->type == 3) return get16(from->big, at);
  return entry->type >= TYPE_WORD ? get_word(from, at) : get32(from->big, at);
}

static bool is_number(const exif_entry *entry) {
  return entry->type == 3 || entry->type == 4 || entry->type == 13 || entry->type >= TYPE_WORD;
}

/* Then it is no picture's place. */
static bool meets_folder(const blanking *now, size_t offset, size_t length) {
  for (unsigned i = 0; i < now->count; i++) {
    const uint8_t *end =
        entry_at(&now->from, now->folders[i], folder_size(&now->from, now->folders[i]));
    if (offset < (size_t)(end - now->from.bytes) && now->folders[i] < offset + length) return true;
  }
  return false;
}

static bool blank_pieces(blanking *now, const exif_entry *offsets, const exif_entry *lengths) {
  if (!offsets->value || !lengths->value) return true;
  for (size_t i = 0; i < MIN(offsets->count, lengths->count); i++) {
    size_t offset = number_at(&now->from, offsets, i), length = number_at(&now->from, lengths, i);
    if (length == 0 || offset < 8 || offset >= now->from.size) continue;
    length = MIN(length, now->from.size - offset);
    if (length > now->left || meets_folder(now, offset, length)) return false;
    now->left -= length;
    memset(now->bytes + offset, 0, length);
  }
  return true;
}

static bool add_folder(blanking *now, size_t offset) {
  if (folder_size(&now->from, offset) == 0) return true;
  for (unsigned i = 0; i < now->count; i++)
    if (now->folders[i] == offset) return true;
  if (now->count == MOST_FOLDERS) return false;
  now->folders[now->count++] = offset;
  return true;
}

/* Where the place of the next folder is; NULL: beyond the end. */
static uint8_t *next_of(const blanking *now, size_t folder) {
  size_t count = folder_size(&now->from, folder);
  size_t next = (size_t)(entry_at(&now->from, folder, count) - now->from.bytes);
  return word_size(&now->from) <= now->from.size - next ? now->bytes + next : NULL;
}

/* Lists a folder's own folders and the next one, then blanks its pictures: a whole one, strips,
 * tiles. In the first folder these two are what programs leave of a TIFF, and lead nowhere. */
static bool blank_folder(blanking *now, size_t folder) {
  static const uint16_t pairs[][2] = {{0x201, 0x202}, {273, 279}, {324, 325}};
  exif_entry found[G_N_ELEMENTS(pairs)][2] = {{{0}}}, entry;
  size_t count = folder_size(&now->from, folder);
  const uint8_t *next = next_of(now, folder);
  bool good = !next || add_folder(now, get_word(&now->from, next));
  for (size_t i = 0; i < count && good; i++) {
    if (!read_entry(&now->from, entry_at(&now->from, folder, i), &entry) || !is_number(&entry))
      continue;
    if (entry.tag == SUB_FOLDERS) good = entry.count <= MOST_FOLDERS;
    for (size_t k = 0; entry.tag == SUB_FOLDERS && k < entry.count && good; k++)
      good = add_folder(now, number_at(&now->from, &entry, k));
    for (size_t k = 0; k < 2 * G_N_ELEMENTS(pairs); k++)
      if (entry.tag == pairs[k / 2][k % 2]) found[k / 2][k % 2] = entry;
  }
  size_t kinds = folder == now->folders[0] ? 1 : G_N_ELEMENTS(pairs);
  for (size_t i = 0; i < kinds && good; i++) good = blank_pieces(now, &found[i][0], &found[i][1]);
  return good;
}

bool exif_blank_thumbnails(uint8_t *bytes, size_t size) {
  blanking now = {.bytes = bytes, .left = size};
  if (!open_source(bytes, size, &now.from)) return true;
  if (!add_folder(&now, first_folder(&now.from)) || now.count == 0) return now.count == 0;
  for (unsigned i = 0; i < now.count; i++)
    if (!blank_folder(&now, now.folders[i])) return false;
  uint8_t *next = next_of(&now, now.folders[0]);
  if (next) memset(next, 0, word_size(&now.from));
  return true;
}
