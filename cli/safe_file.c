#include "safe_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

/* The temporary's full name; read by the signal handler, so only changed with signals blocked. */
static char temporary[PATH_MAX];

void safe_file_abandon(void) {
  if (temporary[0]) unlink(temporary);
}

static sigset_t block_signals(void) {
  sigset_t all, old;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &old);
  return old;
}
static void restore_signals(sigset_t old) { pthread_sigmask(SIG_SETMASK, &old, NULL); }

static bool refuse(char *message, size_t size, int error, const char *what) {
  const char *hint = error == EEXIST    ? "it exists; --force replaces it"
                     : error == ENOENT  ? "there is no such folder"
                     : error == ENOTDIR ? "there is no such folder"
                     : error == EISDIR  ? "it is a folder"
                                        : strerror(error);
  snprintf(message, size, "%s%s%s", what, what[0] ? ": " : "", hint);
  return false;
}

/* The name that is to be replaced: where a symbolic link points to, else path itself. */
static bool resolve(const char *path, char target[PATH_MAX]) {
  struct stat status;
  if (lstat(path, &status) == 0 && S_ISLNK(status.st_mode)) return realpath(path, target) != NULL;
  if (strlen(path) >= PATH_MAX) {
    errno = ENAMETOOLONG;
    return false;
  }
  strcpy(target, path);
  return true;
}

static void folder_of(const char *path, char folder[PATH_MAX]) {
  const char *slash = strrchr(path, '/');
  size_t length = !slash ? 1 : slash == path ? 1 : (size_t)(slash - path);
  memcpy(folder, slash ? path : ".", length);
  folder[length] = '\0';
}

bool safe_file_check(const char *path, bool overwrite, char *message, size_t size) {
  char target[PATH_MAX], folder[PATH_MAX];
  struct stat status;
  /* Of /dev/stdout the link leads to no name, but there is something. */
  if (stat(path, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
    snprintf(message, size, "it is no ordinary file; write to a file");
    return false;
  }
  if (!resolve(path, target)) {
    if (errno != ENOENT) return refuse(message, size, errno, "");
    snprintf(message, size, "it is a link to a file that is not there; remove it first");
    return false;
  }
  if (stat(target, &status) == 0) {
    if (S_ISDIR(status.st_mode)) return refuse(message, size, EISDIR, "");
    if (!overwrite) return refuse(message, size, EEXIST, "");
  } else if (errno != ENOENT) {
    return refuse(message, size, errno, "");
  }
  folder_of(target, folder);
  if (access(folder, W_OK | X_OK) != 0)
    return refuse(message, size, errno, errno == ENOENT ? "" : "its folder");
  return true;
}

static bool same_inode(const struct stat *a, const struct stat *b) {
  return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

static const char *last_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

bool safe_file_same(const char *a, const char *b) {
  char folder_a[PATH_MAX], folder_b[PATH_MAX];
  struct stat status_a, status_b;
  bool there_a = stat(a, &status_a) == 0, there_b = stat(b, &status_b) == 0;
  if (there_a || there_b) return there_a && there_b && same_inode(&status_a, &status_b);
  if (strlen(a) >= PATH_MAX || strlen(b) >= PATH_MAX) return false; /* it will not be written */
  folder_of(a, folder_a);
  folder_of(b, folder_b);
  return stat(folder_a, &status_a) == 0 && stat(folder_b, &status_b) == 0 &&
         same_inode(&status_a, &status_b) && strcmp(last_name(a), last_name(b)) == 0;
}

/* 666 less the umask, which can only be read by setting it. */
static mode_t mode_of_new_file(void) {
  mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

static mode_t mode_for(const char *target) {
  struct stat status;
  return stat(target, &status) == 0 ? status.st_mode & 07777 : mode_of_new_file();
}

static int create_temporary(const char *folder, mode_t mode) {
  char name[PATH_MAX];
  for (int attempt = 0; attempt < 16; attempt++) {
    uint64_t number = 0;
    if (getrandom(&number, sizeof number, 0) != (ssize_t)sizeof number) return -1;
    int length = snprintf(name, sizeof name, "%s/.recede-%ld-%016llx.tmp", folder, (long)getpid(),
                          (unsigned long long)number);
    if (length < 0 || length >= (int)sizeof name) {
      errno = ENAMETOOLONG;
      return -1;
    }
    sigset_t old = block_signals();
    int fd = open(name, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, mode);
    if (fd >= 0) strcpy(temporary, name);
    restore_signals(old);
    if (fd >= 0 || errno != EEXIST) return fd;
  }
  return -1;
}

static bool write_all(int fd, const char *bytes, size_t size) {
  while (size > 0) {
    /* Linux writes at most 2^31 - 4096 bytes at a time; smaller steps let signals in. */
    ssize_t written = write(fd, bytes, size < (1 << 24) ? size : 1 << 24);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes += written;
    size -= (size_t)written;
  }
  return true;
}

/* Where neither renameat2's flag nor link() is had (some FUSE mounts): an empty file takes the name
 * first, which fails where there is one. Between the two steps signals wait. */
static bool take_name_by_two_steps(const char *target) {
  sigset_t old = block_signals();
  int fd = open(target, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC | O_NOFOLLOW, 0600);
  bool good = fd >= 0 && rename(temporary, target) == 0;
  int error = errno;
  if (fd >= 0) {
    if (!good) unlink(target);
    close(fd);
  }
  restore_signals(old);
  errno = error;
  return good;
}

/* link() never replaces, on every file system that has it; others get renameat2's flag. */
static bool take_name(const char *target, bool overwrite) {
  if (overwrite) return rename(temporary, target) == 0;
  if (renameat2(AT_FDCWD, temporary, AT_FDCWD, target, RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  if (link(temporary, target) == 0) return unlink(temporary) == 0;
  if (errno != EPERM && errno != ENOSYS && errno != EOPNOTSUPP) return false;
  return take_name_by_two_steps(target);
}

/* A file system that cannot sync folders (EINVAL) has nothing to sync: the name is there. */
static void sync_folder(const char *folder) {
  int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  fsync(fd);
  close(fd);
}

static bool fill_temporary(int fd, const char *target, mode_t mode, const void *bytes,
                           size_t size) {
  struct stat status;
  /* open() applied the umask; an overwritten file's permissions may be wider. */
  bool good = fchmod(fd, mode) == 0 || errno == EPERM;
  /* Another's file stays another's where we may do that. */
  if (stat(target, &status) == 0 && fchown(fd, status.st_uid, status.st_gid) != 0) errno = 0;
  good = good && write_all(fd, bytes, size) && fsync(fd) == 0;
  int error = errno;
  if (close(fd) != 0 && good) return false;
  errno = error;
  return good;
}

bool safe_file_write(const char *path, const void *bytes, size_t size, bool overwrite,
                     char *message, size_t message_size) {
  char target[PATH_MAX], folder[PATH_MAX];
  if (!safe_file_check(path, overwrite, message, message_size)) return false;
  if (!resolve(path, target)) return refuse(message, message_size, errno, "");
  folder_of(target, folder);
  mode_t mode = mode_for(target);
  int fd = create_temporary(folder, mode & 0777);
  if (fd < 0) return refuse(message, message_size, errno, "");
  bool good = fill_temporary(fd, target, mode, bytes, size) && take_name(target, overwrite);
  int error = errno;
  sigset_t old = block_signals();
  if (!good) unlink(temporary);
  temporary[0] = '\0';
  restore_signals(old);
  if (!good) return refuse(message, message_size, error, "");
  sync_folder(folder);
  return true;
}
