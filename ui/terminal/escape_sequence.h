// What follows an escape on the terminal's input, byte by byte: mouse reports are understood, the
// terminal's answers handed on while some are awaited, and all else is passed over, so that the
// letters of a key that nobody knows are not taken for keys. It never waits: a sequence that comes
// in pieces is gone on with when the next one is there.
#pragma once

#include "ui/terminal/pointer.h"

typedef enum sequence_state {
    SEQUENCE_NONE,
    SEQUENCE_ESCAPED,   // after the escape itself
    SEQUENCE_BRACKET,   // ESC [ or ESC O, parameters to come
    SEQUENCE_OLD_MOUSE, // ESC [ M, three bytes to come
    SEQUENCE_STRING,    // ESC P, ESC ] or ESC _, an answer's text to come
    SEQUENCE_STRING_END // the escape of the ESC \ that ends it
} sequence_state;

typedef struct escape_sequence {
    sequence_state state;
    bool awaits;     // answers are awaited: strings begin, too
    char introducer; // of an answer: '[', 'P', ']' or '_'
    char final;      // of one that begins with '['
    char text[96];   // parameters so far, of an answer the whole text with a zero at its end
    int length;
} escape_sequence;

typedef enum sequence_result {
    SEQUENCE_GOES_ON,
    SEQUENCE_OVER,     // it meant nothing, or nothing to us
    SEQUENCE_MOUSE,    // the first button or the wheel
    SEQUENCE_ANSWER,   // introducer, text and final say which
    SEQUENCE_OTHER_KEY // the escape stood alone, this character is the next key
} sequence_result;

// Takes the next character of a sequence that has begun (state SEQUENCE_ESCAPED). With
// SEQUENCE_MOUSE the report says what the mouse did.
sequence_result escape_sequence_take(escape_sequence *e, int character, pointer_event *report);
