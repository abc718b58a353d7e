// A recorded run: rows of samples, the link angles at each, and the events between them.
#pragma once

#include "src/base/csv_table.h"
#include "src/base/fault.h"
#include "src/base/shared_array.h"
#include "src/tables/signals.h"

// The kinds of events: name in the enumeration, word in JSON and on screens, what
// happens.
#define EVENT_KINDS(KIND)                                                                \
    KIND(IMPACT, "impact", "the gap closes with an approach speed: an impulse acts")     \
    KIND(CONTACT, "contact", "contact goes on after an impact, or begins without one")   \
    KIND(RELEASE, "release", "the contact force reaches zero")                           \
    KIND(STICK, "stick", "the hub comes to rest and friction holds it")                  \
    KIND(REVERSAL, "reversal", "the hub comes to rest and turns back at once")           \
    KIND(SLIP, "slip", "the hub breaks away")                                            \
    KIND(CHANGE, "change", "a scripted change of a parameter")                           \
    KIND(PUSH, "push", "a scripted push")                                                \
    KIND(CHATTER, "chatter",                                                             \
         "too many short flights in a row: the impact took all the approach speed")

typedef enum event_kind {
#define EVENT_KIND(name, word, description) EVENT_##name,
    EVENT_KINDS(EVENT_KIND)
#undef EVENT_KIND
} event_kind;

typedef struct event {
    double time; // [s]
    event_kind kind;
    double impulse;         // impact: of the wall [N s]; push: as scripted; else 0
    double speed;           // impact: approach speed [m/s]; else 0
    double loss;            // impact: energy lost [J]; else 0
    int index;              // change, push: which action of the scenario; else -1
    bool delivered_by_step; // impact: the impulse is in the force of the step behind it
} event;

// "impact", "contact", ...
const char *event_name(event_kind kind);
// What happens at such an event, without a full stop; NULL past the last kind.
const char *event_description(int kind);

// The arrays of a trace: those of rows, then the events.
enum { TRACE_ROWS, TRACE_VELOCITIES, TRACE_ANGLES, TRACE_EVENTS, TRACE_ARRAYS };

typedef struct trace {
    sample *rows;
    double *
        angles; // row r: angles[r * angle_count ...], the hub's first if it has one [rad]
    double *velocities; // the same of their velocities [rad/s]
    event *events;
    size_t row_count, event_count;
    int angle_count;
    shared_array arrays[TRACE_ARRAYS]; // where the four above lie
} trace;

// An empty trace for angle_count link angles a row.
void trace_init(trace *t, int angle_count);
// The same in shared arrays (src/base/shared_array.h): for `least` rows and, if there is
// room, `most`.
status trace_reserve(trace *t, int angle_count, size_t least, size_t most);
void trace_finish(trace *t);

// Lets a trace, still empty, begin with the first rows and events of another one: without
// a copy where both are reserved. STATUS_NO_MEMORY if there is no room.
status trace_share(trace *t, const trace *from, size_t rows, size_t events);

// What a row takes [bytes].
static inline size_t trace_row_bytes(int angle_count)
{
    return sizeof(sample) + 2 * sizeof(double) * (size_t)angle_count;
}

// Makes room for so many rows in advance. False without memory, then the trace is as it
// was.
bool trace_expect(trace *t, size_t rows);

// The place of the next row, where it may be filled in before it is appended; NULL if
// there is no room.
sample *trace_next_row(trace *t);

// Append a row (angles, velocities: angle_count values each), which may stand in its
// place already, or an event; STATUS_NO_MEMORY if there is no room.
status trace_add_row(trace *t, const sample *row, const double *angles,
                     const double *velocities);
status trace_add_event(trace *t, event e);

// Takes the storage of a trace's events away, which is without events then; an array that
// can be given to another trace and is finished at last.
shared_array trace_take_events(trace *t);

// Gives a trace such storage in the place of its own, unless it has events already.
// *storage is empty afterwards, or as before.
void trace_give_events(trace *t, shared_array *storage);

// Forgets all rows but the last one.
void trace_keep_last_row(trace *t);

// Takes a row with the angles of all links [rad], the hub's first if it has one. What it
// returns, if it is not STATUS_OK, ends the work that rows come from.
typedef status row_taker(void *context, const sample *row, const double *angles);

// How many rows have a time that is not after `time` [s].
size_t trace_rows_until(const trace *t, double time);

// The last row whose time is not after `time` [s]; 0 for an earlier time.
size_t trace_row_at(const trace *t, double time);

// Several rows of one instant are the sides of what happens at it. The side that a row
// stands for: 0 the last one, SIZE_MAX the first of several, else how many follow it.
size_t trace_side(const trace *t, size_t row);

// The row of an instant [s] on a side, the last row before it if it has none.
size_t trace_row_on_side(const trace *t, double time, size_t side);

// What a run was at an instant [s] between the times of two rows, b after a: straight
// between them; a state is a's until b, and no impulse acts.
sample trace_between(const sample *a, const sample *b, double time);

// What a run was at an instant [s] on a side: that row, or trace_between two rows.
sample trace_sample_at(const trace *t, double time, size_t side);

// Whether any row holds a finite value of the signal.
bool trace_has(const trace *t, int signal);

// --- statistics of a signal ------------------------------------------------------------

typedef struct signal_statistics {
    double minimum, maximum; // in the signal's unit
    double mean;             // over time
    double rms;              // square root of the mean square over time
    double integral; // over time [unit s]; a force's is its momentum, impulses excluded
    double duration; // for which it had a value [s]
} signal_statistics;

// Of a signal from one instant to a later one [s], straight between rows, both kept
// within the run. All NaN where it never has a value.
signal_statistics trace_statistics(const trace *t, int signal, double from, double to);

// --- recorded tables as traces: measured signals beside those of a run ---

// Appends a row for each row of a table with a column of times, or of numbers of samples
// that came at `rate` [1/s] (0: such are refused): of the columns that are
// headed as signals, in their units, or of `column` alone (not NULL), which stands for
// `signal`. What was not measured is NaN. STATUS_BAD_ARGUMENT with the line in f: no
// time, times that fall, no such column, a field that is no number, no number at all;
// STATUS_NO_MEMORY. Of a table with more than `most` rows (0: any) about so many are
// appended: of every few those in which a column is least or largest, so that no peak is
// lost.
status measured_rows(trace *t, csv_table *table, double rate, const char *column,
                     int signal, size_t most, fault *f);
