// The commands of the explorer: one list for `:`, scripts, keys, the help and completion.
// And the keys bound to them: the explorer's own table, and the user's keys, which take
// precedence.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/words.h"

enum { LINE_TEXT = 1024 }; // bytes of a command, a filter or a name

// Cuts the first word off a text, which one of `ends` ends; returns what follows, from
// the next word on.
const char *text_cut(const char *text, const char *ends, char *word, size_t size);

// Group that begins with this command, or ""; name, with ! for a command that asks no
// questions; the call of its action, with the parts of the state that it changes or reads
// and the command's argument; its keys, each KEY or KEY:ARGUMENT (names as in --keys
// without their brackets); argument as shown in the help; description.
#define COMMAND_LIST(X)                                                                  \
    X("Time", "play", act_play(model, view, input), "Space", "", "run or pause")         \
    X("", "step", act_step(model, view, input, argument),                                \
      "Right:1 l:1 Left:-1 h:-1 PgDn:20 PgUp:-20", "[N]",                                \
      "one row of the run on, or N (back if negative)")                                  \
    X("", "event", act_event(model, view, input, argument), "n N:-1", "[-1]",            \
      "to the next event, or the one before")                                            \
    X("", "touch", act_touch(model, view, input, argument), "i I:-1", "[-1]",            \
      "just before the arm touches next, or did last")                                   \
    X("", "seek", act_seek(model, view, input, argument), "Home:0 g:0 End:end G:end",    \
      "TIME|end", "to an instant [s]")                                                   \
    X("", "speed", act_speed(view, input, argument), "+:up =:up -:down", "up|down|X",    \
      "simulated seconds a second, 1 is real time")                                      \
    X("", "slow", act_slow(view, input, argument), "", "FACTOR|off",                     \
      "playing is that many times slower round impacts")                                 \
    X("", "restart", act_restart(model, view, input), "Backspace r", "",                 \
      "play from the start")                                                             \
    X("Changing the run", "set", act_set(model, view, input, argument), "",              \
      "PATH VALUE", "another value, from now on or from the start")                      \
    X("", "edit", act_edit(model, view, input, argument), "Enter", "[PATH]",             \
      "type a new value, of the selected parameter or another")                          \
    X("", "nudge", act_nudge(model, view, input, argument), "> <:-1", "[-1]",            \
      "selected parameter a little up or down")                                          \
    X("", "select", act_select(model, view, argument), "Down j Up:-1 k:-1", "[-1]",      \
      "next or previous parameter")                                                      \
    X("", "push", act_push(model, input, argument), "p:0.01 P:-0.01", "[N s]",           \
      "an impulse at the tip, 0.01 N s")                                                 \
    X("", "law", act_law(model, input, argument), "C", "[NAME|off]",                     \
      "another control law; alone: off or on again")                                     \
    X("", "lock", act_lock(model, input, argument), "L:next F:off", "MODE|next|off",     \
      "hold the law in a mode, or let it choose")                                        \
    X("", "model", act_model(model, input), "t", "", "corrected or printed equations")   \
    X("", "extend", act_extend(model, input, argument), "x", "[S]", "a longer run")      \
    X("", "changes", act_changes(model, view), "H", "",                                  \
      "all changes: edit them, take single ones out")                                    \
    X("", "change", act_change(model, view, input, argument), "", "N VALUE",             \
      "another value for the N-th change")                                               \
    X("", "drop", act_drop(model, view, input, argument), "", "N",                       \
      "take the N-th change out")                                                        \
    X("Several runs, undo", "branch", act_branch(model, input), "b", "",                 \
      "pin this run and make another beside it")                                         \
    X("", "pin", act_pin(model, input, argument), "", "[NAME]",                          \
      "the same under a name; up to seven runs are kept")                                \
    X("", "runs", act_page(view, PANEL_RUN_LIST, ""), "R", "",                           \
      "the pinned runs: open, hide, rename, drop, compare")                              \
    X("", "take", act_take(model, view, input, argument), "", "N",                       \
      "go on with the N-th pinned run; this one is pinned")                              \
    X("", "hide", act_hide(model, input, argument), "", "N",                             \
      "hide the N-th pinned run, or show it")                                            \
    X("", "baseline", act_baseline(model, input, argument), "", "N",                     \
      "compare with the N-th pinned run")                                                \
    X("", "rename", act_rename(model, input, argument), "", "N NAME",                    \
      "another name for it")                                                             \
    X("", "unpin", act_unpin(model, input, argument), "", "N",                           \
      "drop the N-th pinned run")                                                        \
    X("", "forget", act_forget(model, input), "B", "",                                   \
      "drop the run that is compared with")                                              \
    X("", "difference", act_difference(model, view, input, argument), "D",               \
      "[TOLERANCE|off]", "this run minus the baseline, in all panes")                    \
    X("", "sweep", act_sweep(model, view, input, argument), "",                          \
      "[PATH=A:B:N [PATH=...]|off]",                                                     \
      "runs with other values: curves and a metric, of two parameters a map")            \
    X("", "solve", act_solve(model, input, argument), "", "PATH[=A:B] QUANTITY<VALUE",   \
      "limit of a value for a condition: it is pinned")                                  \
    X("", "metric", act_metric(model, input, argument), "", "QUANTITY",                  \
      "what the sweep compares by")                                                      \
    X("", "quantity", act_quantity(model, input, argument), "", "QUANTITY",              \
      "a number of this run's summary, and what it is")                                  \
    X("", "stop", act_stop(model, input), "", "",                                        \
      "compute no further; Space at its end goes on")                                    \
    X("", "compare", act_page(view, PANEL_COMPARISON, ""), "c", "",                      \
      "both runs in numbers")                                                            \
    X("", "explain", act_page(view, PANEL_EXPLAIN, ""), "F1", "",                        \
      "what is selected, in focus and at the cursor")                                    \
    X("", "why", (act_need_whole_run(model, input) && act_page(view, PANEL_WHY, "")),    \
      "W", "", "the run's course, from its events and energies")                         \
    X("", "poles", act_page(view, PANEL_POLES, ""), "", "",                              \
      "natural frequencies and damping near rest, free and on the wall")                 \
    X("", "data", act_data(model, input, argument), "", "FILE.csv[@SHIFT]|off [play]",   \
      "measured columns, aligned at the first contact; play: with their command")        \
    X("", "reload", act_reload(model, input), "", "", "read the measured data again")    \
    X("", "identify", act_identify(model, input, argument), "", "PATH...",               \
      "fit parameters to the measured data: that run is pinned")                         \
    X("", "undo", act_undo(model, view, input), "u", "", "take the last change back")    \
    X("", "redo", act_redo(model, view, input), "U C-r", "", "put it in again")          \
    X("Looking", "mark", act_mark(model, view, input, argument), "m", "[TIME]",          \
      "second cursor: differences to it")                                                \
    X("", "note", act_note(model, view, input, argument), "", "[TEXT]",                  \
      "a note at the cursor, without a text none; @TIME TEXT elsewhere")                 \
    X("", "notes", act_notes(view), "", "", "all notes: Enter goes there")               \
    X("", "side", act_side(model, view), "Tab", "",                                      \
      "all parameters, values, statistics")                                              \
    X("", "filter", act_filter(model, view, argument), "/", "[WORDS]",                   \
      "of parameters, values or help: those with all words")                             \
    X("", "info", act_page(view, PANEL_INFO, ""), "d", "", "what the scenario is about") \
    X("Curves and their axes", "zoom", act_zoom(model, view, input, argument),           \
      "z:in Z:out 0:all", "in|out|all|FROM TO", "time axis round the cursor")            \
    X("", "pan", act_pan(model, view, input, argument),                                  \
      "(:left S-Left:left ):right S-Right:right", "left|right|SECONDS",                  \
      "time axis along the run")                                                         \
    X("", "follow", act_follow(view, input), "f", "",                                    \
      "curves follow the cursor (panning ends it)")                                      \
    X("", "focus", act_focus(view, input), "w", "", "next pane, for the keys of axes")   \
    X("", "alone", act_alone(view), "e", "", "that pane as large as all, or all again")  \
    X("", "axis", act_axis(model, view, input, argument),                                \
      "a:next v:in V:out S-Up:up S-Down:down", "auto|fixed|LOW HIGH [PANE]",             \
      "range of values: what is visible, or yours")                                      \
    X("", "trace", act_trace(model, view, input, argument),                              \
      "1:1 2:2 3:3 4:4 5:5 6:6 7:7 8:8 9:9", "1-9|SIGNAL...|EXPRESSION",                 \
      "show or hide a pane of curves: trace force - force_reading")                      \
    X("", "signal", act_signal(view, input, argument), "K", "[SIGNAL|all] [PANE]",       \
      "hide a signal of the pane in focus, or show it; alone: the next")                 \
    X("", "limit", act_limit(model, input, argument), "", "SIGNAL VALUE|off",            \
      "a bound drawn across the panes of a signal")                                      \
    X("", "phase", act_show_pane(model, view, input, argument, VIEW_PHASE), "",          \
      "SIGNAL SIGNAL", "a pane of one signal over another: phase gap force")             \
    X("", "residual", act_show_pane(model, view, input, argument, VIEW_RESIDUAL), "",    \
      "SIGNAL...", "a pane of :data minus the run")                                      \
    X("", "spectrum", act_show_pane(model, view, input, argument, VIEW_SPECTRUM), "",    \
      "SIGNAL", "a pane of its amplitudes in the visible part")                          \
    X("", "statistics", act_statistics(view), "X", "",                                   \
      "min, max, mean, rms, integral from mark to cursor")                               \
    X("Scenarios", "open", act_open(model, view, input, argument), "o ]:+1 [:-1",        \
      "[NAME|+1|-1]", "another scenario, from a list that words narrow")                 \
    X("", "allow", act_allow(model, view, input), "", "",                                \
      "let the scenario run its program or plug-in")                                     \
    X("Lessons", "lesson", act_lesson(model, view, input, argument), "", "[NAME|off]",   \
      "experiments step by step; alone: a list of them")                                 \
    X("", "answer", act_answer(model, input, argument), "A", "[ANSWER]",                 \
      "a step's question: a number, or that of a choice")                                \
    X("", "continue", act_continue(model, input), "y", "",                               \
      "the next step; before it is done: a hint")                                        \
    X("Files", "save", act_save(model, view, input, argument), "s", "FILE [MM]",         \
      "what is shown: .png .pdf .svg; .csv .yaml .txt")                                  \
    X("", "save!", act_save_now(model, view, input, argument), "", "FILE",               \
      "the same over a file that is there")                                              \
    X("", "editor", act_editor(model, input), "E", "",                                   \
      "the scenario in $EDITOR; it is opened again behind it")                           \
    X("", "session", act_session(model, view, input, argument), "", "save|open FILE",    \
      "runs, changes, pins and panes, to go on with another day")                        \
    X("", "copy", act_copy(model, view, input, argument), "", "value|run|screen",        \
      "to the terminal's clipboard: value, command line, screen")                        \
    X("The lab", "palette", act_palette(view, input, argument), "C-p", "[WORDS]",        \
      "find anything by words: commands, values, scenarios")                             \
    X("", "glyphs", act_look(view, input, "glyphs", argument), "",                       \
      "braille|blocks|ascii", "characters to draw with")                                 \
    X("", "theme", act_look(view, input, "theme", argument), "", "dark|light|mono",      \
      "colours for that ground")                                                         \
    X("", "pixels", act_look(view, input, "pixels", argument), "", "auto|off",           \
      "pictures where the terminal has them")                                            \
    X("", "rate", act_rate(view, input, argument), "", "KB|off",                         \
      "most that pictures may take, in kB a second: 200 over ssh")                       \
    X("", "bending", act_bending(view, input, argument), "", "[FACTOR]",                 \
      "drawn that many times as large; alone: as it is")                                 \
    X("", "mouse", act_look(view, input, "mouse", argument), "", "on|off",               \
      "off lets the terminal select text")                                               \
    X("", "panes", act_panes(view, input, argument), "", "134",                          \
      "these panes of curves and no others")                                             \
    X("", "key", act_key(view, input, argument), "", "KEY COMMAND",                      \
      "a key of your own, such as :key x step 5")                                        \
    X("", "unkey", act_unkey(view, input, argument), "", "KEY",                          \
      "take it back; one of the lab's does nothing then")                                \
    X("", "remember", act_remember(view, input), "", "",                                 \
      "keep looks, speed, panes, axes and keys")                                         \
    X("", "redraw", act_redraw(view), "C-l", "", "draw the whole screen anew")           \
    X("", "wait", act_wait(model, view, input, argument), "", "SECONDS",                 \
      "in a script: let time pass")                                                      \
    X("", "help", act_page(view, PANEL_HELP, argument), "?", "[WORDS]",                  \
      "this page, or what of it has all words")                                          \
    X("", "interrupt", act_interrupt(model, view, input), "C-c", "",                     \
      "stop what is being computed, else leave")                                         \
    X("", "quit", act_quit(model, view, input), "q", "",                                 \
      "leave the lab; asks if changes would be lost")                                    \
    X("", "quit!", act_quit_now(input), "", "", "leave the lab, whatever is lost")

// Description of a command.
typedef struct explorer_command {
    const char *group; // that begins with it, "" if it belongs to the previous group
    const char *name;
    const char *keys;
    const char *argument; // as shown in the help, "" for none
    const char *help;
} explorer_command;

extern const explorer_command explorer_command_table[];
extern const int explorer_command_count;

// The index of a name or of an unambiguous beginning of one, -1 if there is none.
int explorer_command_find(const char *name);

// --- keys ------------------------------------------------------------------------------

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

// The index of the user's binding of a key, -1 if there is none.
int key_own(const key_bindings *b, int key);
// Gives a key a line, "" for none; false if there is no room for another key.
bool key_bind(key_bindings *b, int key, const char *line);

// The names of the keys that execute a command, separated by blanks.
void key_names_of(const key_bindings *b, const char *command, char *text, size_t size);
