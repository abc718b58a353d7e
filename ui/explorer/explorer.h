// The explorer, the interactive part of the program, without its terminal: it takes keys,
// the mouse and command lines, and draws on a grid of cells.
//
// Its layers, each depending only on those before it: state/ (what is shown and how),
// actions/ (the actions of commands, which return results), panels/ (parts of the screen,
// which read the state and write a layout), and in this folder keys, mouse, the table of
// commands and the settings.
#pragma once

#include <pthread.h>
#include <stdatomic.h>

#include "ui/explorer/panels/panel.h"
#include "ui/terminal/keys.h"

// The part of the screen that the mouse holds since its button was pressed.
typedef struct pointer_grip {
    bool holding; // the button is down
    bool dragged; // the mouse has moved since
    hit_area hit; // what it was pressed on
    int x, y;     // the cell it was at last
} pointer_grip;

// The file that outlives a lab's end unless its user ends it, and the one that is
// offered.
typedef struct recovery {
    char path[1024], left[1024]; // this lab's, and one that another lab left, "" for none
    int lock, left_lock;         // descriptors that hold their locks, -1 for none
    bool changed;                // something may be that was not written
    double due;                  // when it may be written next [s]
    bool failure_shown;          // that it cannot be
    pthread_t writer;            // the thread that writes `text`, if it does
    bool writes;
    atomic_bool done;
    char *text;
    status code; // what became of it
    fault fault;
} recovery;

typedef struct explorer {
    explorer_model model;
    explorer_view view;
    explorer_input input;
    layout layout; // of the picture drawn last
    pointer_grip grip;
    recovery recovery;
    char first_failure[MESSAGE_TEXT]; // message of the first line that failed, "" if none
                                      // has
} explorer;

// Opens the explorer on a scenario, taken over also on failure. Waits for runs not longer
// than `patience` [s] (HUGE_VAL: for their end); explorer_follow then brings the rest.
status explorer_init(explorer *ex, scenario *s, double patience, fault *f);
void explorer_finish(explorer *ex);

// Takes the lines that were entered in earlier visits, and keeps those of this one, too.
void explorer_keep_lines(explorer *ex);

// Takes in the rows computed since the last call. True if there is something new to draw.
bool explorer_follow(explorer *ex);

// Whether anything changes with time: playback, or a run being computed.
bool explorer_is_busy(const explorer *ex);

// Draws everything; the layout depends on the screen's size.
void explorer_draw(explorer *ex, screen *s);

// --- lines -----------------------------------------------------------------------------

// Executes a line; an empty one or a comment does nothing. The result's `at` counts from
// the beginning of the line.
bool explorer_execute(explorer_model *model, explorer_view *view, explorer_input *input,
                      const char *line);

// The same, with the result's message shown on the message line. False if it failed.
bool explorer_carry_out(explorer *ex, const char *line);

// --- keys ------------------------------------------------------------------------------

// A key was pressed.
void explorer_key(explorer *ex, int key);

// A character was pasted: typed where text is typed, a line's end as a blank, and nothing
// elsewhere, so that what was copied never acts as keys.
void explorer_paste(explorer *ex, int character);

// Presses the keys of a text: characters, and names in angle brackets ("<Space>",
// "<Right>", "<C-l>"). False, with the reason in f, at an unknown name.
bool explorer_keys(explorer *ex, const char *text, fault *f);

// --- the mouse -------------------------------------------------------------------------

// Handles an event of the mouse.
void explorer_point(explorer *ex, pointer_event e);

// --- figures ---------------------------------------------------------------------------
// What the lab shows as recipes of figures (docs/reference/recipes.md), from which its
// pictures are drawn, too: the panes over time, then each pane over another axis, and the
// sweep that stands at the side.

// How many there are.
int shown_figure_count(const explorer_model *model, const explorer_view *view);

// Writes the recipe of one of them for a picture in `folder`, `width` wide [mm; 0: the
// usual one]. Errors of writing stay in the stream; STATUS_BAD_ARGUMENT or
// STATUS_NO_MEMORY.
status shown_figure_write(const explorer_model *model, const explorer_view *view,
                          int index, const char *folder, double width, FILE *stream,
                          fault *f);

// --- completion ------------------------------------------------------------------------

// Completes the prompt's last word as far as all candidates agree and lists them if there
// are several; called again it cycles through them.
bool complete_prompt(explorer_model *model, const explorer_view *view,
                     explorer_input *input);

// --- sessions --------------------------------------------------------------------------

// Opens a session's file: its runs are pinned beside those there are. False, with the
// message why, and nothing changed, if it cannot be.
bool explorer_open_session(explorer_model *model, explorer_view *view,
                           explorer_input *input, const char *path);

// The same with the function that carries out the lines on how the runs are looked at:
// the table of commands, which knows the session's command, is above this.
typedef bool line_function(explorer_model *model, explorer_view *view,
                           explorer_input *input, const char *line);
bool explorer_resume_session(explorer_model *model, explorer_view *view,
                             explorer_input *input, const char *path,
                             line_function *look);

// Saves what there is as a session. False, with the message why, if the file is there
// already and not this visit's own, the run is incomplete, or it cannot be written.
bool explorer_save_session(explorer_model *model, const explorer_view *view,
                           explorer_input *input, const char *path);

// Writes a session of what there is. Errors of writing stay in the stream;
// STATUS_NO_MEMORY, or STATUS_CANNOT_WRITE for a pane that no line can say.
status explorer_write_session(const explorer_model *model, const explorer_view *view,
                              FILE *stream, fault *f);

// The panes of the table that are shown, as their numbers.
void explorer_shown_panes(const explorer_view *view, char text[PANES + 1]);

// What stands on the screen counts as saved from now on: notes, the mark, limits, panes,
// measured data, a sweep.
void explorer_remember_looks(explorer_model *model, const explorer_view *view);
// Whether there is anything that a recovery file would bring back.
bool explorer_has_work(const explorer_model *model, const explorer_view *view);

// --- recovery --------------------------------------------------------------------------

// Finds a place for the recovery file, and offers the newest that a lab left, which no
// other lab offers meanwhile. True if there is one.
bool recovery_begin(explorer *ex);
// Takes the answer to that: true if the key was one. Any other ends the offer.
bool recovery_answer(explorer *ex, int key);

// Writes the file if something may have changed, on a thread of its own and not more than
// once a second. Returns after how many seconds at most to call again. That it cannot be
// written is said once.
double recovery_keep(explorer *ex, bool changed, double now);

// Removes the file if the user ended the lab; else what was changed last is written.
void recovery_end(explorer *ex, bool orderly);

// --- settings --------------------------------------------------------------------------

// Says what to press on a first visit, unless there was one: then a file in the folder of
// settings says so. Without such a folder nothing is shown.
void explorer_welcome(explorer *ex);

// Executes the commands of the settings file, if there is one. Faulty lines are reported
// on the message line and ignored.
void explorer_load_settings(explorer_model *model, explorer_view *view,
                            explorer_input *input);
