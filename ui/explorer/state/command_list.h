// The commands of the explorer: one list for `:`, scripts, keys, the help and completion. And the
// keys bound to them: the explorer's own table, and the user's keys, which take precedence.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum { LINE_TEXT = 256 }; // bytes of a command, a filter or a name

// group that begins with this command, or ""; name; argument as shown in the help; description;
// function that executes it
#define COMMAND_LIST(X)                                                                            \
    X("Time", "play", "", "run or pause", act_play)                                                \
    X("", "step", "[N]", "one row of the run on, or N (back if negative)", act_step)               \
    X("", "event", "[-1]", "to the next event, or the one before", act_step_event)                 \
    X("", "touch", "[-1]", "just before the arm touches next, or did last", act_step_touch)        \
    X("", "seek", "TIME|end", "to an instant [s]", act_seek)                                       \
    X("", "speed", "up|down|X", "simulated seconds a second, 1 is real time", act_set_speed)       \
    X("", "slow", "FACTOR|off", "playing is that many times slower round impacts", act_set_slow)   \
    X("", "restart", "", "play from the start", act_restart)                                       \
    X("Changing the run", "set", "PATH VALUE", "another value, from now on or from the start",     \
      act_set)                                                                                     \
    X("", "edit", "[PATH]", "type a new value, of the selected parameter or another", act_edit)    \
    X("", "nudge", "[-1]", "selected parameter a little up or down", act_nudge)                    \
    X("", "select", "[-1]", "next or previous parameter", act_select_parameter)                    \
    X("", "fold", "[GROUP|all|none]", "fold a group of parameters, or show it", act_fold)          \
    X("", "push", "[N s]", "an impulse at the tip, 0.01 N s", act_push)                            \
    X("", "law", "[NAME|off]", "another control law; alone: off or on again", act_law)             \
    X("", "lock", "MODE|next|off", "hold the law in a mode, or let it choose", act_lock)           \
    X("", "model", "", "corrected or printed equations", act_exchange_model)                       \
    X("", "extend", "[S]", "a longer run", act_extend)                                             \
    X("", "changes", "", "all changes: edit them, take single ones out", act_show_changes)         \
    X("", "change", "N VALUE", "another value for the N-th change", act_edit_change)               \
    X("", "drop", "N", "take the N-th change out", act_drop_change)                                \
    X("Several runs, undo", "branch", "", "pin this run and make another beside it", act_branch)   \
    X("", "pin", "[NAME]", "the same under a name; up to seven runs are kept", act_pin)            \
    X("", "runs", "", "the pinned runs: open, hide, rename, drop, compare", act_show_runs)         \
    X("", "take", "N", "go on with the N-th pinned run; this one is pinned", act_take_run)         \
    X("", "hide", "N", "hide the N-th pinned run, or show it", act_hide_run)                       \
    X("", "baseline", "N", "compare with the N-th pinned run", act_set_baseline)                   \
    X("", "rename", "N NAME", "another name for it", act_rename_run)                               \
    X("", "unpin", "N", "drop the N-th pinned run", act_unpin)                                     \
    X("", "forget", "", "drop the run that is compared with", act_forget)                          \
    X("", "difference", "[TOLERANCE|off]", "this run minus the baseline, in all panes",            \
      act_show_difference)                                                                         \
    X("", "sweep", "[PATH=A:B:N [PATH=...]|off]",                                                  \
      "runs with other values: curves and a metric, of two parameters a map", act_sweep)           \
    X("", "solve", "PATH[=A:B] QUANTITY<VALUE", "limit of a value for a condition: it is pinned",  \
      act_solve)                                                                                   \
    X("", "metric", "[QUANTITY]", "what the sweep compares by; alone: the next one",               \
      act_set_metric)                                                                              \
    X("", "stop", "", "compute no further; Space at its end goes on", act_stop)                    \
    X("", "compare", "", "both runs in numbers", act_compare)                                      \
    X("", "explain", "", "what is selected, in focus and at the cursor", act_explain)              \
    X("", "why", "", "the run's course, from its events and energies", act_show_why)               \
    X("", "poles", "", "natural frequencies and damping near rest, free and on the wall",          \
      act_show_poles)                                                                              \
    X("", "data", "FILE.csv[@SHIFT]|off", "measured columns, aligned at the first contact",        \
      act_lay_data)                                                                                \
    X("", "identify", "PATH...", "fit parameters to the measured data: that run is pinned",        \
      act_identify)                                                                                \
    X("", "undo", "", "take the last change back", act_undo)                                       \
    X("", "redo", "", "put it in again", act_redo)                                                 \
    X("Looking", "mark", "[TIME]", "second cursor: differences to it", act_set_mark)               \
    X("", "note", "[TEXT]", "a note at the cursor, without a text none; @TIME TEXT elsewhere",     \
      act_note)                                                                                    \
    X("", "notes", "", "all notes: Enter goes there", act_show_notes)                              \
    X("", "side", "", "parameters or values on the right", act_other_side)                         \
    X("", "filter", "[WORDS]", "of parameters, values or help: those with all words", act_filter)  \
    X("", "info", "", "what the scenario is about", act_show_info)                                 \
    X("Curves and their axes", "zoom", "in|out|all|FROM TO", "time axis round the cursor",         \
      act_zoom)                                                                                    \
    X("", "pan", "left|right|SECONDS", "time axis along the run", act_pan)                         \
    X("", "follow", "", "curves follow the cursor (panning ends it)", act_follow)                  \
    X("", "focus", "", "next pane, for the keys of axes", act_focus)                               \
    X("", "alone", "", "that pane as large as all, or all again", act_alone)                       \
    X("", "axis", "auto|grow|calm|LOW HIGH [PANE]", "range: visible, seen, without spikes, yours", \
      act_axis)                                                                                    \
    X("", "trace", "1-9|SIGNAL...|EXPRESSION",                                                     \
      "show or hide a pane of curves: trace force - force_reading", act_trace_pane)                \
    X("", "signal", "[SIGNAL|all] [PANE]",                                                         \
      "hide a signal of the pane in focus, or show it; alone: the next", act_hide_signal)          \
    X("", "limit", "SIGNAL VALUE|off", "a bound drawn across the panes of a signal",               \
      act_set_limit)                                                                               \
    X("", "band", "SIGNAL TOLERANCE|off", "a band round the baseline's curve, and who leaves it",  \
      act_set_band)                                                                                \
    X("", "phase", "SIGNAL SIGNAL", "a pane of one signal over another: phase gap force",          \
      act_phase_pane)                                                                              \
    X("", "residual", "SIGNAL...", "a pane of :data minus the run", act_residual_pane)             \
    X("", "spectrum", "SIGNAL", "a pane of its amplitudes in the visible part", act_spectrum_pane) \
    X("", "statistics", "", "min, max, mean, rms, integral from mark to cursor", act_statistics)   \
    X("", "lanes", "auto|all|off", "contact, modes, changes... below the curves; alone: next",     \
      act_set_lanes)                                                                               \
    X("Scenarios", "open", "[NAME|+1|-1]", "another scenario, from a list", act_open_scenario_by)  \
    X("", "find", "[TEXT]", "the list, filtered by what is typed", act_find_scenario)              \
    X("", "allow", "", "let the scenario run its program or plug-in", act_allow)                   \
    X("Lessons", "lesson", "[NAME|off]", "experiments step by step; alone: a list of them",        \
      act_open_lesson)                                                                             \
    X("", "answer", "[ANSWER]", "a step's question: a number, or that of a choice", act_answer)    \
    X("", "continue", "", "the next step; before it is done: a hint", act_go_on)                   \
    X("Files", "save", "FILE", ".png .pdf .svg .csv .yaml .txt", act_save)                         \
    X("", "save!", "FILE", "the same over a file that is there", act_save_over)                    \
    X("", "session", "save|open FILE", "runs, changes, pins and panes, to go on with another day", \
      act_session)                                                                                 \
    X("", "copy", "value|run|screen", "to the terminal's clipboard: value, command line, screen",  \
      act_copy)                                                                                    \
    X("", "scene", "FILE.png", "picture of the arm at this instant", act_save_scene)               \
    X("The lab", "palette", "[WORDS]", "find anything by words: commands, values, scenarios",      \
      act_open_palette)                                                                            \
    X("", "glyphs", "braille|blocks|ascii", "characters to draw with", act_set_glyphs)             \
    X("", "theme", "dark|light|mono", "colours for that ground", act_set_theme)                    \
    X("", "colours", "auto|true|256|16|mono", "how many the terminal has", act_set_colours)        \
    X("", "colourby", "signal|run", "what has a colour of its own; alone: the other",              \
      act_colour_by)                                                                               \
    X("", "pixels", "auto|off", "pictures where the terminal has them", act_set_pixels)            \
    X("", "rate", "KB|off", "most that pictures may take, in kB a second: 200 over ssh",           \
      act_set_rate)                                                                                \
    X("", "closeup", "auto|on|off", "the contact from near by; alone: next", act_set_close_up)     \
    X("", "bending", "[FACTOR]", "drawn that many times as large; alone: as it is",                \
      act_set_bending)                                                                             \
    X("", "mouse", "on|off", "off lets the terminal select text", act_set_mouse)                   \
    X("", "panes", "134", "these panes of curves and no others", act_show_panes)                   \
    X("", "key", "KEY COMMAND", "a key of your own, such as :key x step 5", act_bind_key)          \
    X("", "unkey", "KEY", "take it back; one of the lab's does nothing then", act_unbind_key)      \
    X("", "remember", "", "keep looks, speed, panes, axes and keys", act_remember)                 \
    X("", "redraw", "", "draw the whole screen anew", act_redraw)                                  \
    X("", "wait", "SECONDS", "in a script: let time pass", act_wait_for)                           \
    X("", "help", "", "this page", act_show_help)                                                  \
    X("", "interrupt", "", "stop what is being computed, else leave", act_interrupt)               \
    X("", "quit", "", "leave the lab; asks if changes would be lost", act_quit)                    \
    X("", "quit!", "", "leave the lab, whatever is lost", act_quit_now)

