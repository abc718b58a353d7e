// The program's only terminal, shared by the files that implement terminal.h: they open
// it, read from it, draw on it and catch the signals that end the program.
#pragma once

#include <signal.h>
#include <termios.h>

#define NCURSES_WIDECHAR 1
#include <curses.h>

#include "ui/terminal/pixels.h"
#include "ui/terminal/screen.h"

typedef struct terminal_state {
    SCREEN *curses;
    struct termios saved; // former settings
    int wake[2];          // pipe to which signal handlers write
    screen shown;         // contents of the terminal
    colour_theme theme;   // theme of the colours that are set
    colour_depth depth;
    bool colours, mouse, has_mouse;
    escape_sequence sequence; // sequence begun on the input
    double sequence_time;     // of its last character [s]
    bool pasting;             // what comes is pasted text
    pixel_answers pixels;     // answers about pictures
    char restore[256];        // sequence sent by a crash
    size_t restore_length;
} terminal_state;

extern terminal_state tty;

extern volatile sig_atomic_t terminal_leaving;    // the signal that asks to leave
extern volatile sig_atomic_t terminal_suspending; // ^Z was pressed

// Appends to the sequence by which a crash restores the terminal, without padding marks;
// NULL and ncurses' value for a missing capability are ignored.
void terminal_prepare_crash(const char *text);

// Sends all bytes to the terminal, however slowly it accepts them.
void terminal_send(const char *bytes, size_t count);

// Asks the terminal to mark what is pasted (bracketed paste), or no longer to.
void terminal_bracket_pastes(bool on);

// Removes all pictures from the terminal.
void terminal_remove_pictures(void);
