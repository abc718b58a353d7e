// Events of the mouse on a screen.
#pragma once

#include <stdbool.h>

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
