// The state of the explorer in three parts: the model of what was run, the view of it,
// and the input. Actions change the parts they are given; panels draw parts without
// changing them. The state does not depend on a terminal. The explorer itself alone
// (explorer.h), which owns the loop, has all three together.
#pragma once

#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/panes.h"
#include "ui/explorer/state/shown_parameters.h"
#include "ui/explorer/state/run_playback.h"
#include "ui/explorer/state/prompt.h"
#include "ui/explorer/state/run_list.h"
#include "ui/explorer/state/scenario_menu.h"
#include "ui/explorer/state/view.h"

enum {
    SIDE_WIDTH = 72
}; // least width of a screen with the side panels next to the curves [cells]
// The present run, the run as opened, pinned runs, runs of a sweep, and measured data.
enum { SHOWN_RUNS = 2 + PINNED_RUNS + SWEPT_RUNS + 1 };

// A run with visible curves.
typedef struct shown_run {
    enum {
        SHOWN_PRESENT,
        SHOWN_DIFFERENCE,
        SHOWN_OPENED,
        SHOWN_PINNED,
        SHOWN_SWEPT,
        SHOWN_MEASURED
    } kind;
    int index; // among the runs of its kind
    const trace *trace;
    unsigned long id; // of its rows, never 0
} shown_run;

// The run as the scenario was opened, before any change: what a change is held against as
// long as no run is pinned.
typedef struct reference_run {
    bool kept;
    bool shown;       // the present run is another one, and no pinned run is this one
    run_result run;   // its rows are shared with the session's
    unsigned long id; // of its rows
    bool pinned;      // a pinned run is this one
    unsigned long pins_seen; // what that was found out from
} reference_run;

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
    int scroll[PANEL_IDS]; // by panel: number of lines scrolled from its automatic
                           // position
    int page_lines;        // of the page, shown at once
    arm_stage stage;       // where the arm was drawn
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

// The model: the runs, what was done to them, and what follows from them.
typedef struct data_reading data_reading; // of a file that is being read
typedef struct run_search run_search;     // a limit or a fit that is searched for

typedef struct explorer_model {
    session session; // the present run, its changes and the cursor
    reference_run opened_run;
    unsigned long reference; // the run that session.other is, 0 for none
    run_list pinned;
    lab_sweep sweep;
    run_difference difference;
    solved_limit limit;
    note notes[NOTES]; // in time
    int note_count;
    lesson_progress lesson;
    char last_law[LINE_TEXT]; // the law that was switched off last, "" for none

    run_search *search; // that goes on, NULL: none

    // measured data
    data_reading *reading;   // of the next ones, NULL: none
    run_difference residual; // of the measured data from the run
    trace measured;          // data laid under the run, no rows: none
    char measured_file[LINE_TEXT];
    char measured_digest[SHA256_TEXT]; // of the file's content
    double measured_shift;             // by which they lie later than in the file [s]
    bool measured_aligned;             // they touch when the run does
    unsigned long measured_run;        // the run they were last aligned to
    unsigned long measured_id; // counts the files read, and how often one was shifted

    // the scenarios opened
    unsigned opened;      // number of them
    visit visits[VISITS]; // [present_visit] is empty: it is the session
    int visit_count, present_visit;

    // what was saved of all this
    unsigned long saved_version;  // the run last saved as a scenario, 0 for none
    char session_path[LINE_TEXT]; // the session file of this visit, "" for none
    char
        *saved_looks; // how the runs were looked at when that was saved last, NULL: never
    unsigned long kept_pins; // runs ever pinned when they were last saved in a session

    // results derived from the runs, kept until they change
    law_modes modes;
    run_log log;
    extremes extremes[SHOWN_RUNS];
} explorer_model;

// The view: how the model is shown, what is selected in it, and what the user has set up.
typedef struct explorer_view {
    // the instants of interest
    playback playback;
    time_window window;
    time_mark mark;

    // panes and panels
    pane_set panes;
    int panes_height; // height of the screen for which they were filled [cells]
    side_view side;
    parameter_list parameters;
    filters filters;
    panel_id page; // over the panels, PANEL_NONE if there is none
    scenario_menu scenarios;
    palette_view palette;
    file_list files;
    int change; // the selected change, index in session.inputs
    int note;   // the selected note
    drawn_view drawn;
    slider_grip slider;
    tip_pull pull;
    screen_size size; // of the screen drawn last

    // settings
    looks looks;
    key_bindings keys;
    char kept_panes[PANES + 1]; // that the settings file has, "" for none
    bool settings_broken;       // the settings file contains errors
} explorer_view;

// The input: what is being typed, and what is answered to it.
typedef struct explorer_input {
    prompt prompt;
    message_line message;
    fault fault;        // of what an action called last, until act_succeeded says it
    char *copied;       // for the terminal's clipboard, NULL: nothing
    bool has_terminal;  // programs can be started on it
    char edits[1024];   // file that an editor is to be started with, "" for none
    bool asked_to_quit; // the last key asked to quit, and changes would be lost
    bool quit;
} explorer_input;

// Opens the state with a scenario, which it owns from then on, also on failure. Waits for
// runs at most `patience` [s].
status state_init(explorer_model *model, explorer_view *view, scenario *s,
                  double patience, fault *f);
