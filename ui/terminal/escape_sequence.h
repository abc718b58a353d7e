// What follows an escape on the terminal's input, byte by byte: mouse reports are understood, all
// else is passed over, so that the letters of a key that nobody knows are not taken for keys. It
// never waits: a sequence that comes in pieces is gone on with when the next one is there.
#pragma once

#include "ui/terminal/pointer.h"

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

// Takes the next character of a sequence that has begun (state SEQUENCE_ESCAPED). With
// SEQUENCE_MOUSE the report says what the mouse did.
sequence_result escape_sequence_take(escape_sequence *e, int character, pointer_event *report);
