/* intl.h - messages of the plug-in, in the text domain "recede". */
#ifndef RP_INTL_H
#define RP_INTL_H

#include <libintl.h>

#define RP_DOMAIN "recede"
#define _(text) dgettext(RP_DOMAIN, text)
#define N_(text) text

/* Catalogues lie in locale/ beside the executable (a user's folder), else in the system's place. */
void rp_translations_start(const char *executable);

#endif
