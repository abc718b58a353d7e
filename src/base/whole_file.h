// Files that appear whole or not at all.
//
// What is written goes to a temporary file in the target's folder; whole_file_commit
// brings it to the disk and renames it to the target. "-" is the standard output. A
// target that exists and is no regular file (a device, a pipe) is written in place.
//
// A symbolic link is followed, but not where the kernel would refuse it
// (fs.protected_symlinks): in a folder in which everybody may write and nobody may remove
// what is others', one that belongs neither to the user nor to the folder's owner. What a
// run that was killed left behind (.impactlab-*.part) goes when the next one writes into
// the same folder.
#pragma once

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "src/base/fault.h"

// Stays where it is while it is open.
typedef struct whole_file {
    FILE *stream;    // write here
    char *path;      // of the target, links resolved; NULL for the standard output
    char *temporary; // renamed to path in the end; NULL if the target is written in place
    int descriptor;  // that stream writes to; not of the standard output
    int reason;      // errno of the first write that failed, 0 if none did
} whole_file;

// Tells early, before long work, whether path could be written. Creates nothing.
// STATUS_CANNOT_WRITE, with path and reason in f, if it could not.
status whole_file_check(const char *path, fault *f) __attribute__((warn_unused_result));

// Whether two paths lead to one place, links followed, be a file there or not.
bool whole_file_same_place(const char *path, const char *other);

// Opens path for writing through w->stream. A new file gets its mode from the umask, an
// existing one keeps its own. On failure nothing is left behind and w needs no further
// call.
status whole_file_open(whole_file *w, const char *path, fault *f)
    __attribute__((warn_unused_result));

// Checks everything written so far, brings it to the disk and puts the file in its place.
// If anything failed, or was lost for want of memory (text_stream.h), the target is as it
// was before and f says why. A reader of the standard output that went away (a closed
// pipe) had what it wanted and is no failure. Closes w in either case.
#define whole_file_commit(w, f) whole_file_close(w, STATUS_OK, f)

// Gives up: the target stays as it was. Closes w.
void whole_file_abandon(whole_file *w);

// Commits w if writing succeeded (`written` is STATUS_OK), otherwise abandons it and
// returns `written`. Closes w in either case.
status whole_file_close(whole_file *w, status written, fault *f)
    __attribute__((warn_unused_result));

// The places that the results of a command will go to, named before anything is read, so
// that no result takes the place of what the command reads. Adding one is false where
// another one goes there already; it is one at a time, and no thread reads meanwhile.
bool whole_file_add_result(const char *path);
const char *
whole_file_result_at(const char *path); // the result that goes there, NULL if none does
void whole_file_forget_results(void);

// STATUS_BAD_ARGUMENT if a result goes to a file that is read; `why` goes on after its
// name.
status whole_file_keeps(const char *path, fault *why) __attribute__((warn_unused_result));

// STATUS_BAD_ARGUMENT if a device or a pipe stands there, which need have no end; `why`
// goes on after its name.
status whole_file_is_plain(const char *path, fault *why)
    __attribute__((warn_unused_result));

// Opens a plain file for reading: no device or pipe, which need have no end, and no place
// of a result. NULL where that cannot be, and `why` goes on after its name:
// STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT, STATUS_NO_MEMORY.
FILE *whole_file_open_to_read(const char *path, fault *why)
    __attribute__((warn_unused_result));

// The bytes of such a file on the heap, a 0 behind them, or its first `most`; *length is
// without the 0. NULL where they cannot be had, as above with the same faults.
char *whole_file_read(const char *path, size_t most, size_t *length, fault *why)
    __attribute__((warn_unused_result));

// What was said of a file that cannot be read, behind its name. Returns the status.
status whole_file_unread(const char *path, const fault *why, fault *f);

// Locks a regular file of the user's by its name in a folder, if nobody else has a lock
// on it: its writer, who held one in a copy of whole_file.descriptor, has ended. Returns
// what holds the lock, to be closed, or -1.
int whole_file_lock_left(int folder, const char *name);

// Removes what runs that were killed left in a folder. Opening a file does so by itself;
// this is for who asks beforehand what the folder holds. One that cannot be read is left
// alone.
void whole_file_clean_folder(const char *path);

// Removes the temporaries of all files that are open just now. Safe in a signal handler
// that is about to end the program.
void whole_file_remove_unfinished(void);

// Names another process that writes an unfinished file, 0 where there is none any more:
// it is killed before the files are removed.
void whole_file_set_writer(pid_t process);

// Flushes a stream and tells whether all that was ever written to it arrived: 0, or an
// errno (EPIPE if the reader of a pipe went away).
int stream_failure(FILE *stream) __attribute__((warn_unused_result));