void state_finish(explorer_model *model, explorer_view *view);

// Shows another session, which it owns from then on, as if newly opened; pinned runs
// stay. What was there can be returned to. On failure nothing changes and the caller
// keeps the session.
status state_take_session(explorer_model *model, explorer_view *view, session *fresh,
                          fault *f);
// Returns to the scenario before (-1), or goes on to the one that this left (1).
bool model_has_visit(const explorer_model *model, int direction);
status state_change_visit(explorer_model *model, explorer_view *view, int direction,
                          fault *f);

// Updates everything that drawing reads: panes, window, growing axes and results derived
// from the runs.
void state_update(explorer_model *model, explorer_view *view);

// Lays the measured data under the run, so much later than in their file [s]; NaN: they
// touch when the run does, and go with it. False where no force in both shows that: they
// stay as they are.
bool model_lay_data(explorer_model *model, double shift);

// A number that identifies the present run among the runs of all sessions opened; never
// 0.
unsigned long model_run_id(const explorer_model *model);
// Whether panes show the difference from the baseline in the place of the runs.
bool model_subtracts(const explorer_model *model);
// The runs whose curves a pane shows, or any that is not of residuals (NULL); returns how
// many. 0 is the present one (or, alone, its difference from the baseline), the others
// are for comparison.
int model_runs(const explorer_model *model, const pane *p, shown_run runs[SHOWN_RUNS]);
int model_run_count(const explorer_model *model);
// The pinned reference as long as it is the present run itself, as nothing has changed
// since it was kept; else NULL.
const pinned_run *model_kept_run(const explorer_model *model);
// What a run shows as the k-th signal of a pane: that, but of measured data without a
// force what a sensor read in its place.
int shown_signal(const shown_run *run, const pane *p, int k);
shown_run model_run(const explorer_model *model, int index);
// The row of a run or a difference at the cursor, on the side of an event where that
// stands.
size_t model_row(const explorer_model *model, const trace *t);
// Whether runs stand beside the present one, so that a colour tells runs and not signals.
bool model_shows_others(const explorer_model *model);
// The place of a run among the looks of runs side by side (render/plot/run_style.h), from
// 1 on; 0 for what has no look of its own.
int shown_run_rank(const shown_run *run);
// The colour of that place on a screen.
ink run_ink(int rank);

// Keeps the run as opened while there is no change, and compares the present run with the
// baseline of the pinned ones, else with the run as opened. To be called after whatever
// changes or pins runs. STATUS_NO_MEMORY.
status model_follow_reference(explorer_model *model, fault *f);
// Gives up the run as opened.
void model_forget_opened_run(explorer_model *model);
// The name of the run that the present one is compared with; "" without one.
const char *model_reference_name(const explorer_model *model);
// Its place among the looks.
int model_reference_rank(const explorer_model *model);
// Setpoints and limits of what a pane shows, as they are at the cursor, and the bound
// that was asked for; returns how many.
enum { SHOWN_LEVELS = PANE_SIGNALS + 6 };
typedef struct shown_level {
    const char *name;
    double value;
    int signal; // at which it is drawn
} shown_level;
int model_levels(const explorer_model *model, const pane *p,
                 shown_level levels[SHOWN_LEVELS]);
// The parameters at the cursor.
parameters model_parameters(const explorer_model *model);

// The visible part of the run [s].
void view_window(const explorer_model *model, const explorer_view *view, double *from,
                 double *to);
// Makes a part visible, limited to the run [s].
void view_show_part(const explorer_model *model, explorer_view *view, double from,
                    double to);

// Low and high of each block of a signal of a run, low above high in a block without a
// finite value; NULL if they do not cover all rows of its trace.
const double *extremes_pairs(const extremes *e, const shown_run *run, int signal);

// The band in which the force counts as settled at what the law is to hold at the cursor
// [N], as `settling_time_s` has it; empty without such a law.
value_range view_force_band(const explorer_model *model);

// The axis of a pane in the visible part of the run; false if no signal of it has a value
// there.
bool view_pane_axis(const explorer_model *model, const explorer_view *view, int index,
                    value_range *axis);

// Brings extremes and growing axes up to date, and the visible part to the cursor, unless
// that is adrift.
void state_update_axes(explorer_model *model, explorer_view *view);

// Whether there is a control law, and its modes.
bool model_has_law(const explorer_model *model);
const law_modes *model_law_modes(explorer_model *model);
// The log of the present run.
const run_log *model_run_log(explorer_model *model);

// The parameter that a run is about: what its law presses with, or the voltage.
int model_main_parameter(const explorer_model *model);
// Makes the knobs of a list those of the present run: what it is about, what its scenario
// gives, what its law has of its own, what was changed; all of them have an effect.
void model_choose_knobs(const explorer_model *model, parameter_list *list);

// The lines of the list of parameters that are shown, as of parameter_list_lines.
int view_parameter_lines(const explorer_view *view, parameter_line lines[PARAMETER_LINES],
                         int *selected);
// A change as a line of text: parameter and value, without its instant.
void model_change_text(const explorer_model *model, int index, char *text, size_t size);
// Why a parameter has no effect on the run, half a sentence; NULL if it has one.
const char *model_inert_reason(const explorer_model *model, int parameter);
