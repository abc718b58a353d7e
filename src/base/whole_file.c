#include "src/base/whole_file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "src/base/text_stream.h"

static status cannot_write(fault *f, const char *path, int reason)
{
    FAULT_IF(path[0] == '\0', f, STATUS_CANNOT_WRITE,
             "the standard output cannot be written: %s", strerror(reason));
    return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path,
                     strerror(reason));
}

// --- where a path leads ----------------------------------------------------------------

// Length of path's folder with its slash, 0 if it has none.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL) {
        return 0;
    }
    return (size_t)(slash - path) + 1;
}

// The folder of path, "." if it names none.
static const char *folder_of(const char *path, char folder[PATH_MAX])
{
    const int length = (int)folder_length(path);
    if (length == 0) {
        return ".";
    }
    snprintf(folder, PATH_MAX, "%.*s", length, path);
    return folder;
}

// Whether something with this mode is written in place and not replaced: a device or a
// pipe. The mode is 0 where there is nothing.
static bool is_in_place(mode_t mode)
{
    return mode != 0 && !S_ISREG(mode);
}

// Finds where a path leads, through links, and the mode of what is there, 0 for nothing.
// Returns 0, or the errno for which it can be neither replaced nor created.
static int find_target(const char *path, char target[PATH_MAX], mode_t *mode)
{
    struct stat about = {.st_mode = 0};
    char folder[PATH_MAX];
    if (path[0] == '\0') {
        return ENOENT;
    }
    if (snprintf(target, PATH_MAX, "%s", path) >= PATH_MAX) {
        return ENAMETOOLONG;
    }

    // what is there already must be writable
    if (stat(path, &about) != 0 && errno != ENOENT) {
        return errno;
    }
    *mode = about.st_mode;
    if (S_ISDIR(*mode)) {
        return EISDIR;
    }
    if (*mode != 0 && access(path, W_OK) != 0) {
        return errno;
    }

    // a link to it stays a link
    if (*mode != 0 && lstat(path, &about) == 0 && S_ISLNK(about.st_mode) &&
        realpath(path, target) == NULL) {
        return errno;
    }

    // and its folder must take a temporary
    if (!is_in_place(*mode) && access(folder_of(target, folder), W_OK | X_OK) != 0) {
        return errno;
    }
    return 0;
}

status whole_file_check(const char *path, fault *f)
{
    char target[PATH_MAX];
    mode_t mode;
    if (strcmp(path, "-") == 0) {
        return STATUS_OK;
    }
    const int reason = find_target(path, target, &mode);
    if (reason != 0) {
        return cannot_write(f, path, reason);
    }
    return STATUS_OK;
}

