// Preloaded into the program: makes the FAIL_AT-th call of the function named by
// FAIL_CALL fail, and writes how many calls there were to the file FAIL_COUNT.
#undef _FILE_OFFSET_BITS // both names of open are wanted, each as itself
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

int open64(const char *path, int flags, ...);
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);

static const char *which;
static long at, begun;
static atomic_long calls;

__attribute__((constructor)) static void begin(void)
{
    const char *k = getenv("FAIL_AT");
    which = getenv("FAIL_CALL");
    at = k != NULL ? atol(k) : 0;
    begun = which != NULL;
}

__attribute__((destructor)) static void end(void)
{
    const char *path = getenv("FAIL_COUNT");
    begun = 0;
    if (path != NULL) {
        FILE *file = fopen(path, "w");
        if (file != NULL) {
            fprintf(file, "%ld\n", atomic_load(&calls));
            fclose(file);
        }
    }
}

// For programs that count branches, before they write their counts.
void fail_nothing_more(void);
void fail_nothing_more(void)
{
    begun = 0;
}

static bool fails(const char *name)
{
    return begun && strcmp(which, name) == 0 && atomic_fetch_add(&calls, 1) + 1 == at;
}

void *malloc(size_t size)
{
    return fails("malloc") ? (errno = ENOMEM, NULL) : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails("malloc") ? (errno = ENOMEM, NULL) : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    return fails("malloc") ? (errno = ENOMEM, NULL) : __libc_realloc(memory, size);
}

// The function that stands behind ours.
#define REAL(name)                                                                       \
    do {                                                                                 \
        void *found = dlsym(RTLD_NEXT, #name);                                           \
        memcpy(&real, &found, sizeof real);                                              \
    } while (0)

ssize_t write(int file, const void *bytes, size_t size)
{
    ssize_t (*real)(int, const void *, size_t);
    struct stat about;
    REAL(write);
    bool regular = begun && fstat(file, &about) == 0 && S_ISREG(about.st_mode);
    return regular && fails("write") ? (errno = ENOSPC, -1) : real(file, bytes, size);
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off64_t offset)
{
    ssize_t (*real)(int, const void *, size_t, off64_t);
    REAL(pwrite64);
    return fails("write") ? (errno = ENOSPC, -1) : real(file, bytes, size, offset);
}

int fsync(int file)
{
    int (*real)(int);
    REAL(fsync);
    return fails("fsync") ? (errno = EIO, -1) : real(file);
}

int fdatasync(int file)
{
    int (*real)(int);
    REAL(fdatasync);
    return fails("fsync") ? (errno = EIO, -1) : real(file);
}

int rename(const char *from, const char *to)
{
    int (*real)(const char *, const char *);
    REAL(rename);
    return fails("rename") ? (errno = EIO, -1) : real(from, to);
}

#define OPEN(name)                                                                       \
    int name(const char *path, int flags, ...)                                           \
    {                                                                                    \
        int (*real)(const char *, int, ...);                                             \
        va_list list;                                                                    \
        va_start(list, flags);                                                           \
        mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;   \
        va_end(list);                                                                    \
        REAL(name);                                                                      \
        return fails("open") ? (errno = EMFILE, -1) : real(path, flags, mode);           \
    }
OPEN(open)
OPEN(open64)
