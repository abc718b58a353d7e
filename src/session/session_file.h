// A visit to the lab as a file: the present run and the pinned ones, each as its
// scenario, whole, and its changes; and lines that say how they are looked at, which
// belong to who shows them.
//
// The scenarios' text stands in the file itself, so that reading it reads no other file,
// and what a scenario would start needs a consent as ever. Lines are "word: rest"; those
// of a scenario's text begin with "| ".
#pragma once

#include "src/session/run_origin.h"

enum { SESSION_FILE_RUNS = 8, SESSION_FILE_NAME = 256, SESSION_FILE_LINES = 512 };

typedef struct kept_run {
    char name[SESSION_FILE_NAME]; // of a pinned run
    bool hidden;
    run_origin from;
} kept_run;

typedef struct session_file {
    kept_run runs[SESSION_FILE_RUNS]; // the present one, then the pinned ones
    int run_count;                    // 0: empty
    int baseline;                     // among the pinned ones, -1: none
    char *lines[SESSION_FILE_LINES];  // how it is looked at; owned
    int line_count;
} session_file;

// Writes a file of it; what it lists stays the caller's. Errors stay in the stream.
void session_file_write(FILE *stream, const session_file *file);

// Reads one; every line is checked before anything is taken. STATUS_CANNOT_READ,
// STATUS_BAD_ARGUMENT with the line in f, or STATUS_NO_MEMORY; then there is nothing to
// be freed.
status session_file_read(session_file *file, const char *path, fault *f);
void session_file_finish(session_file *file);

// Whether a program or a file that one of its runs reads is another one than it was when
// the run was computed, so that the run may come out differently.
bool session_file_is_outdated(const session_file *file);
