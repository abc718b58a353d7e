// The one terminal that the program has, for the files that make up terminal.h: who opens it, reads
// from it, shows on it and catches the signals that end it.
#pragma once

#include <signal.h>
#include <termios.h>

#define NCURSES_WIDECHAR 1
#include <curses.h>

#include "ui/terminal/pixel_answers.h"
#include "ui/terminal/screen.h"

typedef struct terminal_state {
    SCREEN *curses;
    struct termios saved; // as it was
    int wake[2];          // signals write here
    screen shown;         // what the terminal has
    colour_theme theme;   // whose colours are set
    colour_depth depth;
    bool bright[INK_COUNT]; // inks that are bold for want of bright colours
    bool colours, themed, mouse, has_mouse;
    bool painted;             // what is shown was not shown by ncurses
    escape_sequence sequence; // that has begun on the input
    double sequence_time;     // of its last character [s]
    pixel_answers pixels;     // what it said of pictures
    char restore[256];        // what a crash sends
    size_t restore_length;
} terminal_state;

extern terminal_state tty;

extern volatile sig_atomic_t terminal_leaving;    // the signal that asks to leave
extern volatile sig_atomic_t terminal_suspending; // ^Z was pressed

// Catches the signals that ask to leave, stop the program or end it, and gives them back.
void terminal_take_signals(void);
void terminal_give_signals_back(void);

// Appends to what a crash sends to give the terminal back, without a capability's padding marks;
// NULL and what ncurses says for none are passed over.
void terminal_prepare_crash(const char *text);

// Takes an answer from the terminal; true if the screen should be drawn anew for it.
bool terminal_take_answer(void);

// Asks for the size of a cell once more, as after a change of size, if it was told.
void terminal_ask_cell(void);

// Shows the pictures of a screen whose cells are shown: those that have changed, or all.
void terminal_show_pictures(const screen *s, bool whole);
// Takes all pictures off the terminal.
void terminal_remove_pictures(void);
