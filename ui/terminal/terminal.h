// The terminal: shows a screen's cells, reads keys and the mouse, and is given back as it was on
// every way out, crashes included.
#pragma once

#include "src/base/fault.h"
#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"
#include "ui/terminal/key_codes.h"
#include "ui/terminal/screen.h"

typedef enum terminal_input_kind {
    TERMINAL_NONE,    // the time is over
    TERMINAL_KEY,     // code: the key
    TERMINAL_POINTER, // pointer: what the mouse did
    TERMINAL_RESIZE,  // the size has changed, or the screen must be drawn anew
    TERMINAL_LEAVE    // a signal asks to leave, or the terminal is gone
} terminal_input_kind;

typedef struct terminal_input {
    terminal_input_kind kind;
    int code;
    pointer_event pointer;
} terminal_input;

// Whether standard input and output are a terminal that can place its cursor; f says why not.
bool terminal_usable(fault *f);

// Takes the terminal over. STATUS_BAD_ARGUMENT, with the reason in f, if it is not usable.
status terminal_open(fault *f);

// Gives it back. If a signal asked to leave, ends the program by that signal.
void terminal_close(void);

void terminal_size(int *width, int *height);

// Waits for input: at most `seconds`, for ever if negative.
terminal_input terminal_wait(double seconds);

// Shows the cells and the pictures; only what has changed is sent. `whole`: everything anew.
void terminal_show(const screen *s, glyph_set glyphs, colour_theme theme, colour_depth depth,
                   bool whole);

// What the terminal said of pictures.
typedef struct terminal_pixels {
    bool there;                  // it draws some
    int cell_width, cell_height; // [pixels]
    bool has_ground;
    rgb ground; // of the terminal
} terminal_pixels;

// As far as is known by now: nothing is guessed. A change comes as TERMINAL_RESIZE.
terminal_pixels terminal_pixels_known(void);

// How many colours the terminal has by what its description and the environment say: never
// DEPTH_AUTO. DEPTH_MONO with NO_COLOR.
colour_depth terminal_depth(void);

// Whether the terminal says (in COLORFGBG, as some do) that its ground is light.
bool terminal_is_light(void);

// Mouse reports on or off (off lets the terminal select text).
void terminal_mouse(bool on);
