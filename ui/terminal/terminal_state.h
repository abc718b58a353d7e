// The program's only terminal, shared by the files that implement terminal.h: they open it, read
// from it, draw on it and catch the signals that end the program.
#pragma once

#include <signal.h>
#include <termios.h>

#define NCURSES_WIDECHAR 1
#include <curses.h>

#include "ui/terminal/pixel_answers.h"
#include "ui/terminal/screen.h"

typedef struct terminal_state {
    SCREEN *curses;
    struct termios saved; // former settings
    int wake[2];          // pipe to which signal handlers write
    screen shown;         // contents of the terminal
    colour_theme theme;   // theme of the colours that are set
    colour_depth depth;
    bool bright[INK_COUNT]; // inks drawn in bold because there are no bright colours
    bool colours, themed, mouse, has_mouse;
    bool painted;             // the contents were not drawn by ncurses
    escape_sequence sequence; // sequence begun on the input
    double sequence_time;     // of its last character [s]
    pixel_answers pixels;     // answers about pictures
    char restore[256];        // sequence sent by a crash
    size_t restore_length;
} terminal_state;

extern terminal_state tty;

extern volatile sig_atomic_t terminal_leaving;    // the signal that asks to leave
extern volatile sig_atomic_t terminal_suspending; // ^Z was pressed

// Installs and removes the handlers of signals that ask to leave, stop the program or end it.
void terminal_take_signals(void);
void terminal_give_signals_back(void);

// Appends to the sequence by which a crash restores the terminal, without padding marks; NULL and
// ncurses' value for a missing capability are ignored.
void terminal_prepare_crash(const char *text);

// Reads an answer of the terminal; true if the screen should be redrawn.
bool terminal_take_answer(void);

// Queries the size of a cell again, for instance after a change of size, if it was known.
void terminal_ask_cell(void);

// Shows the pictures of a screen whose cells are shown: those that have changed, or all.
void terminal_show_pictures(const screen *s, bool whole);
// Removes all pictures from the terminal.
void terminal_remove_pictures(void);
