// The recovery file: what would be lost if the lab ended now. It outlives every end of
// the program but the one that its user asks for, and the next start offers it.
//
// It holds what `:session save` writes, and is locked as long as its lab lives.
#include <dirent.h>
#include <fcntl.h>
#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "src/base/text_stream.h"
#include "src/base/whole_file.h"
#include "src/run/background_run.h"
#include "ui/explorer/explorer.h"
#include "ui/explorer/state/user_files.h"

#define APART 1.0 // between two times that it is written [s]
#define LOOK  0.1 // between two looks at whether that is done [s]

// Of as many letters; what begins with the first one is offered.
static const char offered[] = "recovery", declined[] = "declined";

// --- writing ---------------------------------------------------------------------------

// On a thread of its own, so that no key waits for a disk.
static void *write_text(void *context)
{
    recovery *r = context;
    whole_file file;
    r->code = whole_file_open(&file, r->path, &r->fault);
    if (r->code == STATUS_OK) {
        // a copy of the descriptor keeps the lock when the file is closed
        const int lock = fcntl(file.descriptor, F_DUPFD_CLOEXEC, 0);
        flock(lock, LOCK_EX | LOCK_NB);
        fputs(r->text, file.stream);
        r->code = whole_file_commit(&file, &r->fault);

        // it takes the place of the lock on the file that was replaced
        if (r->code == STATUS_OK) {
            close(r->lock);
            r->lock = lock;
        } else {
            close(lock);
        }
    }
    atomic_store(&r->done, true);
    return NULL;
}

// Waits for the end of what is being written; what hinders it is said once.
static void finish_writing(explorer *ex)
{
    recovery *r = &ex->recovery;
    if (r->writes) {
        pthread_join(r->writer, NULL);
    }
    r->writes = false;
    free(r->text);
    r->text = NULL;
    if (r->code != STATUS_OK && !r->failure_shown) {
        const char *why = r->fault.text[0] != '\0' ? r->fault.text : status_text(r->code);
        r->failure_shown =
            act_warn(&ex->input, "your changes would not outlive a crash: %.400s", why);
    }
}

static void begin_writing(explorer *ex)
{
    recovery *r = &ex->recovery;
    text_stream text;
    sigset_t before;
    r->changed = false;
    if (!explorer_has_work(&ex->model, &ex->view)) {
        return;
    }

    // the text here, the file there
    r->fault = (fault){0};
    r->code = STATUS_NO_MEMORY;
    r->done = false;
    if (text_stream_open(&text)) {
        loss_unless(explorer_write_session(&ex->model, &ex->view, text.stream,
                                           &r->fault) == STATUS_OK);
        r->text = text_stream_close(&text, NULL);
    }
    if (r->text != NULL) {
        worker_signals_block(&before);
        r->writes = pthread_create(&r->writer, NULL, write_text, r) == 0;
        pthread_sigmask(SIG_SETMASK, &before, NULL);
    }
    if (r->text != NULL && !r->writes) {
        write_text(r);
    }
    if (!r->writes) {
        finish_writing(ex);
    }
}

double recovery_keep(explorer *ex, bool changed, double now)
{
    recovery *r = &ex->recovery;
    r->changed = r->changed || changed;
    if (r->writes && r->done) {
        finish_writing(ex);
    }
    if (r->changed && !r->writes && now >= r->due) {
        begin_writing(ex);
        r->due = now + APART;
    }
    if (r->writes) {
        return LOOK;
    }
    if (r->changed) {
        return fmax(0, r->due - now);
    }
    return HUGE_VAL;
}

void recovery_end(explorer *ex, bool orderly)
{
    recovery *r = &ex->recovery;
    finish_writing(ex);
    if (!orderly && r->changed) {
        begin_writing(ex);
        finish_writing(ex);
    }
    if (orderly && r->lock >= 0) {
        unlink(r->path);
    }
    close(r->lock);
}

// --- offering --------------------------------------------------------------------------

// Locks a regular file of the user's by its name in a folder, if nobody else has a lock
// on it: the lab that wrote it has ended. Returns what holds the lock, to be closed, or
// -1.
static int lock_left(int folder, const char *name)
{
    struct stat about, named;
    const int file = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);

    // it may have become another file since it was opened, and the name another one's
    const bool left = file >= 0 && fstat(file, &about) == 0 && S_ISREG(about.st_mode) &&
                      about.st_uid == geteuid() && flock(file, LOCK_EX | LOCK_NB) == 0 &&
                      fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
                      named.st_ino == about.st_ino;
    if (left) {
        return file;
    }
    if (file >= 0) {
        close(file);
    }
    return -1;
}

// Finds the newest file of a lab that has ended, in the folder of this lab's own; false
// if there is none. It stays locked.
static bool find_left(recovery *r)
{
    const size_t length = (size_t)(strrchr(r->path, '/') - r->path) + 1;
    char *name = r->left + length;
    snprintf(r->left, sizeof r->left, "%.*s", (int)length, r->path);
    DIR *folder = opendir(r->left);
    if (folder == NULL) {
        return false;
    }

    // names have the time of their lab's start, so the last is the newest
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        const char *found = entry->d_name;
        if (strncmp(found, offered, strlen(offered)) != 0 || strcmp(found, name) <= 0) {
            continue;
        }
        const int lock = lock_left(dirfd(folder), found);
        if (lock >= 0) {
            close(r->left_lock);
            r->left_lock = lock;
            snprintf(name, sizeof r->left - length, "%s", found);
        }
    }
    closedir(folder);
    return r->left_lock >= 0;
}

bool recovery_begin(explorer *ex)
{
    recovery *r = &ex->recovery;
    char name[64];
    struct stat about;
    snprintf(name, sizeof name, "%s-%012lld-%d.session", offered, (long long)time(NULL),
             getpid());
    user_file(USER_STATE, name, r->path, sizeof r->path, true);
    r->lock = r->left_lock = -1;
    if (!find_left(r) || fstat(r->left_lock, &about) != 0) {
        r->left[0] = '\0';
        return false;
    }

    // when it was written last
    char when[64];
    strftime(when, sizeof when, "%e %b at %H:%M", localtime(&about.st_mtime));
    return act_warn(&ex->input,
                    "a lab ended on %s with work that was not saved: y goes on with it, "
                    "n keeps it as a file, after any other key the next start asks again",
                    when);
}

bool recovery_answer(explorer *ex, int key)
{
    recovery *r = &ex->recovery;
    char path[sizeof r->left], kept[sizeof r->left];
    if (r->left[0] == '\0') {
        return false;
    }
    memcpy(path, r->left, sizeof path);
    memcpy(kept, path, sizeof kept);
    memcpy(strrchr(kept, '/') + 1, declined, strlen(declined));
    r->left[0] = '\0';
    if (key == 'y' && explorer_open_session(&ex->model, &ex->view, &ex->input, path)) {
        // its file is this lab's from here on, and nothing of it is saved
        memcpy(r->path, path, sizeof path);
        r->lock = r->left_lock;
        ex->model.session_path[0] = '\0';
        ex->model.saved_version = ex->model.kept_pins = 0;
        g_free(ex->model.saved_looks);
        ex->model.saved_looks = NULL;
        return true;
    }
    if (key == 'n' && rename(path, kept) == 0) {
        act_tell(&ex->input, "kept: :session open %.900s goes on with it", kept);
    }
    close(r->left_lock);
    return key == 'y' || key == 'n';
}
