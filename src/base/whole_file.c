#include "src/base/whole_file.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "src/base/text_stream.h"

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
static atomic_bool ending; // of the program: other threads create no more of them

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

// The process that writes one of them, 0 for none.
static atomic_int writer;

void whole_file_set_writer(pid_t process)
{
    atomic_store(&writer, process);
}

void whole_file_remove_unfinished(void)
{
    // it would make its file once more
    const pid_t process = atomic_load(&writer);
    if (process > 0) {
        kill(process, SIGKILL);
    }
    // a thread that is just creating one is given time to have done so
    atomic_store(&ending, true);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < MOST_UNFINISHED; i++) {
            char *name = atomic_load(&unfinished[i]);
            if (name != NULL) {
                unlink(name);
            }
        }
        if (pass == 0) {
            nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
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

// Whether the kernel would follow a link; see proc_sys_fs(5), protected_symlinks.
static bool may_follow(const char *link)
{
    struct stat about, around = {0};
    char *folder = folder_of(link);
    bool known = folder != NULL && lstat(link, &about) == 0 && stat(folder, &around) == 0;
    free(folder);

    const mode_t everybodys = S_ISVTX | S_IWOTH;
    return known && ((around.st_mode & everybodys) != everybodys || about.st_uid == geteuid() ||
                     about.st_uid == around.st_uid);
}

// Where a path leads, be it there or not: a link stays a link and its target is what gets written.
// NULL without memory, or if a link is not to be followed, with errno.
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
        if (!may_follow(target)) {
            free(target);
            errno = EACCES;
            return NULL;
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
    errno = target == NULL ? ENOMEM : errno;
    return target;
}

// --- what killed runs left ------------------------------------------------------------------

// A temporary is locked as long as its run lives, and the lock goes with the run however that ends.
// False if another run has taken it for one left behind, in the moment before; where the file
// system has no locks none does.
static bool lock_temporary(int descriptor)
{
    struct stat about;
    const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    return !held && (fstat(descriptor, &about) != 0 || about.st_nlink > 0);
}

// Whether a name is that of a temporary, ".impactlab-PROCESS-NUMBER.part".
static bool is_temporary_name(const char *name)
{
    int length = 0;
    long process;
    int number;
    return sscanf(name, ".impactlab-%ld-%d.part%n", &process, &number, &length) == 2 &&
           name[length] == '\0';
}

// Removes a temporary of the user's that nobody holds a lock on.
static void remove_if_left(int folder, const char *name)
{
    struct stat about;
    int file = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
        return;
    }
    if (fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == geteuid() &&
        flock(file, LOCK_EX | LOCK_NB) == 0) {
        unlinkat(folder, name, 0);
    }
    close(file);
}

void whole_file_clean_folder(const char *path)
{
    assert(path != NULL);
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        if (is_temporary_name(entry->d_name)) {
            remove_if_left(dirfd(folder), entry->d_name);
        }
    }
    if (folder != NULL) {
        closedir(folder);
    }
}

// Removes what runs that were killed left in the folder of `path`, once for each folder after
// another: the frames of a film, the pictures of a report go into one many times.
static void remove_left_behind(const char *path)
{
    static pthread_mutex_t looking = PTHREAD_MUTEX_INITIALIZER;
    static struct stat last;

    struct stat about;
    char *name = folder_of(path);
    if (name != NULL && stat(name, &about) == 0) {
        pthread_mutex_lock(&looking);
        const bool known = about.st_dev == last.st_dev && about.st_ino == last.st_ino;
        last = about;
        pthread_mutex_unlock(&looking);
        if (!known) {
            whole_file_clean_folder(name);
        }
    }
    free(name);
}

// --- the stream -----------------------------------------------------------------------------

// Where the bytes of a stream go. The stream itself does not keep why a write failed.
typedef struct whole_file_sink {
    int descriptor;
    int reason; // errno of the first write that failed, 0 if none did
} whole_file_sink;

static ssize_t sink_write(void *context, const char *bytes, size_t size)
{
    whole_file_sink *sink = context;
    size_t done = 0;
    while (done < size) {
        ssize_t written = write(sink->descriptor, bytes + done, size - done);
        if (written < 0 && errno != EINTR) {
            sink->reason = sink->reason != 0 ? sink->reason : errno;
            return 0;
        }
        done += written > 0 ? (size_t)written : 0;
    }
    return (ssize_t)size;
}

