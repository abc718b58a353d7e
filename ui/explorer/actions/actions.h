// What the commands do. They call the session and change the state; what came of them they return.
#pragma once

#include "ui/explorer/actions/result.h"
#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/state.h"

// A command's function: takes its argument as text, "" if there is none.
typedef action_result action_function(explorer_state *st, const char *argument);

// One for each command. Those that need the commands or the whole screen (keys, settings, files)
// stand above this folder, all others in it.
#define ACTION_FUNCTION(group, name, argument, help, function) action_function function;
COMMAND_LIST(ACTION_FUNCTION)
#undef ACTION_FUNCTION

// Reads a finite number.
action_result act_read_number(const char *text, double *value);

// The same where the argument may be left out: the value stays.
action_result act_read_optional(const char *text, double *value);

// --- the run ----------------------------------------------------------------------------------

// Replaces the session by one of another scenario, which plays; the old one stays if that fails.
action_result act_open_scenario(explorer_state *st, const char *name);

// Gives a parameter another value, from the cursor on or from the start.
action_result act_change(explorer_state *st, int parameter, const char *text);

// A warning if the present run stopped on the way, or the question whether its program may run;
// nothing to say if not.
action_result act_tell_failed_run(const explorer_state *st);

// News if a program had to go through its past once more for the present run, once.
action_result act_tell_replay(explorer_state *st);

// Refused while the run is being computed: what needs all of it cannot be done.
action_result act_need_whole_run(const explorer_state *st);

// --- time -------------------------------------------------------------------------------------

// Lets wall-clock time pass [s]: moves the cursor if the explorer plays.
action_result act_advance(explorer_state *st, double seconds);

// Stops playing and moves the cursor to an instant [s].
void act_scrub(explorer_state *st, double time);

// Makes the visible part of the run longer (factor above 1) or shorter round an instant, or moves
// it [s].
void act_zoom_at(explorer_state *st, double factor, double time);
void act_pan_by(explorer_state *st, double seconds);

// --- pulling the tip --------------------------------------------------------------------------

// Takes hold of the tip with a pointer at a place [m], moves that, and lets go of it.
action_result act_hold_tip(explorer_state *st, plane_vector place);
void act_move_pull(explorer_state *st, plane_vector place);
action_result act_drop_pull(explorer_state *st);
// Gives the run the pushes that are due until an instant [s], if the tip is held.
action_result act_pull_until(explorer_state *st, double time);

// --- filters ----------------------------------------------------------------------------------

// After the filter of a panel changed: back to its top, with something selected that it lets
// through.
void act_settle_filter(explorer_state *st, panel_id panel);

// --- sweeps -----------------------------------------------------------------------------------

// Computes the next run of a sweep that is not complete.
action_result act_continue_sweep(explorer_state *st);

// Moves the selection among a sweep's runs.
void act_select_swept(explorer_state *st, int direction);

// Makes the present run that of the selected value, by a change from the start.
action_result act_take_swept(explorer_state *st);

// --- lessons ----------------------------------------------------------------------------------

// Takes note of a step of the lesson that is done by now.
action_result act_follow_lesson(explorer_state *st);

// --- the palette -------------------------------------------------------------------------------

// Moves the selection up (-1) or down (1), kept within the list; without words to search for it may
// leave the list at its top.
void act_move_in_palette(explorer_state *st, int direction);

// The line that does what the selected entry is for; false if none is selected. *goes_on: an
// argument is to be typed behind it.
bool act_line_of_palette(const explorer_state *st, char line[LINE_TEXT], bool *goes_on);

// --- axes of values ---------------------------------------------------------------------------

// Makes a pane's axis longer or shorter round a share of its height from the top, or moves it up by
// a share of it; it is fixed then.
void act_scale_axis(explorer_state *st, int index, double factor, double share);
void act_shift_axis(explorer_state *st, int index, double share);

// --- sliders ----------------------------------------------------------------------------------

// A slider that the mouse holds: its parameter, the share of its scale, its cells.
typedef struct slider_drag {
    int parameter;
    double share; // 0 to 1
    int cells;
} slider_drag;

// Takes hold of a slider or moves it: only says where it is.
void act_hold_slider(explorer_state *st, slider_drag d);
// Gives the parameter the value that the slider shows; once for each picture, however often the
// mouse has moved.
action_result act_follow_slider(explorer_state *st);
// Lets go of it, with its value given.
action_result act_drop_slider(explorer_state *st);
