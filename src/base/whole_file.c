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

enum { MOST_LINKS = 40 }; // followed one after the other, as the kernel does

// A path of NULL is the standard output.
static status cannot_write(fault *f, const char *path, int reason)
{
    FAULT_IF(path == NULL, f, STATUS_CANNOT_WRITE,
             "the standard output cannot be written: %s", strerror(reason));
    return fault_set(f, STATUS_CANNOT_WRITE, "'%s' cannot be written: %s", path,
                     strerror(reason));
}

// --- temporaries that exist just now ---------------------------------------------------

// For the signal handler; a few files at once are plenty, and one without a place is
// merely not cleaned up after a signal.
enum { MOST_UNFINISHED = 8 };
static _Atomic(char *) unfinished[MOST_UNFINISHED];
static atomic_bool ending; // of the program: other threads create no more of them
static atomic_int writer;  // the process that writes one of them, 0 for none

// Puts a name, NULL for none, in the place of another.
static void replace_unfinished(char *before, char *name)
{
    bool replaced = false;
    for (int i = 0; i < MOST_UNFINISHED && !replaced; i++) {
        char *expected = before;
        replaced = atomic_compare_exchange_strong(&unfinished[i], &expected, name);
    }
}

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
        nanosleep(&(struct timespec){.tv_nsec = pass * 1000000}, NULL);
        for (int i = 0; i < MOST_UNFINISHED; i++) {
            char *name = atomic_load(&unfinished[i]);
            if (name != NULL) {
                unlink(name);
            }
        }
    }
}

// --- where a path leads ----------------------------------------------------------------

// Length of path's folder with its slash, 0 if it has none.
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash) {
        return (size_t)(slash - path) + 1;
    }
    return 0;
}

