// The actions of the commands. They call the session, change the state and put what there
// is to say on the message line. Each returns false if it was refused or failed, which
// the message then says.
#pragma once

#include "src/base/fault.h"
#include "src/base/numbers.h"
#include "ui/explorer/state/command_list.h"
#include "ui/explorer/state/palette.h"
#include "ui/explorer/state/state.h"

// --- the commands ----------------------------------------------------------------------
// One action for each command (command_list.h), which is given the parts of the state
// that it changes, those that it reads as const, and the command's argument as text, ""
// if there is none. Those that need the table of commands or the whole screen (keys,
// settings, files) are in the folder above.

// time (time_actions.c)
bool act_play(explorer_model *model, explorer_view *view, explorer_input *input);
bool act_step(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_event(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument);
bool act_touch(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument);
bool act_seek(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_speed(explorer_view *view, explorer_input *input, const char *argument);
bool act_slow(explorer_view *view, explorer_input *input, const char *argument);
bool act_restart(explorer_model *model, explorer_view *view, explorer_input *input);
bool act_wait(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);

// changing the run (change_actions.c)
bool act_set(explorer_model *model, explorer_view *view, explorer_input *input,
             const char *argument);
bool act_edit(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_nudge(explorer_model *model, const explorer_view *view, explorer_input *input,
               const char *argument);
bool act_push(explorer_model *model, explorer_input *input, const char *argument);
bool act_model(explorer_model *model, explorer_input *input);
bool act_extend(explorer_model *model, explorer_input *input, const char *argument);
bool act_change(explorer_model *model, explorer_view *view, explorer_input *input,
                const char *argument);
bool act_drop(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_undo(explorer_model *model, explorer_view *view, explorer_input *input);
bool act_redo(explorer_model *model, explorer_view *view, explorer_input *input);

// the control law (law_actions.c)
bool act_law(explorer_model *model, explorer_input *input, const char *argument);
bool act_lock(explorer_model *model, explorer_input *input, const char *argument);

// several runs (run_actions.c)
bool act_branch(explorer_model *model, explorer_input *input);
bool act_pin(explorer_model *model, explorer_input *input, const char *argument);
bool act_take(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_hide(explorer_model *model, explorer_input *input, const char *argument);
bool act_baseline(explorer_model *model, explorer_input *input, const char *argument);
bool act_rename(explorer_model *model, explorer_input *input, const char *argument);
bool act_unpin(explorer_model *model, explorer_input *input, const char *argument);
bool act_forget(explorer_model *model, explorer_input *input);
bool act_difference(explorer_model *model, const explorer_view *view,
                    explorer_input *input, const char *argument);
bool act_sweep(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument);
bool act_quantity(const explorer_model *model, explorer_input *input,
                  const char *argument);
bool act_metric(explorer_model *model, explorer_input *input, const char *argument);

// measured data (measured_actions.c)
bool act_data(explorer_model *model, explorer_input *input, const char *argument);
// Takes measured data that were being read, once they are there; waits at most `patience`
// [s] for them.
bool act_take_data(explorer_model *model, explorer_input *input, double patience);
// Waits for the thread of a reading and frees it; NULL is allowed.
void data_reading_finish(data_reading *r);
bool act_reload(explorer_model *model, explorer_input *input);

// searches through many runs (search_actions.c)
bool act_solve(explorer_model *model, explorer_input *input, const char *argument);
bool act_identify(explorer_model *model, explorer_input *input, const char *argument);
// Takes the results of the search, once they are there; waits at most `patience` [s].
bool act_take_search(explorer_model *model, explorer_input *input, double patience);
// The same without waiting. True if there is something new to show.
bool act_follow_search(explorer_model *model, explorer_input *input);
// Lets the search there is end soon.
bool act_end_search(explorer_model *model, explorer_input *input);
// How far a search is.
enum { PROGRESS_TEXT = 64 };
void act_write_progress(const run_search *r, char text[PROGRESS_TEXT]);
// Ends a search, waits for its thread and frees it; NULL is allowed.
void run_search_finish(run_search *r);

// axes (axis_actions.c)
bool act_zoom(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_pan(const explorer_model *model, explorer_view *view, explorer_input *input,
             const char *argument);
bool act_follow(explorer_view *view, explorer_input *input);
bool act_axis(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);

// panes of curves (pane_actions.c)
bool act_focus(explorer_view *view, explorer_input *input);
bool act_alone(explorer_view *view);
// Shows a pane of the user's of a kind, of the signals of an argument.
bool act_show_pane(explorer_model *model, explorer_view *view, explorer_input *input,
                   const char *argument, pane_view kind);
bool act_trace(explorer_model *model, explorer_view *view, explorer_input *input,
               const char *argument);
bool act_signal(explorer_view *view, explorer_input *input, const char *argument);
bool act_limit(explorer_model *model, explorer_input *input, const char *argument);
bool act_panes(explorer_view *view, explorer_input *input, const char *argument);

// looking (view_actions.c)
bool act_select(explorer_model *model, explorer_view *view, const char *argument);
bool act_changes(const explorer_model *model, explorer_view *view);
// Opens a page at its beginning, with a filter ("": none), or closes it.
bool act_page(explorer_view *view, panel_id page, const char *filter);
// Makes a choice of how the lab looks, of a command and a word of look_choices.
bool act_look(explorer_view *view, explorer_input *input, const char *command,
              const char *argument);
bool act_mark(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_note(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_notes(explorer_view *view);
bool act_side(const explorer_model *model, explorer_view *view);
bool act_filter(const explorer_model *model, explorer_view *view, const char *argument);
bool act_statistics(explorer_view *view);
bool act_palette(explorer_view *view, explorer_input *input, const char *argument);
bool act_rate(explorer_view *view, explorer_input *input, const char *argument);
bool act_bending(explorer_view *view, explorer_input *input, const char *argument);
bool act_redraw(explorer_view *view);
bool act_quit_now(explorer_input *input);

// scenarios and lessons (scenario_actions.c)
bool act_stop(explorer_model *model, explorer_input *input);
bool act_open(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_allow(explorer_model *model, explorer_view *view, explorer_input *input);
bool act_lesson(explorer_model *model, explorer_view *view, explorer_input *input,
                const char *argument);
bool act_answer(explorer_model *model, explorer_input *input, const char *argument);
bool act_continue(explorer_model *model, explorer_input *input);

// files, keys and settings (in the folder above)
bool act_save(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_save_now(explorer_model *model, explorer_view *view, explorer_input *input,
                  const char *argument);
bool act_editor(const explorer_model *model, explorer_input *input);
bool act_copy(explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument);
bool act_session(explorer_model *model, explorer_view *view, explorer_input *input,
                 const char *argument);
bool act_interrupt(explorer_model *model, const explorer_view *view,
                   explorer_input *input);
bool act_quit(const explorer_model *model, const explorer_view *view,
              explorer_input *input);
bool act_key(explorer_view *view, explorer_input *input, const char *argument);
bool act_unkey(explorer_view *view, explorer_input *input, const char *argument);
bool act_remember(explorer_view *view, explorer_input *input);

// --- what is said ----------------------------------------------------------------------

// Puts a sentence on the message line and returns `done`.
bool act_say(explorer_input *input, bool warning, bool done, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
// Done: with a message, with a warning, without any (the message line is cleared).
#define act_tell(input, ...) act_say(input, false, true, __VA_ARGS__)
#define act_warn(input, ...) act_say(input, true, true, __VA_ARGS__)
bool act_clear_message(explorer_input *input);
// Not done: the argument is not what the action expects.
#define act_refuse(input, ...) act_say(input, true, false, __VA_ARGS__)
// Whether a call that returned `code` worked; if not, the state's fault is the message.
bool act_succeeded(explorer_input *input, status code);
// --- what is read ----------------------------------------------------------------------

// Reads a finite number.
bool act_read_number(explorer_input *input, const char *text, double *value);

// Reads a number that may be followed by its unit or another of the same quantity, and
// gives it in that unit.
bool act_read_quantity(explorer_input *input, const char *text, const char *unit,
                       double *value);

// A value of a parameter with another unit of its quantity ("5 deg") as one in its own.
// Returns text, or the value as it is.
const char *act_convert(int parameter, const char *value, char text[NUMBER_TEXT]);

// The same as act_read_number for an argument that may be a word instead, such as "" or
// "off": then the value stays.
bool act_read_number_or(explorer_input *input, const char *text, const char *word,
                        double *value);

// Reads the number of one of `count` things (`what`, in the plural; `lister` shows them),
// from 1, and the blanks behind it off *text. Returns its index, -1 if it is refused.
int act_read_index(explorer_input *input, const char **text, int count, const char *what,
                   const char *lister);

// Cuts an argument into words at its blanks; returns how many there are, of which the
// first four are in words[], in `text`.
int act_split(const char *argument, char text[LINE_TEXT], char *words[4]);

// Reads the pane of a word, a number from 1 or "all": *index -1.
bool act_read_pane(const explorer_view *view, explorer_input *input, const char *word,
                   int *index);

// --- the run ---------------------------------------------------------------------------

// Waits until a thread has set *done, at most `patience` [s]; whether it has.
bool act_wait_for(int *done, double patience);

// Replaces the session by one of another scenario and plays it; if that fails the old one
// stays.
bool act_open_scenario(explorer_model *model, explorer_view *view, explorer_input *input,
                       const char *name);

// Warns if the present run failed, or asks whether its program may run. True if there was
// something to say.
bool act_tell_failed_run(const explorer_model *model, explorer_input *input);

// Refused while the run is being computed, for actions that need the complete run.
bool act_need_whole_run(const explorer_model *model, explorer_input *input);

// Refused where so many runs take too long to be computed while the lab waits.
bool act_need_short_runs(const explorer_model *model, explorer_input *input,
                         const char *command, int runs);

// PATH or PATH=VALUES with the whole path of a parameter that is named by its last part.
// Returns text.
const char *act_full_path(const char *word, char *text, size_t size);

// Compares the present run with the baseline of the pinned ones, else with the run as
// opened, from now on.
bool act_apply_baseline(explorer_model *model, explorer_input *input);

// --- time ------------------------------------------------------------------------------

// Advances by wall-clock time [s]: moves the cursor during playback.
bool act_advance(explorer_model *model, explorer_view *view, explorer_input *input,
                 double seconds);

// Stops playing and moves the cursor to an instant [s].
void act_scrub(explorer_model *model, explorer_view *view, double time);

// Makes the visible part of the run longer (factor above 1) or shorter about an instant,
// or shifts it [s].
void act_zoom_at(const explorer_model *model, explorer_view *view, double factor,
                 double time);
void act_pan_by(const explorer_model *model, explorer_view *view, double seconds);

// Says what the last input changed: that the run stops with it, that it has no effect, or
// the value.
bool act_tell_change(const explorer_model *model, explorer_input *input);

// Gives a parameter another value, from the cursor on or from the start: one that was
// typed, or a number (of a choice the index).
bool act_change_parameter(explorer_model *model, explorer_input *input, int parameter,
                          const char *text);
bool act_change_number(explorer_model *model, explorer_input *input, int parameter,
                       double value);

// Says what happens at the cursor: an event of the run, else the controller's change of
// mode.
bool act_tell_event(explorer_model *model, explorer_input *input);

// --- pulling the tip -------------------------------------------------------------------

// Grasps the tip with the pointer at a place [m], moves the pointer, and releases the
// tip.
bool act_pull_tip(explorer_model *model, explorer_view *view, explorer_input *input,
                  plane_vector place);
void act_move_pull(const explorer_model *model, explorer_view *view, plane_vector place);
bool act_release_tip(const explorer_model *model, explorer_view *view,
                     explorer_input *input);

// --- pinned runs, changes --------------------------------------------------------------
// What the commands of a name that takes a number do, with an index.

// Goes on with a pinned run; the present one is pinned.
bool act_take_run(explorer_model *model, explorer_view *view, explorer_input *input,
                  int index);
// Hides a pinned run, or shows it.
void act_hide_run(explorer_model *model, int index);
// Makes a pinned run the baseline.
bool act_compare_with(explorer_model *model, explorer_input *input, int index);
// Opens the prompt for another name of a pinned run.
void act_ask_run_name(const explorer_model *model, explorer_input *input, int index);
bool act_drop_run(explorer_model *model, explorer_input *input, int index);

// Opens the prompt for another value of a change; refused where there are no changes.
bool act_edit_change(explorer_model *model, explorer_view *view, explorer_input *input,
                     int index);
bool act_drop_change(explorer_model *model, explorer_view *view, explorer_input *input,
                     int index);

// --- notes -----------------------------------------------------------------------------

// Takes a note out.
void act_drop_note(explorer_model *model, explorer_view *view, int index);

// --- lists of the side panel -----------------------------------------------------------

// Selects the line above (-1) or below (1) in the list of the side panel, or scrolls it.
void act_select_line(explorer_model *model, explorer_view *view, int direction);

// --- filters ---------------------------------------------------------------------------

// After a change of a panel's filter: scrolls to the top and selects an entry that passes
// the filter.
void act_select_filtered(const explorer_model *model, explorer_view *view,
                         panel_id panel);

// --- sweeps ----------------------------------------------------------------------------

// Computes the next run of a sweep that is not complete.
bool act_continue_sweep(explorer_model *model, explorer_input *input);

// Moves the selection among a sweep's runs.
void act_select_swept(explorer_model *model, int direction);

// --- lessons ---------------------------------------------------------------------------

// Records that the present step of the lesson is done, if it is.
void act_follow_lesson(explorer_model *model);

// --- the palette -----------------------------------------------------------------------

// Opens the palette with words to search for, on all there is or on what can be opened.
void act_open_palette(explorer_view *view, explorer_input *input, palette_scope scope,
                      const char *words);

// Moves the selection up (negative) or down by some lines within the list. Without words
// to search for it may also move above the first entry.
void act_move_in_palette(const explorer_model *model, explorer_view *view,
                         const explorer_input *input, int lines);

// --- axes of values --------------------------------------------------------------------

// Scales a pane's axis about a point, given as a share of its height from the top, or
// shifts it up by a share of its height. The axis is fixed afterwards.
void act_scale_axis(const explorer_model *model, explorer_view *view, int index,
                    double factor, double share);
void act_shift_axis(const explorer_model *model, explorer_view *view, int index,
                    double share);

// Hides the k-th signal of a pane, or shows it.
bool act_toggle_signal(explorer_view *view, explorer_input *input, int index, int k);

// --- sliders ---------------------------------------------------------------------------

// Starts dragging a parameter's slider or moves it to a share of its scale, 0 to 1; only
// stores its position. It is some cells wide.
void act_drag_slider(const explorer_model *model, explorer_view *view, int parameter,
                     double share, int cells);
// Sets the parameter to the value of the slider; called once for each picture, however
// often the mouse has moved.
bool act_apply_slider(explorer_model *model, const explorer_view *view,
                      explorer_input *input);
// Ends dragging, with the last value set.
bool act_release_slider(explorer_model *model, explorer_view *view,
                        explorer_input *input);
