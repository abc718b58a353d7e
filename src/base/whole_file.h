// Files that are written whole or not at all.
//
// What is written goes to a temporary file in the target's folder (.impactlab-*.part);
// whole_file_close brings it to the disk and renames it to the target. "-" is the
// standard output. A target that exists and is no regular file (a device, a pipe) is
// written in place.
//
// A symbolic link to a file stays a link, and its target is what is replaced; one to
// nothing is itself replaced. Links of strangers in folders like /tmp are the kernel's to
// refuse (fs.protected_symlinks).
#pragma once

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>

#include "src/base/fault.h"

// Stays where it is while it is open.
typedef struct whole_file {
    FILE *stream;             // write here; NULL once closed
    char path[PATH_MAX];      // of the target, links resolved; "" for the standard output
    char temporary[PATH_MAX]; // renamed to path in the end; "" if written in place
    int descriptor;           // that stream writes to; not of the standard output
    int reason;               // errno of the first write that failed, 0 if none did
} whole_file;

// Tells early, before long work, whether path could be written. Creates nothing.
// STATUS_CANNOT_WRITE, with path and reason in f, if it could not.
status whole_file_check(const char *path, fault *f) __attribute__((warn_unused_result));

// Whether two paths lead to one place, be a file there or not.
bool whole_file_same_place(const char *path, const char *other);

// Opens path for writing through w->stream. A new file gets its mode from the umask, an
// existing one keeps its own. On failure nothing is left behind and w needs no further
// call.
status whole_file_open(whole_file *w, const char *path, fault *f)
    __attribute__((warn_unused_result));

// Opens a file without a name for what is to be written later and does not fit into
// memory: on the disk of w, or in TMPDIR (/var/tmp) where that is a device or the
// standard output. It is read and written, and gone once it is closed.
// STATUS_CANNOT_WRITE.
status whole_file_scratch(const whole_file *w, int *descriptor, fault *f)
    __attribute__((warn_unused_result));

// If writing succeeded (`written` is STATUS_OK), checks everything written so far, brings
// it to the disk and puts the file in its place. If anything failed, or was lost for want
// of memory (text_stream.h), the target is as it was before and f says why. A reader of
// the standard output that went away (a closed pipe) had what it wanted and is no
// failure. Otherwise leaves the target as it was and returns `written`. Closes w in
// either case.
status whole_file_close(whole_file *w, status written, fault *f)
    __attribute__((warn_unused_result));
#define whole_file_commit(w, f) whole_file_close(w, STATUS_OK, f)

// Gives up: the target stays as it was. Closes w; it may be closed already.
void whole_file_abandon(whole_file *w);

// Removes the temporaries of all files that are open just now. Safe in a signal handler
// that is about to end the program.
void whole_file_remove_unfinished(void);

// Flushes a stream and tells whether all that was ever written to it arrived: 0, or an
// errno (EPIPE if the reader of a pipe went away).
int stream_failure(FILE *stream) __attribute__((warn_unused_result));