static bool is_same_file(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

// The folder of path, "." if it names none.
static const char *folder_of(const char *path, char folder[PATH_MAX])
{
    const int length = (int)folder_length(path);
    if (length > 0) {
        snprintf(folder, PATH_MAX, "%.*s", length, path);
    } else {
        strcpy(folder, ".");
    }
    return folder;
}

// Whether the kernel would follow a link; see proc_sys_fs(5), protected_symlinks.
static bool may_follow(const char *link)
{
    const mode_t everybodys = S_ISVTX | S_IWOTH;
    struct stat about, around;
    char folder[PATH_MAX];
    return lstat(link, &about) == 0 && stat(folder_of(link, folder), &around) == 0 &&
           ((around.st_mode & everybodys) != everybodys || about.st_uid == geteuid() ||
            about.st_uid == around.st_uid);
}

// Where a path leads, be it there or not: a link stays a link and its target is what gets
// written. 0 or the reason why nobody knows.
static int follow_links(const char *path, char target[PATH_MAX])
{
    if (strlen(path) >= PATH_MAX) {
        return ENAMETOOLONG;
    }
    strcpy(target, path);

    // link by link; a relative one counts from its own folder
    for (int links = 0; links < MOST_LINKS; links++) {
        char link[PATH_MAX];
        const ssize_t length = readlink(target, link, sizeof link - 1);
        if (length < 0) {
            return 0;
        }
        if (!may_follow(target)) {
            return EACCES;
        }
        const size_t folder = link[0] == '/' ? 0 : folder_length(target);
        if (folder + (size_t)length >= PATH_MAX) {
            return ENAMETOOLONG;
        }
        memcpy(target + folder, link, (size_t)length);
        target[folder + (size_t)length] = '\0';
    }
    return ELOOP;
}

// Where a path leads and the mode of what stands there, 0 for nothing. 0, or the reason
// why that cannot be replaced or created.
static int find_target(const char *path, char target[PATH_MAX], mode_t *mode)
{
    struct stat about = {.st_mode = 0};
    char folder[PATH_MAX];
    if (path[0] == '\0') {
        return ENOENT;
    }
    const int reason = follow_links(path, target);
    if (reason != 0) {
        return reason;
    }

    // what stands there already
    const bool there = stat(target, &about) == 0;
    if (!there && errno != ENOENT) {
        return errno;
    }
    if (there) {
        *mode = about.st_mode;
    } else {
        *mode = 0;
    }
    if (there && S_ISDIR(*mode)) {
        return EISDIR;
    }
    if (there && access(target, W_OK) != 0) {
        return errno;
    }

    // what stands beside it, as a temporary will
    const bool beside = !there || S_ISREG(*mode);
    if (beside && access(folder_of(target, folder), W_OK | X_OK) != 0) {
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
    if (reason == 0) {
        return STATUS_OK;
    }
    return cannot_write(f, path, reason);
}

bool whole_file_same_place(const char *path, const char *other)
{
    char places[2][PATH_MAX], folder[PATH_MAX];
    struct stat here[2], around[2];
    if (strcmp(path, other) == 0 || strcmp(path, "-") == 0 || strcmp(other, "-") == 0) {
        return strcmp(path, other) == 0;
    }

    // one file under two names, or two names that lead to one place
    const bool there = stat(path, &here[0]) == 0 && stat(other, &here[1]) == 0;
    if (there && is_same_file(&here[0], &here[1])) {
        return true;
    }
    const char *const names[2] = {path, other};
    for (int i = 0; i < 2; i++) {
        if (follow_links(names[i], places[i]) != 0 ||
            stat(folder_of(places[i], folder), &around[i]) != 0) {
            return false;
        }
    }
    return is_same_file(&around[0], &around[1]) &&
           strcmp(places[0] + folder_length(places[0]),
                  places[1] + folder_length(places[1])) == 0;
}

// --- where the results of a command go -------------------------------------------------

enum { MOST_RESULTS = 16 };
static char results[MOST_RESULTS][PATH_MAX];
static int result_count;

const char *whole_file_result_at(const char *path)
{
    for (int i = 0; i < result_count; i++) {
        if (whole_file_same_place(results[i], path)) {
            return results[i];
        }
    }
    return NULL;
}

bool whole_file_add_result(const char *path)
{
    assert(result_count < MOST_RESULTS);
    if (whole_file_result_at(path) != NULL) {
        return false;
    }
    snprintf(results[result_count++], PATH_MAX, "%s", path);
    return true;
}

void whole_file_forget_results(void)
{
    result_count = 0;
}

status whole_file_keeps(const char *path, fault *why)
{
    struct stat about;
    const bool is_file = stat(path, &about) == 0 && S_ISREG(about.st_mode);
    const char *result = NULL;
    if (is_file) {
        result = whole_file_result_at(path);
    }
    FAULT_IF(result != NULL, why, STATUS_BAD_ARGUMENT,
             "is read, and a result would be written over it to '%.300s', expected "
             "another file",
             result);
    return STATUS_OK;
}

// --- what killed runs left -------------------------------------------------------------

// A temporary is locked as long as its run lives, and the lock goes with the run however
// that ends. False if another run has taken it for one left behind, in the moment before;
// where the file system has no locks none does.
static bool lock_temporary(int descriptor)
{
    struct stat about;
    const bool held = flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    return !held && (fstat(descriptor, &about) != 0 || about.st_nlink > 0);
}

int whole_file_lock_left(int folder, const char *name)
{
    struct stat about, named;
    const int file = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);

    // it may have become another file since it was opened, and the name another one's
    const bool left = file >= 0 && fstat(file, &about) == 0 && S_ISREG(about.st_mode) &&
                      about.st_uid == geteuid() && flock(file, LOCK_EX | LOCK_NB) == 0 &&
                      fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
                      named.st_ino == about.st_ino;
    if (file >= 0 && !left) {
        close(file);
    }
    if (left) {
        return file;
    }
    return -1;
}

void whole_file_clean_folder(const char *path)
{
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder != NULL && (entry = readdir(folder)) != NULL;) {
        // ".impactlab-PROCESS-NUMBER.part" and no more
        const char *name = entry->d_name;
        long process;
        int number, length = 0;
        if (sscanf(name, ".impactlab-%ld-%d.part%n", &process, &number, &length) == 2 &&
            length > 0 && name[length] == '\0') {
            const int left = whole_file_lock_left(dirfd(folder), name);
            if (left >= 0) {
                unlinkat(dirfd(folder), name, 0);
                close(left);
            }
        }
    }
    if (folder != NULL) {
        closedir(folder);
    }
}

