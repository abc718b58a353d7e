// The codes of what can go wrong.
#pragma once

// One list, two uses: the enumeration and the text of each code.
#define STATUS_LIST(X)                                                                             \
    X(STATUS_OK, "done")                                                                           \
    X(STATUS_BAD_ARGUMENT, "bad argument")                                                         \
    X(STATUS_BAD_SCENARIO, "bad scenario")                                                         \
    X(STATUS_NOT_FINITE, "a state became infinite or not a number")                                \
    X(STATUS_UNSTABLE, "the energy ledger does not close, the integration is unstable")            \
    X(STATUS_NEWTON_FAILED, "Newton's iteration did not converge")                                 \
    X(STATUS_NO_PROGRESS, "events or strides follow one another without time passing")             \
    X(STATUS_SINGULAR, "the system of equations is singular")                                      \
    X(STATUS_NO_MEMORY, "out of memory")                                                           \
    X(STATUS_CANNOT_WRITE, "a file could not be written")                                          \
    X(STATUS_CANNOT_READ, "a file could not be read")                                              \
    X(STATUS_EXPECTATION_FAILED, "an expected value was not met")                                  \
    X(STATUS_STOPPED, "stopped before its end")                                                    \
    X(STATUS_FOLDED, "the arm is folded across the hub's axis on a flat wall")                     \
    X(STATUS_CONTROLLER_FAILED, "the controller failed")                                           \
    X(STATUS_NOT_ALLOWED, "a program or plug-in was not allowed")

typedef enum status {
#define STATUS_ENUM(code, text) code,
    STATUS_LIST(STATUS_ENUM)
#undef STATUS_ENUM
} status;

// The general text of a status code, never NULL.
const char *status_text(status code);
