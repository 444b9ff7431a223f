/* Where the catalogues are. */
#include "intl.h"

#include <glib.h>

void rp_translations_start(const char *executable) {
  char *folder = g_path_get_dirname(executable);
  char *beside = g_build_filename(folder, "locale", NULL);
  bindtextdomain(RP_DOMAIN, g_file_test(beside, G_FILE_TEST_IS_DIR) ? beside : RP_LOCALEDIR);
  bind_textdomain_codeset(RP_DOMAIN, "UTF-8");
  g_free(beside);
  g_free(folder);
}
