// The state of the explorer: the session shown, and how it is shown. Actions change it;
// panels draw it without changing it. It does not depend on a terminal or on positions on
// the screen.
#pragma once

#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/panes.h"
#include "ui/explorer/state/parameter_list.h"
#include "ui/explorer/state/playback.h"
#include "ui/explorer/state/prompt.h"
#include "ui/explorer/state/runs.h"
#include "ui/explorer/state/scenario_menu.h"
#include "ui/explorer/state/view.h"

enum {
    SIDE_WIDTH = 72
}; // least width of a screen with the side panels next to the curves [cells]
// The present run, pinned runs, runs of a sweep, the run before the adjustment of a
// value, and measured data.
enum { SHOWN_RUNS = 1 + PINNED_RUNS + SWEPT_RUNS + 2 };

// A run with visible curves.
typedef struct shown_run {
    enum {
        SHOWN_PRESENT,
        SHOWN_DIFFERENCE,
        SHOWN_PINNED,
        SHOWN_SWEPT,
        SHOWN_BEFORE,
        SHOWN_MEASURED
    } kind;
    int index; // among the runs of its kind
    const trace *trace;
    unsigned long id; // of its rows, never 0
} shown_run;

// Second cursor.
typedef struct time_mark {
    bool set;
    double time; // [s]
    size_t side; // of an event at it (trace_side)
} time_mark;

// The side panel.
typedef struct side_view {
    panel_id panel;
    bool in_front; // a narrow screen shows it instead of the curves
} side_view;

// What the last picture decided, and the next one begins with.
typedef struct drawn_view {
    int scroll[PANEL_IDS];  // by panel: number of lines scrolled from its automatic
                            // position
    bool folded[PANEL_IDS]; // panels of the stack that had no room: Tab selects them
    int page_lines;         // of the page, shown at once
    int first_scenario; // line of their list shown first; negative: the selected one in
                        // the middle
    arm_stage stage;    // where the arm was drawn
} drawn_view;

// A scenario that was opened before the present one, or that undoing has left: as it was
// then.
typedef struct visit {
    run_origin from;
    lesson_progress lesson;
} visit;

enum { VISITS = 32 }; // kept for undoing, the present one included

typedef struct screen_size {
    int width, height; // [cells]
} screen_size;

typedef struct explorer_state {
    // the runs
    session session;
    run_list pinned;
    lab_sweep sweep;
    run_difference difference;
    solved_limit limit;
    solved_limit band; // a tolerance on both sides of the baseline
    note notes[NOTES]; // in time
    int note_count;
    int note;                // the selected one
    run_difference residual; // of the measured data from the run
    trace measured;          // data laid under the run, no rows: none
    char measured_file[LINE_TEXT];
    double measured_shift;      // by which they lie later than in the file [s]
    bool measured_aligned;      // they touch when the run does
    unsigned long measured_run; // the run they were last aligned to
    unsigned long measured_id;  // counts the files read, and how often one was shifted
    unsigned opened;            // number of scenarios opened
    visit visits[VISITS];       // [present_visit] is empty: it is the session
    int visit_count, present_visit;

    // the instants of interest
    playback playback;
    time_window window;
    time_mark mark;

    // what is displayed of them
    pane_set panes;
    zoom_box box;
    int panes_height; // height of the screen for which they were filled [cells]
    side_view side;
    parameter_list parameters;
    filters filters;
    panel_id page; // over the panels, PANEL_NONE if there is none
    scenario_menu scenarios;
    lesson_progress lesson;
    int change; // the selected change, index in session.inputs
    drawn_view drawn;
    slider_grip slider;
    tip_pull pull;
    looks looks;
    screen_size size; // of the screen drawn last

    // messages and input
    fault fault; // of what an action called last, until act_worked has told it
    message_line message;
    prompt prompt;
    palette_view palette;
    key_bindings keys;
    char last_law[LINE_TEXT];     // the law that was switched off last, "" for none
    bool settings_broken;         // the settings file contains errors
    unsigned long saved_version;  // the run last saved as a scenario, 0 for none
    char *copied;                 // for the terminal's clipboard, NULL: nothing
    char session_path[LINE_TEXT]; // the session file of this visit, "" for none
    unsigned long kept_pins; // runs ever pinned when they were last saved in a session
    bool asked_to_quit;      // the last key asked to quit, and changes would be lost
    bool quit;

    // results derived from the runs, kept until they change
    law_modes modes;
    run_log log;
    extremes extremes[SHOWN_RUNS];
} explorer_state;

