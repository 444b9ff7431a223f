/* Where the catalogues are. */
#include "intl.h"

#include <glib.h>

char *rp_own_file(const char *executable, const char *name) {
  char *folder = g_path_get_dirname(executable);
  char *path = g_build_filename(folder, name, NULL);
  g_free(folder);
  if (!g_file_test(path, G_FILE_TEST_EXISTS)) g_clear_pointer(&path, g_free);
  return path;
}

void rp_translations_start(const char *executable) {
  char *beside = rp_own_file(executable, "locale");
  bindtextdomain(RP_DOMAIN, beside ? beside : RP_LOCALEDIR);
  bind_textdomain_codeset(RP_DOMAIN, "UTF-8");
  g_free(beside);
}