// The descriptor is closed by whoever looks at what became of it.
static FILE *open_sink(whole_file *w, int descriptor)
{
    w->sink = malloc(sizeof *w->sink);
    if (w->sink == NULL) {
        return NULL;
    }
    *w->sink = (whole_file_sink){.descriptor = descriptor};
    return fopencookie(w->sink, "w", (cookie_io_functions_t){.write = sink_write});
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
    free(folder);
    return reason;
}

status whole_file_check(const char *path, fault *f)
{
    assert(path != NULL);
    bool in_place;
    mode_t mode;
    if (strcmp(path, "-") == 0) {
        return STATUS_OK;
    }
    char *target = target_of(path);
    int reason = target != NULL ? obstacle(target, &in_place, &mode) : errno;
    free(target);
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
        remember_unfinished(w->temporary);
        const bool ends = atomic_load(&ending);
        int descriptor =
            ends ? -1 : open(w->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        errno = ends ? ECANCELED : errno;
        if (descriptor >= 0 && !lock_temporary(descriptor)) {
            close(descriptor);
            errno = EEXIST;
        } else if (descriptor >= 0) {
            if (mode != 0) {
                // not owning the old file is no reason to write nothing
                (void)!fchmod(descriptor, mode);
            }
            return descriptor;
        }

        forget_unfinished(w->temporary);
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

    // what is left of runs before goes first
    if (!in_place) {
        remove_left_behind(w->path);
    }

    // a file stands under a name of its own until it is whole
    int descriptor = in_place ? open(w->path, O_WRONLY | O_CLOEXEC) : create_temporary(w, mode);
    if (descriptor < 0) {
        return errno;
    }

    w->stream = open_sink(w, descriptor);
    if (w->stream != NULL) {
        return 0;
    }
    close(descriptor);
    if (w->temporary != NULL) {
        unlink(w->temporary);
    }
    return ENOMEM;
}

static void forget(whole_file *w)
{
    forget_unfinished(w->temporary);
    free(w->sink);
    free(w->path);
    free(w->temporary);
    memset(w, 0, sizeof *w);
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
    int reason = w->path ? open_target(w) : errno;
    if (reason != 0) {
        forget(w);
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

// Closes stream and file, brought to the disk if it is `wanted`; 0 or the reason why not.
static int close_sink(whole_file *w, bool wanted)
{
    const int descriptor = w->sink->descriptor;
    const bool flushed = fclose(w->stream) == 0; // looks at everything written before
    int reason = w->sink->reason != 0 ? w->sink->reason : flushed ? 0 : ENOMEM;

    // a pipe or a device has no disk to reach
    if (wanted && reason == 0 && w->temporary != NULL && fsync(descriptor) != 0) {
        reason = errno;
    }
    if (close(descriptor) != 0 && reason == 0) {
        reason = errno;
    }
    return reason;
}

// Closes the file; it takes the place of the old one if it is wanted and whole, or goes. 0 or the
// reason why it is not there.
static int finish(whole_file *w, bool wanted)
{
    int reason = w->sink != NULL ? close_sink(w, wanted) : wanted ? stream_failure(stdout) : 0;
    reason = w->sink == NULL && reason == EPIPE ? 0 : reason;

    // what was lost before it came here is missing in it
    if (wanted && loss_noted() && reason == 0) {
        reason = ENOMEM;
    }
    bool kept = wanted && reason == 0;
    if (kept && w->temporary != NULL && rename(w->temporary, w->path) != 0) {
        reason = errno;
        kept = false;
    }
    if (!kept && w->temporary != NULL) {
        unlink(w->temporary);
    }
    return reason;
}

status whole_file_commit(whole_file *w, fault *f)
{
    assert(w != NULL && w->stream != NULL && w->path != NULL);
    const int reason = finish(w, true);
    const status result = reason == 0 ? STATUS_OK : cannot_write(f, w->path, reason);
    forget(w);
    return result;
}

void whole_file_abandon(whole_file *w)
{
    assert(w != NULL);
    finish(w, false);
    forget(w);
}

status whole_file_close(whole_file *w, status written, fault *f)
{
    if (written != STATUS_OK) {
        whole_file_abandon(w);
        return written;
    }
    return whole_file_commit(w, f);
}