// Opens the state with a scenario, which it owns from then on, also on failure. Waits for
// runs at most `patience` [s].
status state_init(explorer_state *st, scenario *s, double patience, fault *f);
void state_finish(explorer_state *st);

// Shows another session, which it owns from then on, as if newly opened; pinned runs
// stay. What was there can be returned to. On failure nothing changes and the caller
// keeps the session.
status state_take_session(explorer_state *st, session *fresh, fault *f);
// Returns to the scenario before (-1), or goes on to the one that this left (1).
bool state_can_turn(const explorer_state *st, int direction);
status state_turn(explorer_state *st, int direction, fault *f);

// Updates everything that drawing reads: panes, window, growing axes and results derived
// from the runs.
void state_update(explorer_state *st);

// Lays the measured data under the run, so much later than in their file [s]; NaN: they
// touch when the run does, and go with it. False where no force in both shows that: they
// stay as they are.
bool state_lay_data(explorer_state *st, double shift);

// A number that identifies the present run among the runs of all sessions opened; never
// 0.
unsigned long state_run_id(const explorer_state *st);
// Whether panes show the difference from the baseline in the place of the runs.
bool state_subtracts(const explorer_state *st);
// The runs whose curves a pane shows, or any that is not of residuals (NULL); returns how
// many. 0 is the present one (or, alone, its difference from the baseline), the others
// are for comparison.
int state_runs(const explorer_state *st, const pane *p, shown_run runs[SHOWN_RUNS]);
int state_run_count(const explorer_state *st);
shown_run state_run(const explorer_state *st, int index);
// The row of a run or a difference at the cursor, on the side of an event where that
// stands.
size_t state_row(const explorer_state *st, const trace *t);
// The name of a run, "" for the present one and for runs without a name.
const char *state_run_name(const explorer_state *st, int index);
// The number of pinned runs that are not hidden.
int state_visible_pins(const explorer_state *st);
// The parameters at the cursor.
parameters state_parameters(const explorer_state *st);

// The visible part of the run [s].
void state_window(const explorer_state *st, double *from, double *to);
// Makes a part visible, limited to the run [s].
void state_show_part(explorer_state *st, double from, double to);

// Low and high of each block of a signal of a run, low above high in a block without a
// finite value; NULL if they do not cover all rows of its trace.
const double *extremes_pairs(const extremes *e, const shown_run *run, int signal);

// The axis of a pane in the visible part of the run; false if no signal of it has a value
// there.
bool state_pane_axis(const explorer_state *st, int index, value_range *axis);

// Brings extremes and growing axes up to date, and the visible part to the cursor, unless
// that is adrift.
void state_update_axes(explorer_state *st);

// Whether there is a control law, and its modes.
bool state_has_law(const explorer_state *st);
const law_modes *state_law_modes(explorer_state *st);
// The log of the present run.
const run_log *state_run_log(explorer_state *st);

// The lines of the list of parameters that are shown, as of parameter_list_lines.
int state_parameter_lines(const explorer_state *st, parameter_line lines[PARAMETER_LINES],
                          int *selected);
// A change as a line of text: parameter and value, without its instant.
void state_change_text(const explorer_state *st, int index, char *text, size_t size);
// Why a parameter has no effect on the run, half a sentence; NULL if it has one.
const char *state_inert_reason(const explorer_state *st, int parameter);
