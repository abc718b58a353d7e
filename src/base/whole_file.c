#include "src/base/whole_file.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static status cannot_write(fault *f, const char *path, int reason)
{
    bool standard_output = strcmp(path, "-") == 0;
    return fault_set(f, STATUS_CANNOT_WRITE, "%s%s%s cannot be written: %s",
                     standard_output ? "the standard output" : "'", standard_output ? "" : path,
                     standard_output ? "" : "'", strerror(reason));
}

enum { MOST_LINKS = 40 }; // followed one after the other, as the kernel does

// Names of temporaries that exist just now, for the signal handler; a few files at once are plenty,
// and one without a place is merely not cleaned up after a signal.
enum { MOST_UNFINISHED = 8 };
static _Atomic(char *) unfinished[MOST_UNFINISHED];

static void remember_unfinished(char *name)
{
    for (int i = 0; i < MOST_UNFINISHED; i++) {
        char *none = NULL;
        if (atomic_compare_exchange_strong(&unfinished[i], &none, name)) {
            return;
        }
    }
}

static void forget_unfinished(char *name)
{
    for (int i = 0; i < MOST_UNFINISHED && name != NULL; i++) {
        char *mine = name;
        if (atomic_compare_exchange_strong(&unfinished[i], &mine, NULL)) {
            return;
        }
    }
}

void whole_file_remove_unfinished(void)
{
    for (int i = 0; i < MOST_UNFINISHED; i++) {
        char *name = atomic_load(&unfinished[i]);
        if (name != NULL) {
            unlink(name);
        }
    }
}

// Length of path's folder with its slash, 0 if it has none.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

// The folder of path, "." if it names none; NULL without memory.
static char *folder_of(const char *path)
{
    size_t length = folder_length(path);
    return length ? strndup(path, length) : strdup(".");
}

// Where a path leads, be it there or not: a link stays a link and its target is what gets written.
// NULL without memory.
static char *target_of(const char *path)
{
    char *target = strdup(path);

    // link by link
    for (int links = 0; target != NULL && links < MOST_LINKS; links++) {
        char link[PATH_MAX];
        ssize_t length = readlink(target, link, sizeof link - 1);
        if (length < 0) {
            break;
        }
        link[length] = '\0';

        char *next;
        int folder = link[0] == '/' ? 0 : (int)folder_length(target);
        if (asprintf(&next, "%.*s%s", folder, target, link) < 0) {
            next = NULL;
        }

        free(target);
        target = next;
    }
    return target;
}

// 0 if target can be replaced or created, else the reason.
static int obstacle(const char *path, bool *in_place, mode_t *mode)
{
    struct stat about;
    *in_place = false;
    *mode = 0;
    if (path[0] == '\0') {
        return ENOENT;
    }

    // what stands there already
    if (stat(path, &about) == 0) {
        if (S_ISDIR(about.st_mode)) {
            return EISDIR;
        }
        *in_place = !S_ISREG(about.st_mode);
        *mode = about.st_mode & 07777;
        if (access(path, W_OK) != 0) {
            return errno;
        }
        if (*in_place) {
            return 0;
        }
    } else if (errno != ENOENT) {
        return errno;
    }

    // what stands beside it, as a temporary will
    char *folder = folder_of(path);
    if (folder == NULL) {
        return ENOMEM;
    }
    int reason = access(folder, W_OK | X_OK) == 0 ? 0 : errno;
    if (reason == 0 && path[strlen(path) - 1] == '/') {
        reason = EISDIR;
    }
    free(folder);
    return reason;
}

status whole_file_check(const char *path, fault *f)
{
    assert(path != NULL);
    bool in_place;
    mode_t mode;
    int reason = strcmp(path, "-") == 0 ? 0 : obstacle(path, &in_place, &mode);
    return reason == 0 ? STATUS_OK : cannot_write(f, path, reason);
}

