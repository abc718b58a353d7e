// A fault: a code and places for programs, a sentence for people. No program reads the sentence.
#pragma once

#include "src/base/status.h"

typedef struct fault {
    status code;
    char text[1024];  // what was wrong, where, and what was expected
    const char *path; // of the parameter at fault ("wall.angle"), a literal; "" if there is none
    int line, column; // where it stands in the file that was read, from 1; 0 if there is none
} fault;

// Fills f (may be NULL) with a code and a printf-formatted sentence, without a parameter or a
// place. Returns code.
status fault_set(fault *f, status code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// The same for a parameter whose path lasts as long as the program.
status fault_set_at(fault *f, status code, const char *path, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

// The same for a place in a file, line and column from 1.
status fault_set_place(fault *f, status code, int line, int column, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

// Fills f (may be NULL) with STATUS_NO_MEMORY and its general sentence. Returns it.
status fault_no_memory(fault *f);
