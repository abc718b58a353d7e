// A stream whose text lands in memory, and that says where memory ran out: the C
// library's own (open_memstream) loses what it has no room for and reports no error.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct text_stream {
    FILE *stream; // to be written to
    char *text;
    size_t length, capacity;
} text_stream;

// Opens an empty one in the caller's storage, which stays in its place until it is
// closed. False without memory; then there is nothing to be closed.
bool text_stream_open(text_stream *t) __attribute__((warn_unused_result));

// Closes it and returns the text, ended by a 0 and to be freed; *length (may be NULL) is
// without that. NULL if any of it was lost, here or before it came here (text_stream.h).
char *text_stream_close(text_stream *t, size_t *length)
    __attribute__((warn_unused_result));

// --- what was lost for want of memory --------------------------------------------------

// Loss: what had to be left out of some output (a line, a member of an object) for want
// of memory. It is noted where it happens and asked for by whoever completes the output:
// a file before it is put in its place, a text before it is handed out, the program
// before it says that all went well.

// Notes a loss on this thread, unless what was to be kept is.
void loss_unless(bool kept);

// Whether anything was lost on this thread since the last call: what it made is not
// whole.
bool loss_noted(void) __attribute__((warn_unused_result));

// Begins anew: what was lost before belongs to other output.
void loss_forget(void);
