/* intl.h - messages of the plug-in, in the text domain "recede". */
#ifndef RP_INTL_H
#define RP_INTL_H

#include <libintl.h>

#define RP_DOMAIN "recede"
#define _(text) dgettext(RP_DOMAIN, text)
#define N_(text) text

/* Catalogues lie in locale/ beside the executable (a user's folder), else in the system's place. */
void rp_translations_start(const char *executable);
/* A file or folder of the plug-in's own, beside the executable; NULL when it is not there (free).
 */
char *rp_own_file(const char *executable, const char *name);

#endif
