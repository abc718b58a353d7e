// Keys and the mouse.
#pragma once

#include <stdbool.h>

// Keys that are not characters: code, name and ncurses' code.
#define KEY_LIST(X)                                                                      \
    X(LEFT, "Left", KEY_LEFT)                                                            \
    X(RIGHT, "Right", KEY_RIGHT)                                                         \
    X(UP, "Up", KEY_UP)                                                                  \
    X(DOWN, "Down", KEY_DOWN)                                                            \
    X(HOME, "Home", KEY_HOME)                                                            \
    X(END, "End", KEY_END)                                                               \
    X(PAGE_UP, "PgUp", KEY_PPAGE)                                                        \
    X(PAGE_DOWN, "PgDn", KEY_NPAGE)                                                      \
    X(BACKSPACE, "Backspace", KEY_BACKSPACE)                                             \
    X(DELETE, "Delete", KEY_DC)                                                          \
    X(F1, "F1", KEY_F(1))                                                                \
    X(SHIFT_LEFT, "S-Left", KEY_SLEFT)                                                   \
    X(SHIFT_RIGHT, "S-Right", KEY_SRIGHT)                                                \
    X(SHIFT_UP, "S-Up", KEY_SR)                                                          \
    X(SHIFT_DOWN, "S-Down", KEY_SF)                                                      \
    X(ALT_B, "M-b", NO_CURSES_KEY)                                                       \
    X(ALT_D, "M-d", NO_CURSES_KEY)                                                       \
    X(ALT_F, "M-f", NO_CURSES_KEY)                                                       \
    X(ALT_BACKSPACE, "M-Backspace", NO_CURSES_KEY)

#define NO_CURSES_KEY (-1) // of keys that come as an escape and a character

// The code of a character is its Unicode number.
enum key_code {
    KEY_CODE_FIRST = 0x110000,
#define KEY_CODE(code, name, curses) KEY_CODE_##code,
    KEY_LIST(KEY_CODE)
#undef KEY_CODE
        KEY_CODE_ENTER = '\r',
    KEY_CODE_ESCAPE = 27,
    KEY_CODE_TAB = '\t'
};

typedef enum pointer_kind {
    POINTER_PRESS,
    POINTER_DRAG,
    POINTER_RELEASE,
    POINTER_WHEEL_UP,
    POINTER_WHEEL_DOWN
} pointer_kind;

// An event of the mouse and its cell, counted from 0.
typedef struct pointer_event {
    pointer_kind kind;
    int x, y;            // column and row [cells]
    bool shift, control; // keys held
} pointer_event;