// Creates an empty file with a name of its own beside w->path. Returns the descriptor or -1.
static int create_temporary(whole_file *w, mode_t mode)
{
    int folder = (int)folder_length(w->path);
    for (int attempt = 0; attempt < 1000; attempt++) {
        if (asprintf(&w->temporary, "%.*s.impactlab-%ld-%d.part", folder, w->path, (long)getpid(),
                     attempt) < 0) {
            w->temporary = NULL;
            errno = ENOMEM;
            return -1;
        }

        // creating it tells whether the name is free
        int descriptor = open(w->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0) {
            remember_unfinished(w->temporary);
            if (mode != 0) {
                // not owning the old file is no reason to write nothing
                (void)!fchmod(descriptor, mode);
            }
            return descriptor;
        }

        free(w->temporary);
        w->temporary = NULL;
        if (errno != EEXIST) {
            return -1;
        }
    }
    return -1;
}

// Opens the target or its temporary; 0 or the reason why not.
static int open_target(whole_file *w)
{
    // what hinders it is known before anything is created
    bool in_place;
    mode_t mode;
    int reason = obstacle(w->path, &in_place, &mode);
    if (reason != 0) {
        return reason;
    }

    // a file stands under a name of its own until it is whole
    int descriptor = in_place ? open(w->path, O_WRONLY | O_CLOEXEC) : create_temporary(w, mode);
    if (descriptor < 0) {
        return errno;
    }

    w->stream = fdopen(descriptor, "w");
    if (w->stream == NULL) {
        reason = errno;
        close(descriptor);
        if (w->temporary != NULL) {
            unlink(w->temporary);
            forget_unfinished(w->temporary);
        }
        return reason;
    }
    return 0;
}

status whole_file_open(whole_file *w, const char *path, fault *f)
{
    assert(w != NULL && path != NULL);
    memset(w, 0, sizeof *w);
    if (strcmp(path, "-") == 0) {
        w->stream = stdout;
        w->path = strdup(path);
        return w->path ? STATUS_OK : cannot_write(f, path, ENOMEM);
    }

    // a file: where the path leads in the end
    w->path = target_of(path);
    int reason = w->path ? open_target(w) : ENOMEM;
    if (reason != 0) {
        free(w->path);
        free(w->temporary);
        memset(w, 0, sizeof *w);
        return cannot_write(f, path, reason);
    }
    return STATUS_OK;
}

int stream_failure(FILE *stream)
{
    assert(stream != NULL);
    errno = 0;
    if (fflush(stream) == 0 && !ferror(stream)) {
        return 0;
    }
    // the write that failed may lie far back, with its errno lost: a pipe still tells
    struct pollfd end = {.fd = fileno(stream), .events = POLLOUT};
    if (errno == 0 && poll(&end, 1, 0) == 1 && (end.revents & POLLERR) != 0) {
        return EPIPE;
    }
    return errno != 0 ? errno : EIO;
}

// Flushes the stream down to the disk; 0 or the reason why not.
static int flush_to_disk(whole_file *w)
{
    int reason = stream_failure(w->stream);
    if (reason != 0) {
        return reason;
    }
    // a pipe or a device has no disk to reach
    if (w->temporary != NULL && fsync(fileno(w->stream)) != 0) {
        return errno;
    }
    return 0;
}

status whole_file_commit(whole_file *w, fault *f)
{
    assert(w != NULL && w->stream != NULL && w->path != NULL);
    int reason = flush_to_disk(w);
    bool standard_output = w->stream == stdout;
    if (standard_output) {
        reason = reason == EPIPE ? 0 : reason;
    } else if (fclose(w->stream) != 0 && reason == 0) {
        reason = errno;
    }

    // the new file takes the place of the old one, or goes
    if (w->temporary != NULL) {
        if (reason == 0 && rename(w->temporary, w->path) != 0) {
            reason = errno;
        }
        if (reason != 0) {
            unlink(w->temporary);
        }
    }

    status result = reason == 0 ? STATUS_OK : cannot_write(f, w->path, reason);
    forget_unfinished(w->temporary);
    free(w->path);
    free(w->temporary);
    memset(w, 0, sizeof *w);
    return result;
}

void whole_file_abandon(whole_file *w)
{
    assert(w != NULL);
    if (w->stream != NULL && w->stream != stdout) {
        fclose(w->stream);
    }
    if (w->temporary != NULL) {
        unlink(w->temporary);
        forget_unfinished(w->temporary);
    }
    free(w->path);
    free(w->temporary);
    memset(w, 0, sizeof *w);
}

status whole_file_close(whole_file *w, status written, fault *f)
{
    if (written != STATUS_OK) {
        whole_file_abandon(w);
        return written;
    }
    return whole_file_commit(w, f);
}
