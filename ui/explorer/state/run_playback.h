// A run in time: its log, how fast the cursor moves over it while it plays, and the tip
// that is pulled meanwhile.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/rig/rig.h"
#include "src/run/trace.h"
#include "src/tables/parameters.h"

// --- playing ---------------------------------------------------------------------------

#define USUAL_SLOW 8.0 // the same as in films

typedef struct playback {
    bool playing;
    double speed;    // set: simulated seconds per second
    double measured; // measured recently; 0 if not known
    double slow;     // factor by which it is slower near impacts, from 1
    double slowed;   // the present factor
} playback;

// How many times slower the run is to be shown at an instant [s], 1 to p->slow: near
// impacts that follow an interval without any, as in films. `duration` [s] is that of the
// whole run.
double playback_slowness(const playback *p, const trace *t, double duration, double time);

// The next faster (direction 1) or slower (-1) of the usual speeds; the present one at an
// end.
double playback_next_speed(const playback *p, int direction);

// --- the tip that is pulled ------------------------------------------------------------
// By the mouse, through a spring from the tip to the pointer. While it is held the run
// plays, and every few milliseconds the spring's force is added to the run as a push. The
// pull is thus recorded as a list of timed inputs and is repeated when the run is
// computed again.

#define PULL_STIFFNESS 10.0  // of the spring [N/m]
#define PULL_STEP      0.005 // of the run between two pushes [s]

// The area in which the arm was drawn last.
typedef struct arm_stage {
    int x, y, width, height; // [cells]; width 0: not drawn
    double left, bottom;     // of it [m]
    double across, up;       // [cells/m]
} arm_stage;

// A place in the plane, or a direction.
typedef struct plane_vector {
    double x, y; // [m]
} plane_vector;

typedef struct tip_pull {
    bool held;
    double x, y;      // of the pointer [m]
    double force;     // of the spring across the last link, towards growing angle [N]
    double next;      // when the next push is due [s]
    bool was_playing; // before it was held
    unsigned gesture; // number of this pull in the session's inputs
} tip_pull;

// The place of a cell's middle on the stage [m].
plane_vector stage_place(const arm_stage *g, int x, int y);

// The cell in which a place [m] is shown, which may be outside.
void stage_cell(const arm_stage *g, plane_vector place, int *x, int *y);

// The tip and the direction across the last link, towards growing angle, in a recorded
// row.
void recorded_tip(const trace *t, const arm_parameters *beam, size_t row,
                  plane_vector *tip, plane_vector *across);

// The spring's force across the last link [N].
double pull_force(const tip_pull *p, plane_vector tip, plane_vector across);

// --- the log ---------------------------------------------------------------------------
// Events together with the controller's changes of mode, in the order of time.

typedef struct log_entry {
    double time; // [s]
    int event;   // index in the trace, -1 for a change of mode
    double mode; // the mode entered
} log_entry;

typedef struct run_log {
    unsigned long run; // the run of the log; 0: none
    log_entry *entries;
    size_t count, capacity;
    size_t rows, events; // already included
    double mode;         // at the last row, NaN before the first
} run_log;

// Adds the entries of new rows and events since the last call. `complete`: the run has
// ended.
void run_log_update(run_log *log, unsigned long run, const trace *t, bool complete);

// The instant of the next entry after a time (direction 1) or the last one before it (-1)
// [s]; negative if there is none.
double run_log_next(const run_log *log, double time, int direction);

void run_log_forget(run_log *log);

// --- modes of the control law ----------------------------------------------------------

enum { LAW_MODES = 12 };

typedef struct law_modes {
    unsigned long run; // the run of the law; 0: none
    int count;
    bool lockable; // the law can be held in one of them
    char names[LAW_MODES][MODE_NAME_SIZE];
} law_modes;

// The name of a mode; "mode N" if the law gives none.
void law_mode_name(const law_modes *m, double mode, char *text, size_t size);