// Description of a command.
typedef struct explorer_command {
    const char *group; // that begins with it, "" if it belongs to the previous group
    const char *name;
    const char *argument; // as shown in the help, "" for none
    const char *help;
} explorer_command;

extern const explorer_command explorer_command_table[];
extern const int explorer_command_count;

// The index of a name or of an unambiguous beginning of one, -1 if there is none.
int explorer_command_find(const char *name);

// The name most similar to a misspelt one, NULL if none is similar.
const char *explorer_command_suggest(const char *name);

// --- keys -------------------------------------------------------------------------------------

enum { USER_KEYS = 64, KEY_NAME = 16 };

// A key bound by the user.
typedef struct user_key {
    int key;
    char line[LINE_TEXT]; // the line it executes, "" for none
} user_key;

typedef struct key_bindings {
    user_key own[USER_KEYS];
    int count;
} key_bindings;

// The key of a name of `length` bytes ("Space", "C-r", "x"), 0 if there is none.
int key_of_name(const char *name, size_t length);
// The name of a key.
void key_name(int key, char *text, size_t size);

// The line that a key executes, NULL for none.
const char *key_line(const key_bindings *b, int key);
// The line that the explorer's own table gives it, NULL for none.
const char *key_built_in_line(int key);

// The user's binding of a key, NULL if there is none.
user_key *key_find_own(key_bindings *b, int key);
// Finds or adds the user's binding of a key; NULL if there is no room for another.
user_key *key_add_own(key_bindings *b, int key);
// Removes the user's binding of a key, so that the explorer's own applies again.
void key_remove_own(key_bindings *b, user_key *own);

// The names of the keys that execute a command, separated by blanks.
void key_names_of(const key_bindings *b, const char *command, char *text, size_t size);