// The same for the folder of `path`, once for each folder after another: the frames of a
// film, the pictures of a report go into one many times.
static void clean_folder_of(const char *path)
{
    static pthread_mutex_t looking = PTHREAD_MUTEX_INITIALIZER;
    static struct stat last;
    struct stat about;
    char folder[PATH_MAX];
    if (stat(folder_of(path, folder), &about) == 0) {
        pthread_mutex_lock(&looking);
        const bool known = is_same_file(&about, &last);
        last = about;
        pthread_mutex_unlock(&looking);
        if (!known) {
            whole_file_clean_folder(folder);
        }
    }
}

// --- opening ---------------------------------------------------------------------------

// Where the bytes of a stream go. The stream itself does not keep why a write failed.
static ssize_t write_to_file(void *context, const char *bytes, size_t size)
{
    whole_file *w = context;
    size_t done = 0;
    while (done < size) {
        const ssize_t written =
            TEMP_FAILURE_RETRY(write(w->descriptor, bytes + done, size - done));
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

static void forget_temporary(whole_file *w)
{
    if (w->temporary != NULL) {
        replace_unfinished(w->temporary, NULL);
    }
    free(w->temporary);
    w->temporary = NULL;
}

// Frees what the file has; nothing of it is open any more.
static void forget(whole_file *w)
{
    forget_temporary(w);
    free(w->path);
    *w = (whole_file){.stream = NULL};
}

// Creates an empty file with a name of its own beside w->path; 0 or the reason why not.
static int create_temporary(whole_file *w, mode_t mode)
{
    const int folder = (int)folder_length(w->path);
    int reason = EEXIST;
    for (int attempt = 0; attempt < 1000 && reason == EEXIST; attempt++) {
        if (asprintf(&w->temporary, "%.*s.impactlab-%ld-%d.part", folder, w->path,
                     (long)getpid(), attempt) < 0) {
            w->temporary = NULL;
            return ENOMEM;
        }

        // creating it tells whether the name is free
        replace_unfinished(NULL, w->temporary);
        if (atomic_load(&ending)) {
            return ECANCELED;
        }
        w->descriptor = open(w->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (w->descriptor < 0) {
            reason = errno;
        } else {
            reason = 0;
        }
        if (reason == 0 && !lock_temporary(w->descriptor)) {
            close(w->descriptor);
            reason = EEXIST;
        }
        if (reason != 0) {
            forget_temporary(w);
        }
    }

    // not owning the old file is no reason to write nothing
    if (reason == 0 && mode != 0) {
        (void)!fchmod(w->descriptor, mode & 07777);
    }
    return reason;
}

// Opens the target, or its temporary, and the stream; 0 or the reason why not.
static int open_destination(whole_file *w, mode_t mode)
{
    int reason = 0;
    if (mode == 0 || S_ISREG(mode)) {
        // what is left of runs before goes first
        clean_folder_of(w->path);
        reason = create_temporary(w, mode);
    } else {
        w->descriptor = open(w->path, O_WRONLY | O_CLOEXEC);
        if (w->descriptor < 0) {
            reason = errno;
        } else {
            reason = 0;
        }
    }
    if (reason != 0) {
        return reason;
    }

    w->stream = fopencookie(w, "w", (cookie_io_functions_t){.write = write_to_file});
    if (w->stream == NULL) {
        close(w->descriptor);
        if (w->temporary != NULL) {
            unlink(w->temporary);
        }
        return ENOMEM;
    }
    return 0;
}

status whole_file_open(whole_file *w, const char *path, fault *f)
{
    *w = (whole_file){.stream = NULL};
    if (strcmp(path, "-") == 0) {
        w->stream = stdout;
        return STATUS_OK;
    }

    // what hinders it is known before anything is created
    char target[PATH_MAX];
    mode_t mode = 0;
    int reason = find_target(path, target, &mode);
    if (reason == 0) {
        w->path = strdup(target);
        if (w->path != NULL) {
            reason = open_destination(w, mode);
        } else {
            reason = ENOMEM;
        }
    }
    if (reason != 0) {
        forget(w);
        return cannot_write(f, path, reason);
    }
    return STATUS_OK;
}

// --- closing ---------------------------------------------------------------------------

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
    if (errno != 0) {
        return errno;
    }
    return EIO;
}

// Closes the stream, brings the file to the disk if it is `wanted`; 0 or the reason why
// not.
static int close_stream(whole_file *w, bool wanted)
{
    const bool flushed = fclose(w->stream) == 0; // looks at everything written before
    int reason;
    if (w->reason != 0) {
        reason = w->reason;
    } else if (flushed) {
        reason = 0;
    } else {
        reason = ENOMEM;
    }

    // a pipe or a device has no disk to reach
    if (wanted && reason == 0 && w->temporary != NULL && fsync(w->descriptor) != 0) {
        reason = errno;
    }
    return reason;
}

status whole_file_close(whole_file *w, status written, fault *f)
{
    const bool wanted = written == STATUS_OK;
    int reason = 0;
    if (w->path != NULL) {
        reason = close_stream(w, wanted);
    } else if (wanted && (reason = stream_failure(stdout)) == EPIPE) {
        reason = 0; // its reader had what it wanted
    }

    // what was lost before it came here is missing in it
    if (wanted && loss_noted() && reason == 0) {
        reason = ENOMEM;
    }

    // the file takes the place of the old one if it is whole, or goes
    if (w->temporary != NULL && wanted && reason == 0 &&
        rename(w->temporary, w->path) != 0) {
        reason = errno;
    }
    if (w->temporary != NULL && (!wanted || reason != 0)) {
        unlink(w->temporary);
    }

    // with it goes the lock, without which another run would take the temporary for one
    // left behind
    if (w->path != NULL && close(w->descriptor) != 0 && reason == 0 &&
        w->temporary == NULL) {
        reason = errno;
    }
    status result;
    if (wanted && reason != 0) {
        result = cannot_write(f, w->path, reason);
    } else {
        result = written;
    }
    forget(w);
    return result;
}

void whole_file_abandon(whole_file *w)
{
    (void)!whole_file_close(w, STATUS_STOPPED, NULL);
}

// --- reading ---------------------------------------------------------------------------

status whole_file_is_plain(const char *path, fault *why)
{
    struct stat about;
    if (stat(path, &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode)) {
        return fault_set(why, STATUS_BAD_ARGUMENT,
                         "is a device or a pipe, expected a plain file");
    }
    return STATUS_OK;
}

FILE *whole_file_open_to_read(const char *path, fault *why)
{
    // opening a pipe would wait for its other end
    if (whole_file_keeps(path, why) != STATUS_OK ||
        whole_file_is_plain(path, why) != STATUS_OK) {
        return NULL;
    }
    FILE *stream = NULL;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    struct stat about = {.st_mode = 0};
    if (file < 0) {
        fault_set(why, STATUS_CANNOT_READ, "cannot be opened (%s)", strerror(errno));
    } else if (fstat(file, &about) != 0 || S_ISDIR(about.st_mode)) {
        fault_set(why, STATUS_CANNOT_READ, "cannot be read (%s)", strerror(EISDIR));
    } else if ((stream = fdopen(file, "r")) == NULL) {
        fault_no_memory(why);
    }
    if (stream == NULL && file >= 0) {
        close(file);
    }
    return stream;
}

status whole_file_unread(const char *path, const fault *why, fault *f)
{
    return fault_set(f, why->code, "'%.300s' %.600s", path, why->text);
}

char *whole_file_read(const char *path, size_t most, size_t *length, fault *why)
{
    assert(most > 0);
    FILE *file = whole_file_open_to_read(path, why);
    char *bytes = NULL;
    ssize_t count = 1;
    *length = 0;
    if (file == NULL) {
        return NULL;
    }
    for (size_t room = 0; count > 0 && *length < most;) {
        if (*length == room) {
            if (room == 0) {
                room = most < 65536 ? most : 65536;
            } else if (room > most / 2) {
                room = most;
            } else {
                room = 2 * room;
            }
            char *more = realloc(bytes, room + 1);
            if (more == NULL) {
                count = -1;
                break;
            }
            bytes = more;
        }
        count = TEMP_FAILURE_RETRY(read(fileno(file), bytes + *length, room - *length));
        if (count > 0) {
            *length += (size_t)count;
        }
    }

    // what became of it, whatever closing says
    const int reason = errno;
    fclose(file);
    if (count < 0) {
        free(bytes);
        status code = STATUS_NO_MEMORY;
        if (reason != ENOMEM) {
            code = STATUS_CANNOT_READ;
        }
        fault_set(why, code, "cannot be read (%s)", strerror(reason));
        return NULL;
    }
    bytes[*length] = '\0';
    return bytes;
}
