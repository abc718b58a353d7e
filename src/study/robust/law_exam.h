// An exam of control laws: cases of errors that they are not told (law_errors.h), each
// run at several commanded forces and judged by bounds that are the same for all.
//
// A run is within the bounds if its smoothed overshoot (the mean of the force over 5 ms
// above the command) is at most 30 % of the command, it settles within 0.3 s of first
// contact, or of a push after it, within 0.6 s where contact was lost, its steady error
// is at most 5 %, and its first contact comes at most 1.5 times as late as open-loop's in
// the same case. A push p on a tip that presses on a wall is p/5 ms of force whatever a
// law does: the overshoot is that of the same case without the push.
#pragma once

#include <jansson.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>

#include "src/study/robust/law_errors.h"

// Open-loop's time of first contact times this is the bound of a law that may come later.
#define EXAM_LATER 2.5

enum { EXAM_MOST_LAWS = 8, EXAM_MOST_FORCES = 8, EXAM_MOST_CASES = 100000 };

typedef struct exam_request {
    const scenario *base;
    int laws[EXAM_MOST_LAWS]; // control_law
    int law_count;
    double forces[EXAM_MOST_FORCES]; // commands [N]
    int force_count;
    size_t cases;  // 1 ... EXAM_MOST_CASES
    uint64_t seed; // of the first case; each next one has the next seed
} exam_request;

// What a run can miss.
typedef enum exam_bound {
    EXAM_OVERSHOOT,
    EXAM_SETTLING,
    EXAM_ERROR,
    EXAM_LATENESS,
    EXAM_RUN, // it ended by a fault, or is not accurate
    EXAM_BOUNDS
} exam_bound;

// What a law did in a case.
typedef struct exam_verdict {
    double overshoot;   // smoothed, of the command [%]
    double settling;    // [s], NaN: it never settles
    double error;       // steady, of the command [%]
    double separations; // from the wall
    double late;        // first contact over open-loop's
    bool missed[EXAM_BOUNDS];
    bool within;       // all of the bounds,
    bool within_later; // and these with first contact up to EXAM_LATER times as late
    double worst; // largest ratio of a quantity to its bound, HUGE_VAL where it failed
} exam_verdict;

typedef struct law_exam {
    exam_request asked;
    drawn_case *cases;      // owned, [cases]
    exam_verdict *verdicts; // owned, [law][force][case]
    size_t runs, done;      // of all
} law_exam;

typedef struct exam_options {
    int jobs;                          // threads, 1 ... POOL_MOST_THREADS
    const volatile sig_atomic_t *stop; // becomes true to end early, or NULL
    const atomic_bool *abandon;        // the same for runs in hand
    void (*report)(const law_exam *e); // about ten times a second, or NULL
} exam_options;

// Draws, runs and judges. STATUS_BAD_ARGUMENT where an error cannot be drawn around the
// scenario; STATUS_STOPPED if *stop became true, and then asked.cases are the first
// cases, whose runs were all done, and those are judged; STATUS_NO_MEMORY.
// law_exam_finish in any case.
status law_exam_run(law_exam *e, const exam_request *asked, const exam_options *options,
                    fault *f);
void law_exam_finish(law_exam *e);

// The verdict of a case, all from 0.
const exam_verdict *law_exam_verdict(const law_exam *e, int law, int force, size_t which);

// A share of cases and its 95 % interval (Wilson, J. Am. Stat. Assoc. 22, 1927).
typedef struct exam_share {
    size_t cases, within;
    double share, low, high; // NaN without cases
} exam_share;

// Of the cases with a kind of error; kind -1: of all.
exam_share law_exam_share(const law_exam *e, int law, int force, int kind);

// Of all cases, with first contact up to EXAM_LATER times as late as open-loop's.
exam_share law_exam_share_later(const law_exam *e, int law, int force);

// The rows of another exam over the same cases, as law_exam_json wrote them.
typedef struct exam_rows {
    json_t *object; // owned
    const char *path;
} exam_rows;

// Reads them. STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT if they are of other cases, or of
// no exam.
status exam_rows_read(exam_rows *rows, const char *path, const law_exam *e, fault *f);
void exam_rows_finish(exam_rows *rows);

// For people, a table of shares and one by kind; a row for each run as CSV; all of it as
// JSON, NULL without memory. `beside` (may be NULL) are rows that each law is compared
// with, case by case; several laws of one exam are compared with the first.
void law_exam_text(FILE *stream, const law_exam *e, const exam_rows *beside);
void law_exam_csv(FILE *stream, const law_exam *e);
json_t *law_exam_json(const law_exam *e, const exam_rows *beside);
