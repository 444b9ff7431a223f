/* safe_file.h - writes a file whole or not at all.
 *
 * The bytes go to a temporary file in the target's folder, created with O_EXCL under a name that
 * can be recognised (.recede-PID-NUMBER.tmp), are forced to the disk, and only then take the
 * target's name in one step. Whatever happens on the way (disk full, a signal, power lost), the
 * name holds the old file or the new one. Only kill -9 and a crash of the machine leave the
 * temporary behind.
 */
#ifndef RECEDE_SAFE_FILE_H
#define RECEDE_SAFE_FILE_H

#include <stdbool.h>
#include <stddef.h>

/* Whether path could be written, asked before hours of work. false: why not, in message. */
bool safe_file_check(const char *path, bool overwrite, char *message, size_t message_size);

/* Whether two names lead to one file, be it there already or not. */
bool safe_file_same(const char *a, const char *b);

/* Without overwrite a file that exists stays, even one that appeared in the meantime. A file that
 * is replaced hands down its permissions; a symbolic link stays and its target is replaced. false:
 * nothing changed, the reason is in message. */
bool safe_file_write(const char *path, const void *bytes, size_t size, bool overwrite,
                     char *message, size_t message_size);

/* Removes the temporary file that is being written, if any. Safe in a signal handler, after which
 * the process must end. */
void safe_file_abandon(void);

#endif
