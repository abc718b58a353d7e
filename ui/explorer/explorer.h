// The explorer, the program's front on a terminal, without its terminal: it takes keys, the mouse
// and lines of commands, and draws on a grid of cells.
//
// Its layers, each knowing only those before it: state/ (what is looked at and how), actions/ (what
// commands do; they return results), panels/ (parts of the screen; they read the state and write a
// layout), and here keys, mouse, the table of commands and the settings.
#pragma once

#include "ui/explorer/panels/layout.h"
#include "ui/explorer/panels/panel.h"
#include "ui/terminal/pointer.h"

// What the mouse holds since its button went down.
typedef struct pointer_grip {
    bool holding; // the button is down
    bool dragged; // the mouse was moved meanwhile
    hit_area hit; // what it was pressed on
    int x, y;     // the cell it was at last
} pointer_grip;

typedef struct explorer {
    explorer_state state;
    layout layout; // of the picture drawn last
    pointer_grip grip;
    char first_failure[MESSAGE_TEXT]; // why the first line that failed did, "" if none has
} explorer;

// Opens the explorer on a scenario, taken over also on failure. Waits for runs not longer than
// `patience` [s] (HUGE_VAL: for their end); explorer_follow then brings the rest.
status explorer_init(explorer *ex, scenario *s, double patience, fault *f);
void explorer_finish(explorer *ex);

// Takes note of what has been computed since the last call. True if there is something to draw.
bool explorer_follow(explorer *ex);

// Adds to the message line that a program had to go through its past once more, if one had.
void explorer_tell_replay(explorer *ex);

// Lets wall-clock time pass [s]: moves the cursor if the explorer plays.
void explorer_advance(explorer *ex, double seconds);

// Whether time moves anything: it plays, or a run is being computed.
bool explorer_is_busy(const explorer *ex);

// Draws everything. The screen's size decides the layout.
void explorer_draw(explorer *ex, screen *s);
