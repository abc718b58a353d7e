// The explorer, the interactive part of the program, without its terminal: it takes keys, the mouse
// and command lines, and draws on a grid of cells.
//
// Its layers, each depending only on those before it: state/ (what is shown and how), actions/ (the
// actions of commands, which return results), panels/ (parts of the screen, which read the state
// and write a layout), and in this folder keys, mouse, the table of commands and the settings.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/explorer/panels/panel.h"
#include "ui/terminal/keys.h"

// The part of the screen that the mouse holds since its button was pressed.
typedef struct pointer_grip {
    bool holding; // the button is down
    bool dragged; // the mouse has moved since
    hit_area hit; // what it was pressed on
    int x, y;     // the cell it was at last
} pointer_grip;

typedef struct explorer {
    explorer_state state;
    layout layout; // of the picture drawn last
    pointer_grip grip;
    char first_failure[MESSAGE_TEXT]; // message of the first line that failed, "" if none has
} explorer;

// Opens the explorer on a scenario, taken over also on failure. Waits for runs not longer than
// `patience` [s] (HUGE_VAL: for their end); explorer_follow then brings the rest.
status explorer_init(explorer *ex, scenario *s, double patience, fault *f);
void explorer_finish(explorer *ex);

// Takes in the rows computed since the last call. True if there is something new to draw.
bool explorer_follow(explorer *ex);

// Adds to the message line that an external program had to repeat its earlier samples, if it had
// to.
void explorer_tell_replay(explorer *ex);

// Advances by wall-clock time [s]: moves the cursor during playback.
void explorer_advance(explorer *ex, double seconds);

// Whether anything changes with time: playback, or a run being computed.
bool explorer_is_busy(const explorer *ex);

// Draws everything; the layout depends on the screen's size.
void explorer_draw(explorer *ex, screen *s);