// Whether two paths name one file, or one folder, that is there.
static bool is_same_file(const char *path, const char *other)
{
    struct stat a, b;
    return stat(path, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

// Whether two results, or a result and an input, would be one file.
bool whole_file_same_place(const char *path, const char *other)
{
    char folder[PATH_MAX], other_folder[PATH_MAX];
    if (strcmp(path, "-") == 0 || strcmp(other, "-") == 0) {
        return strcmp(path, other) == 0;
    }
    if (is_same_file(path, other)) {
        return true;
    }

    // one name in one folder, a file be there or not
    return strcmp(path + folder_length(path), other + folder_length(other)) == 0 &&
           is_same_file(folder_of(path, folder), folder_of(other, other_folder));
}

// --- temporaries that exist just now ---------------------------------------------------

// For the signal handler; a few files at once are plenty, and one without a place is
// merely not removed after a signal.
enum { MOST_UNFINISHED = 8 };
static _Atomic(const char *) unfinished[MOST_UNFINISHED];

// Puts a name, NULL for none, in the place of another.
static void replace_unfinished(const char *before, const char *name)
{
    bool replaced = false;
    for (int i = 0; i < MOST_UNFINISHED && !replaced; i++) {
        const char *expected = before;
        replaced = atomic_compare_exchange_strong(&unfinished[i], &expected, name);
    }
}

void whole_file_remove_unfinished(void)
{
    for (int i = 0; i < MOST_UNFINISHED; i++) {
        const char *name = atomic_load(&unfinished[i]);
        if (name != NULL) {
            unlink(name);
        }
    }
}

// --- writing ---------------------------------------------------------------------------

// Where the bytes of a stream go. The stream itself does not keep why a write failed.
static ssize_t write_to_file(void *context, const char *bytes, size_t size)
{
    whole_file *w = context;
    size_t done = 0;
    while (done < size) {
        const ssize_t written = write(w->descriptor, bytes + done, size - done);
        if (written < 0 && errno == EINTR) {
            continue; // a signal came first
        }
        if (written < 0) {
            if (w->reason == 0) {
                w->reason = errno;
            }
            return 0;
        }
        done += (size_t)written;
    }
    return (ssize_t)size;
}

// Creates an empty file with a name of its own beside the target, with the mode of the
// file that it will replace, if any. Returns its descriptor, or -1 with errno.
static int create_temporary(whole_file *w, mode_t mode)
{
    static atomic_int number;
    int descriptor;

    // a name that is taken was left by a killed run of the same process number
    do {
        const int length =
            snprintf(w->temporary, PATH_MAX, "%.*s.impactlab-%ld-%d.part",
                     (int)folder_length(w->path), w->path, (long)getpid(), number++);
        if (length >= PATH_MAX) {
            errno = ENAMETOOLONG;
            return -1;
        }
        descriptor = open(w->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);

    if (descriptor >= 0) {
        replace_unfinished(NULL, w->temporary);
    }
    if (descriptor >= 0 && mode != 0) {
        // not owning the old file is no reason to write nothing
        (void)!fchmod(descriptor, mode & 07777);
    }
    return descriptor;
}

// Removes a temporary, if there is one, that does not become the target.
static void remove_temporary(whole_file *w)
{
    unlink(w->temporary);
    replace_unfinished(w->temporary, NULL);
}

// Opens the stream to a temporary beside the target, to a device, or to the output.
status whole_file_open(whole_file *w, const char *path, fault *f)
{
    mode_t mode;
    w->path[0] = w->temporary[0] = '\0';
    w->reason = 0;
    if (strcmp(path, "-") == 0) {
        w->stream = stdout;
        return STATUS_OK;
    }

    // what hinders it is known before anything is created
    const int reason = find_target(path, w->path, &mode);
    if (reason != 0) {
        return cannot_write(f, path, reason);
    }

    // the file to write, and a stream to it
    if (is_in_place(mode)) {
        w->descriptor = open(w->path, O_WRONLY | O_CLOEXEC);
    } else {
        w->descriptor = create_temporary(w, mode);
    }
    if (w->descriptor < 0) {
        return cannot_write(f, path, errno);
    }

    w->stream = fopencookie(w, "w", (cookie_io_functions_t){.write = write_to_file});
    if (w->stream == NULL) {
        close(w->descriptor);
        remove_temporary(w);
        return cannot_write(f, path, ENOMEM);
    }
    return STATUS_OK;
}

// Why not all that was ever written to a stream has arrived, 0 if it has.
int stream_failure(FILE *stream)
{
    errno = 0;
    if (fflush(stream) == 0 && !ferror(stream)) {
        return 0;
    }

    // the write that failed may lie far back, with its errno lost: a pipe still tells
    struct pollfd end = {.fd = fileno(stream), .events = POLLOUT};
    if (errno == 0 && poll(&end, 1, 0) == 1 && (end.revents & POLLERR) != 0) {
        return EPIPE;
    }
    if (errno == 0) {
        return EIO;
    }
    return errno;
}

status whole_file_scratch(const whole_file *w, int *descriptor, fault *f)
{
    // beside what will be the file, or where the system has room for large files
    char folder[PATH_MAX], path[PATH_MAX];
    const char *where = getenv("TMPDIR");
    if (w->temporary[0] != '\0') {
        where = folder_of(w->path, folder);
    } else if (where == NULL || where[0] == '\0') {
        where = "/var/tmp";
    }

    // its name goes at once
    const int length = snprintf(path, PATH_MAX, "%s/.impactlab-XXXXXX.part", where);
    *descriptor = -1;
    errno = ENAMETOOLONG;
    if (length < PATH_MAX) {
        *descriptor = mkostemps(path, (int)strlen(".part"), O_CLOEXEC);
    }
    if (*descriptor < 0) {
        return cannot_write(f, where, errno);
    }
    unlink(path);
    return STATUS_OK;
}

// Flushes the stream and, of a file that is not the standard output, closes it. 0, or the
// reason why not all that was written arrived.
static int end_stream(whole_file *w)
{
    const bool lost = loss_noted(); // before it came here
    int reason;

    if (w->stream == stdout) {
        reason = stream_failure(stdout);
        if (reason == EPIPE) {
            reason = 0; // its reader had what it wanted
        }
    } else {
        const bool flushed = fclose(w->stream) == 0; // looks at everything written before
        reason = w->reason;
        if (!flushed && reason == 0) {
            reason = ENOMEM;
        }
    }

    // a text with a gap is not whole
    if (lost && reason == 0) {
        reason = ENOMEM;
    }
    return reason;
}

// Ends the temporary, if there is one: it becomes the target if it is whole, or goes.
// 0 or the reason why it did not become it.
static int place_temporary(whole_file *w, bool whole)
{
    int reason = 0;
    if (w->temporary[0] == '\0') {
        return 0;
    }

    if (whole && rename(w->temporary, w->path) != 0) {
        reason = errno;
    }
    if (whole && reason == 0) {
        replace_unfinished(w->temporary, NULL);
    } else {
        remove_temporary(w);
    }
    return reason;
}

// Puts the file in its place if it was written, is whole and is on the disk.
status whole_file_close(whole_file *w, status written, fault *f)
{
    const bool wanted = written == STATUS_OK;
    int reason = end_stream(w);

    // a pipe or a device has no disk to reach
    if (w->temporary[0] != '\0' && wanted && reason == 0 && fsync(w->descriptor) != 0) {
        reason = errno;
    }
    if (w->stream != stdout && close(w->descriptor) != 0 && reason == 0) {
        reason = errno;
    }
    w->stream = NULL;

    const int misplaced = place_temporary(w, wanted && reason == 0);
    if (reason == 0) {
        reason = misplaced;
    }
    if (wanted && reason != 0) {
        return cannot_write(f, w->path, reason);
    }
    return written;
}

void whole_file_abandon(whole_file *w)
{
    if (w->stream != NULL) {
        (void)!whole_file_close(w, STATUS_STOPPED, NULL);
    }
}
