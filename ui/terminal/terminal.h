// The terminal: shows a screen's cells and reads keys and the mouse. Its former state is
// restored however the program ends, crashes included.
#pragma once

#include "src/base/fault.h"
#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"
#include "ui/terminal/keys.h"
#include "ui/terminal/screen.h"

typedef enum terminal_input_kind {
    TERMINAL_NONE,    // the time is over
    TERMINAL_KEY,     // `code` is the key
    TERMINAL_POINTER, // `pointer` is the event of the mouse
    TERMINAL_RESIZE,  // the size has changed, or the screen must be redrawn
    TERMINAL_LEAVE    // a signal asks to leave, or the terminal is gone
} terminal_input_kind;

typedef struct terminal_input {
    terminal_input_kind kind;
    int code;
    bool pasted; // a key that is a character of pasted text
    pointer_event pointer;
} terminal_input;

// Whether standard input and output are a terminal that can position its cursor; if not,
// the reason is in f.
bool terminal_usable(fault *f);

// Takes control of the terminal. STATUS_BAD_ARGUMENT, with the reason in f, if it is not
// usable.
status terminal_open(fault *f);

// Restores it. If a signal asked to leave, ends the program by that signal.
void terminal_close(void);

// Gives it back by prepared bytes, if it is open, where the program ends at once. Safe in
// a signal handler.
void terminal_give_back(void);

// Runs a line of the shell with the terminal, and takes that over again; returns what
// system() does.
int terminal_run(const char *line);

void terminal_size(int *width, int *height);

// Waits for input: at most `seconds`, without limit if negative.
terminal_input terminal_wait(double seconds);

// Shows the cells and the pictures; only what has changed is sent. `whole`: everything
// anew.
void terminal_show(const screen *s, glyph_set glyphs, colour_theme theme, bool whole);

// Bytes sent so far past ncurses: pictures are nearly all of them.
size_t terminal_sent(void);

// The terminal's answers about pictures.
typedef struct terminal_pixels {
    bool there;                  // it draws some
    int cell_width, cell_height; // [pixels]
    bool has_ground;
    rgb ground; // of the terminal
} terminal_pixels;

// What is known so far. A change is reported as TERMINAL_RESIZE.
terminal_pixels terminal_pixels_known(void);

// The terminal's number of colours according to its description and the environment:
// never DEPTH_UNKNOWN. DEPTH_MONO with NO_COLOR.
colour_depth terminal_depth(void);

// Whether the terminal reports a light background (in COLORFGBG, as some do).
bool terminal_is_light(void);

// Puts a text on the terminal's clipboard (OSC 52); terminals that have none ignore it.
void terminal_copy(const char *text);

// Mouse reports on or off (off lets the terminal select text).
void terminal_mouse(bool on);
