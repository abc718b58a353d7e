// A fault: a code and places for programs, a sentence for people. No program reads the
// sentence.
#pragma once

#include "src/base/scoped.h"

// One list, two uses: the enumeration and the text of each code.
#define STATUS_LIST(X)                                                                   \
    X(OK, "done")                                                                        \
    X(BAD_ARGUMENT, "bad argument")                                                      \
    X(BAD_SCENARIO, "bad scenario")                                                      \
    X(NOT_FINITE, "a state became infinite or not a number")                             \
    X(UNSTABLE, "the energy ledger does not close, the integration is unstable")         \
    X(NEWTON_FAILED, "Newton's iteration did not converge")                              \
    X(NO_PROGRESS, "events or strides follow one another without time passing")          \
    X(SINGULAR, "the system of equations is singular")                                   \
    X(NO_MEMORY, "out of memory")                                                        \
    X(CANNOT_WRITE, "a file could not be written")                                       \
    X(CANNOT_READ, "a file could not be read")                                           \
    X(EXPECTATION_FAILED, "an expected value was not met")                               \
    X(STOPPED, "stopped before its end")                                                 \
    X(FOLDED, "the arm is folded across the hub's axis on a flat wall")                  \
    X(CONTROLLER_FAILED, "the controller failed")                                        \
    X(NOT_ALLOWED, "a program or plug-in was not allowed")                               \
    X(IMPOSSIBLE_MEAN,                                                                   \
      "the mean of the force over a stride lies outside what the force is in it")

typedef enum status {
#define STATUS_ENUM(name, text) STATUS_##name,
    STATUS_LIST(STATUS_ENUM)
#undef STATUS_ENUM
} status;

// The general text of a status code, never NULL.
const char *status_text(status code);

typedef struct fault {
    status code;
    char text[1024]; // what was wrong, where, and what was expected
    const char
        *path; // of the parameter at fault ("wall.angle"), a literal; "" if there is none
    int line,
        column; // where it stands in the file that was read, from 1; 0 if there is none
} fault;

// Fills f (may be NULL) with a code and a printf-formatted sentence, `path` (or "") and
// the place of what is at fault (or 0, 0). Returns code.
status fault_fill(fault *f, status code, const char *path, int line, int column,
                  const char *format, ...) __attribute__((format(printf, 6, 7)));

// The same without a parameter or a place; for a parameter whose path lasts as long as
// the program; for a place in a file, line and column from 1.
#define fault_set(f, code, ...)          fault_fill(f, code, "", 0, 0, __VA_ARGS__)
#define fault_set_at(f, code, path, ...) fault_fill(f, code, path, 0, 0, __VA_ARGS__)
#define fault_set_place(f, code, line, column, ...)                                      \
    fault_fill(f, code, "", line, column, __VA_ARGS__)

// Fills f (may be NULL) with STATUS_NO_MEMORY and its general sentence. Returns it.
status fault_no_memory(fault *f);

// Ends the calling function with what a call came to, unless that is STATUS_OK: for a
// function that holds nothing to be given back, or nothing that is not SCOPED.
#define TRY(call)                                                                        \
    do {                                                                                 \
        const status tried_ = (call);                                                    \
        if (tried_ != STATUS_OK) {                                                       \
            return tried_;                                                               \
        }                                                                                \
    } while (0)

// Ends it with a fault, fault_set's, where something is wrong.
#define FAULT_IF(wrong, f, code, ...)                                                    \
    do {                                                                                 \
        if (wrong) {                                                                     \
            return fault_set(f, code, __VA_ARGS__);                                      \
        }                                                                                \
    } while (0)
