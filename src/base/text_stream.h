// A stream whose text lands in memory, and that says where memory ran out: the C library's own
// (open_memstream) loses what it has no room for and reports no error.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct text_stream {
    FILE *stream; // to be written to
    char *text;
    size_t length, capacity;
} text_stream;

// Opens an empty one in the caller's storage, which stays in its place until it is closed. False
// without memory; then there is nothing to be closed.
bool text_stream_open(text_stream *t) __attribute__((warn_unused_result));

// Closes it and returns the text, ended by a 0 and to be freed; *length (may be NULL) is without
// that. NULL if any of it was lost, here or before it came here (loss.h).
char *text_stream_close(text_stream *t, size_t *length) __attribute__((warn_unused_result));
