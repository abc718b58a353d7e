// Calls of the system for files and processes that may be refused like requests for
// memory (see refused_requests.h). Included by one file of a test.
#pragma once

#include <dirent.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/syscall.h>

#include "tests/refused_requests.h"

// --- files -----------------------------------------------------------------------------

int __real_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...);
int __wrap_open64(const char *path, int flags, ...)
{
    va_list list;
    va_start(list, flags);
    const unsigned mode = flags & O_CREAT ? va_arg(list, unsigned) : 0;
    va_end(list);
    if (refuses()) {
        errno = EMFILE;
        return -1;
    }
    return __real_open64(path, flags, mode);
}

int __real_openat64(int folder, const char *path, int flags, ...);
int __wrap_openat64(int folder, const char *path, int flags, ...);
int __wrap_openat64(int folder, const char *path, int flags, ...)
{
    if (refuses()) {
        errno = EMFILE;
        return -1;
    }
    return __real_openat64(folder, path, flags);
}

static long folders_opened;
static bool refuses_folder(void)
{
    folders_opened++;
    return refuses();
}
REFUSABLE(refuses_folder(), DIR *, opendir, NULL, EMFILE, (const char *path), (path))
REFUSABLE(refuses(), FILE *, fopen64, NULL, EMFILE, (const char *path, const char *mode),
          (path, mode))
REFUSABLE(refuses(), FILE *, tmpfile64, NULL, ENOSPC, (void), ())
REFUSABLE(refuses(), int, mkstemp64, -1, ENOSPC, (char *path), (path))
REFUSABLE(refuses(), int, flock, -1, ENOLCK, (int fd, int how), (fd, how))
REFUSABLE(refuses(), int, fsync, -1, EIO, (int fd), (fd))
REFUSABLE(refuses(), int, rename, -1, EPERM, (const char *from, const char *to),
          (from, to))
REFUSABLE(refuses(), int, access, -1, EACCES, (const char *path, int how), (path, how))
REFUSABLE(refuses(), int, stat64, -1, EACCES, (const char *path, struct stat *about),
          (path, about))
REFUSABLE(refuses(), int, lstat64, -1, EACCES, (const char *path, struct stat *about),
          (path, about))
REFUSABLE(refuses(), int, fstat64, -1, EIO, (int fd, struct stat *about), (fd, about))
REFUSABLE(refuses(), ssize_t, write, -1, ENOSPC, (int fd, const void *bytes, size_t size),
          (fd, bytes, size))

// Data that could not be written are reported when the file is closed; it is closed in
// any case.
int __real_close(int fd);
int __wrap_close(int fd);
int __wrap_close(int fd)
{
    const bool refused = refuses();
    const int result = __real_close(fd);
    errno = refused ? EDQUOT : errno;
    return refused ? -1 : result;
}

// --- processes -------------------------------------------------------------------------

REFUSABLE(refuses(), int, socketpair, -1, EMFILE,
          (int domain, int type, int protocol, int *ends), (domain, type, protocol, ends))
REFUSABLE(refuses(), int, pipe2, -1, EMFILE, (int *ends, int flags), (ends, flags))
REFUSABLE(refuses(), int, dup2, -1, EMFILE, (int from, int to), (from, to))
REFUSABLE(refuses(), pid_t, fork, -1, EAGAIN, (void), ())

// To copy a descriptor may be refused, to change one may not.
int __real_fcntl64(int fd, int command, ...);
int __wrap_fcntl64(int fd, int command, ...);
int __wrap_fcntl64(int fd, int command, ...)
{
    va_list list;
    va_start(list, command);
    const int value = va_arg(list, int);
    va_end(list);
    if (command == F_DUPFD && refuses()) {
        errno = EMFILE;
        return -1;
    }
    return __real_fcntl64(fd, command, value);
}

// An older kernel does not close a range of descriptors at once.
long __real_syscall(long number, ...);
long __wrap_syscall(long number, ...);
long __wrap_syscall(long number, ...)
{
    long words[3];
    va_list list;
    va_start(list, number);
    for (int i = 0; i < 3; i++) {
        words[i] = va_arg(list, long);
    }
    va_end(list);
    if (refuses()) {
        errno = ENOSYS;
        return -1;
    }
    return __real_syscall(number, words[0], words[1], words[2]);
}

// A signal interrupts the k-th, and does not go on for ever.
static bool interrupts(void)
{
    return refuses() && atomic_load(&requests) == refused_at;
}
static long reads, unreadable_at; // of reads, the one that fails for good; 0: none
ssize_t __real_read(int fd, void *bytes, size_t size);
ssize_t __wrap_read(int fd, void *bytes, size_t size);
ssize_t __wrap_read(int fd, void *bytes, size_t size)
{
    const bool interrupted = interrupts();
    if (interrupted || ++reads == unreadable_at) {
        errno = interrupted ? EINTR : EIO;
        return -1;
    }
    return __real_read(fd, bytes, size);
}
REFUSABLE(interrupts(), int, poll, -1, EINTR,
          (struct pollfd * ends, nfds_t count, int ms), (ends, count, ms))
REFUSABLE(interrupts(), ssize_t, send, -1, EINTR,
          (int fd, const void *bytes, size_t size, int flags), (fd, bytes, size, flags))
REFUSABLE(interrupts(), pid_t, waitpid, -1, EINTR, (pid_t which, int *ended, int how),
          (which, ended, how))
