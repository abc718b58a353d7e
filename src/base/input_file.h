// Files that are read: plain ones, which have an end, and none that a result of the same
// command goes to.
//
// Faults of these functions are the end of a sentence that begins with the file's name;
// input_file_fault puts the two together.
#pragma once

#include <stdio.h>

#include "src/base/fault.h"

// STATUS_BAD_ARGUMENT if a result goes to a file that is read.
status input_file_check_kept(const char *path, fault *why)
    __attribute__((warn_unused_result));

// STATUS_BAD_ARGUMENT if a device or a pipe stands there, which need have no end.
status input_file_check_plain(const char *path, fault *why)
    __attribute__((warn_unused_result));

// Opens a file that passes both checks. NULL where that cannot be: STATUS_CANNOT_READ,
// STATUS_BAD_ARGUMENT, STATUS_NO_MEMORY.
FILE *input_file_open(const char *path, fault *why) __attribute__((warn_unused_result));

// The bytes of such a file on the heap, a 0 behind them, or its first `most`; *length is
// without the 0. NULL where they cannot be had, with the same faults.
char *input_file_read(const char *path, size_t most, size_t *length, fault *why)
    __attribute__((warn_unused_result));

// The whole sentence, the file's name before what `why` says of it. Returns the status.
status input_file_fault(const char *path, const fault *why, fault *f);
