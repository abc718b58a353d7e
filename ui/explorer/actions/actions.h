// The actions of the commands. They call the session, change the state and put what there
// is to say on the message line. Each returns false if it was refused or failed, which
// the message then says.
#pragma once

#include "src/base/fault.h"
#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/state.h"

// A command's function: takes its argument as text, "" if there is none.
typedef bool action_function(explorer_state *st, const char *argument);

// One for each command. Those that need the table of commands or the whole screen (keys,
// settings, files) are in the folder above, all others in this one.
#define ACTION_FUNCTION(group, name, keys, argument, help) action_function act_##name;
#define ACTION_NOW(group, name, keys, argument, help)      action_function act_##name##_now;
COMMAND_LIST(ACTION_FUNCTION, ACTION_NOW)
#undef ACTION_FUNCTION
#undef ACTION_NOW

// --- what is said ----------------------------------------------------------------------

// Puts a sentence on the message line and returns `done`.
bool act_say(explorer_state *st, bool warning, bool done, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Done: with a message, with a warning, without any (the message line is cleared).
#define act_tell(st, ...) act_say(st, false, true, __VA_ARGS__)
#define act_warn(st, ...) act_say(st, true, true, __VA_ARGS__)
bool act_hush(explorer_state *st);
// Not done: the argument is not what the action expects.
#define act_refuse(st, ...) act_say(st, true, false, __VA_ARGS__)
// Whether a call that returned `code` worked; if not, the state's fault is the message.
bool act_worked(explorer_state *st, status code);
// --- what is read ----------------------------------------------------------------------

// Reads a finite number.
bool act_read_number(explorer_state *st, const char *text, double *value);

// The same for an argument that may be a word instead, such as "" or "off": then the
// value stays.
bool act_read_number_or(explorer_state *st, const char *text, const char *word,
                        double *value);

// Reads the number of one of `count` things (`what`, in the plural; `lister` shows them),
// from 1, and the blanks behind it off *text. Returns its index, -1 if it is refused.
int act_read_index(explorer_state *st, const char **text, int count, const char *what,
                   const char *lister);

// Cuts an argument into words at its blanks; returns how many there are, of which the
// first four are in words[], in `text`.
int act_split(const char *argument, char text[LINE_TEXT], char *words[4]);

// Reads the pane of a word, a number from 1 or "all": *index -1.
bool act_read_pane(explorer_state *st, const char *word, int *index);

// --- the run ---------------------------------------------------------------------------

// Replaces the session by one of another scenario and plays it; if that fails the old one
// stays.
bool act_open_scenario(explorer_state *st, const char *name);

// Warns if the present run failed, or asks whether its program may run. True if there was
// something to say.
bool act_tell_failed_run(explorer_state *st);

// Adds to the message, once, that an external program had to repeat its earlier samples
// for the present run, if it had to.
void act_tell_replay(explorer_state *st);

// Refused while the run is being computed, for actions that need the complete run.
bool act_need_whole_run(explorer_state *st);

// Refused where so many runs take too long to be computed while the lab waits.
bool act_need_short_runs(explorer_state *st, const char *command, int runs);

// PATH or PATH=VALUES with the whole path of a parameter that is named by its last part.
// Returns text.
const char *act_whole_path(const char *word, char *text, size_t size);

// Pins the present run with another value from the start; act_settle_baseline is to
// follow.
status act_pin_value(explorer_state *st, const sweep_axis *axis, double value,
                     const char *name, fault *f);
// Compares the present run with the baseline of the pinned ones from now on.
bool act_settle_baseline(explorer_state *st);

// --- time ------------------------------------------------------------------------------

// Advances by wall-clock time [s]: moves the cursor during playback.
bool act_advance(explorer_state *st, double seconds);

// Stops playing and moves the cursor to an instant [s].
void act_scrub(explorer_state *st, double time);

// Makes the visible part of the run longer (factor above 1) or shorter about an instant,
// or shifts it [s].
void act_zoom_at(explorer_state *st, double factor, double time);
void act_pan_by(explorer_state *st, double seconds);
// Makes the part between two instants visible [s].
bool act_zoom_between(explorer_state *st, double from, double to);

// What the last input came to: that the run stops with it, that it has no effect, or its
// news.
bool act_tell_change(explorer_state *st);

// Gives a parameter another value, from the cursor on or from the start.
bool act_give(explorer_state *st, int parameter, const char *text);

// Says what happens at the cursor: an event of the run, else the controller's change of
// mode.
bool act_tell_event(explorer_state *st);

// --- pulling the tip -------------------------------------------------------------------

// Grasps the tip with the pointer at a place [m], moves the pointer, and releases the
// tip.
bool act_hold_tip(explorer_state *st, plane_vector place);
void act_move_pull(explorer_state *st, plane_vector place);
bool act_drop_pull(explorer_state *st);

// --- notes -----------------------------------------------------------------------------

// Takes a note out.
void act_drop_note(explorer_state *st, int index);

// --- filters ---------------------------------------------------------------------------

// After a change of a panel's filter: scrolls to the top and selects an entry that passes
// the filter.
void act_settle_filter(explorer_state *st, panel_id panel);

// --- sweeps ----------------------------------------------------------------------------

// Computes the next run of a sweep that is not complete.
bool act_continue_sweep(explorer_state *st);

// Moves the selection among a sweep's runs.
void act_select_swept(explorer_state *st, int direction);

// --- lessons ---------------------------------------------------------------------------

// Records that the present step of the lesson is done, if it is.
void act_follow_lesson(explorer_state *st);

// --- the palette -----------------------------------------------------------------------

// Moves the selection up (-1) or down (1) within the list. Without words to search for it
// may also move above the first entry.
void act_move_in_palette(explorer_state *st, int direction);

// --- axes of values --------------------------------------------------------------------

// Scales a pane's axis about a point, given as a share of its height from the top, or
// shifts it up by a share of its height. The axis is fixed afterwards.
void act_scale_axis(explorer_state *st, int index, double factor, double share);
void act_shift_axis(explorer_state *st, int index, double share);

// Hides the k-th signal of a pane, or shows it.
bool act_toggle_signal(explorer_state *st, int index, int k);

// --- sliders ---------------------------------------------------------------------------

// Starts dragging a parameter's slider or moves it to a share of its scale, 0 to 1; only
// stores its position. It is some cells wide.
void act_hold_slider(explorer_state *st, int parameter, double share, int cells);
// Sets the parameter to the value of the slider; called once for each picture, however
// often the mouse has moved.
bool act_follow_slider(explorer_state *st);
// Ends dragging, with the last value set.
bool act_drop_slider(explorer_state *st);
