// Keys and the mouse.
#pragma once

#include <stdbool.h>

// Keys that are not characters; the code of a character is its Unicode number.
enum key_code {
    KEY_CODE_FIRST = 0x110000,
    KEY_CODE_LEFT,
    KEY_CODE_RIGHT,
    KEY_CODE_UP,
    KEY_CODE_DOWN,
    KEY_CODE_HOME,
    KEY_CODE_END,
    KEY_CODE_PAGE_UP,
    KEY_CODE_PAGE_DOWN,
    KEY_CODE_BACKSPACE,
    KEY_CODE_DELETE,
    KEY_CODE_F1,
    KEY_CODE_SHIFT_LEFT,
    KEY_CODE_SHIFT_RIGHT,
    KEY_CODE_SHIFT_UP,
    KEY_CODE_SHIFT_DOWN,
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
