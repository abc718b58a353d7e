// What follows an escape on the terminal's input, byte by byte: mouse reports are understood, all
// else is passed over, so that the letters of a key that nobody knows are not taken for keys. It
// never waits: a sequence that comes in pieces is gone on with when the next one is there.
#pragma once

#include <stdbool.h>

typedef enum sequence_state {
    SEQUENCE_NONE,
    SEQUENCE_ESCAPED,  // after the escape itself
    SEQUENCE_BRACKET,  // ESC [ or ESC O, parameters to come
    SEQUENCE_OLD_MOUSE // ESC [ M, three bytes to come
} sequence_state;

typedef struct escape_sequence {
    sequence_state state;
    char text[32]; // parameters so far
    int length;
} escape_sequence;

typedef enum sequence_result {
    SEQUENCE_GOES_ON,
    SEQUENCE_OVER,     // it meant nothing, or nothing to us
    SEQUENCE_MOUSE,    // the first button or the wheel
    SEQUENCE_OTHER_KEY // the escape stood alone, this character is the next key
} sequence_result;

// What the mouse did, at a cell counted from 0.
typedef enum mouse_kind {
    MOUSE_PRESS,
    MOUSE_DRAG,
    MOUSE_RELEASE,
    MOUSE_WHEEL_UP,
    MOUSE_WHEEL_DOWN
} mouse_kind;

typedef struct mouse_report {
    mouse_kind kind;
    int x, y;
    bool shift, control;
} mouse_report;

// Takes the next character of a sequence that has begun (state SEQUENCE_ESCAPED). With
// SEQUENCE_MOUSE the report says what the mouse did.
sequence_result escape_sequence_take(escape_sequence *e, int character, mouse_report *report);
