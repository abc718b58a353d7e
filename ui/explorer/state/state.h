// The state of the explorer: the session it looks at, and how it is looked at. Actions change it;
// panels draw it and do not change it. It knows no terminal and no place on the screen.
#pragma once

#include "src/session/session.h"
#include "ui/explorer/state/extremes.h"
#include "ui/explorer/state/filters.h"
#include "ui/explorer/state/key_bindings.h"
#include "ui/explorer/state/difference.h"
#include "ui/explorer/state/lab_sweep.h"
#include "ui/explorer/state/law_modes.h"
#include "ui/explorer/state/lesson_progress.h"
#include "ui/explorer/state/looks.h"
#include "ui/explorer/state/message.h"
#include "ui/explorer/state/palette.h"
#include "ui/explorer/state/panel_list.h"
#include "ui/explorer/state/panes.h"
#include "ui/explorer/state/parameter_list.h"
#include "ui/explorer/state/playback.h"
#include "ui/explorer/state/prompt.h"
#include "ui/explorer/state/pull.h"
#include "ui/explorer/state/run_list.h"
#include "ui/explorer/state/run_log.h"
#include "ui/explorer/state/scenario_menu.h"
#include "ui/explorer/state/slider.h"
#include "ui/explorer/state/time_window.h"

enum { SIDE_WIDTH = 72 }; // of a screen that has room for the side beside the curves [cells]
// The present run, those pinned, those of a sweep, and the one before a value that is adjusted.
enum { SHOWN_RUNS = 1 + PINNED_RUNS + SWEPT_RUNS + 1 };

// A run whose curves are shown.
typedef struct shown_run {
    enum { SHOWN_PRESENT, SHOWN_DIFFERENCE, SHOWN_PINNED, SHOWN_SWEPT, SHOWN_BEFORE } kind;
    int index; // among those of its kind
    const trace *trace;
    unsigned long id; // of its rows, never 0
} shown_run;

// Second cursor.
typedef struct time_mark {
    bool set;
    double time; // [s]
} time_mark;

// What stands on the right.
typedef struct side_view {
    panel_id panel;
    bool in_front; // a narrow screen shows it in the place of the curves
} side_view;

// What has opened over the panels.
typedef struct page_view {
    panel_id panel; // PANEL_NONE if nothing has
    int lines;      // of it that are shown at once, as it was drawn last
} page_view;

typedef struct screen_size {
    int width, height; // [cells]
} screen_size;

typedef struct explorer_state {
    // the runs
    session session;
    run_list pinned;
    lab_sweep sweep;
    run_difference difference;
    unsigned opened; // counts the scenarios that were opened

    // the instants that are looked at
    playback playback;
    time_window window;
    time_mark mark;

    // what is shown of them
    pane_set panes;
    int panes_height; // of the screen they were filled for [cells]
    side_view side;
    parameter_list parameters;
    filters filters;
    page_view page;
    scenario_menu scenarios;
    lesson_progress lesson;
    int change;            // selected among the changes, index in session.inputs
    int scroll[PANEL_IDS]; // by panel: lines it is away from where it stands by itself
    slider_grip slider;
    tip_pull pull;
    arm_stage stage; // of the arm
    looks looks;
    screen_size size; // of the screen drawn last

    // what is said and typed
    message_line message;
    prompt prompt;
    palette_view palette;
    key_bindings keys;
    char last_law[LINE_TEXT];    // the one that was on when it was switched off, "" for none
    bool settings_broken;        // the settings file has faults
    unsigned long saved_version; // the run that was saved as a scenario last, 0 for none
    bool asked_to_quit;          // the last key did, and changes would be lost
    bool quit;

    // what is known of the runs, kept until they change
    law_modes modes;
    run_log log;
    extremes extremes[SHOWN_RUNS];
} explorer_state;

// Opens the state on a scenario, taken over also on failure. Waits for runs not longer than
// `patience` [s].
status state_init(explorer_state *st, scenario *s, double patience, fault *f);
void state_finish(explorer_state *st);

// Looks at another session, taken over, as at a fresh one.
void state_take_session(explorer_state *st, session *fresh);

// Brings all that drawing reads up to date: panes, window, axes that grow, and what is known of the
// runs.
void state_update(explorer_state *st);

// Identifies the present run among all of all sessions opened here; never 0.
unsigned long state_run_id(const explorer_state *st);
// The runs whose curves are shown: 0 is the present one (or its difference from the baseline,
// alone), the others are kept for comparison.
int state_run_count(const explorer_state *st);
shown_run state_run(const explorer_state *st, int index);
// What a run is called, "" for the present one and for those that have no name.
const char *state_run_name(const explorer_state *st, int index);
// Pinned runs that are not hidden.
int state_visible_pins(const explorer_state *st);
// The parameters at the cursor.
parameters state_parameters(const explorer_state *st);

// The visible part of the run [s].
void state_window(const explorer_state *st, double *from, double *to);
// Makes a part visible, kept within the run [s].
void state_show_part(explorer_state *st, double from, double to);

// The axis of a pane in the visible part of the run; false if no signal of it has a value there.
bool state_pane_axis(const explorer_state *st, int index, value_range *axis);

// Whether a control law is on, and its modes.
bool state_has_law(const explorer_state *st);
const law_modes *state_law_modes(explorer_state *st);
// The log of the present run.
const run_log *state_run_log(explorer_state *st);

// The lines of the list of parameters that are shown; returns how many.
int state_parameter_lines(const explorer_state *st, parameter_line lines[PARAMETER_LINES]);
// A change as a line of text: what it gives what, without its instant.
void state_change_text(const explorer_state *st, int index, char *text, size_t size);
// Changes that take effect after the cursor.
int state_later_changes(const explorer_state *st);
// Why a parameter has no effect on the run, half a sentence; NULL if it has one.
const char *state_inert_reason(const explorer_state *st, int parameter);
