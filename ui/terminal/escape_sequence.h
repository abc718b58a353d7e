// Escape sequences on the terminal's input, byte by byte. Mouse reports are decoded,
// answers of the terminal are passed on while some are expected, and everything else is
// skipped, so that the letters of an unknown key are not taken for keys. It never waits:
// a sequence that arrives in pieces is continued when the next piece is there. ESC [ 200
// ~ and ESC [ 201 ~ stand before and after pasted text (bracketed paste).
#pragma once

#include "ui/terminal/keys.h"

typedef enum sequence_state {
    SEQUENCE_NONE,
    SEQUENCE_ESCAPED,   // after ESC
    SEQUENCE_BRACKET,   // ESC [ or ESC O, parameters to come
    SEQUENCE_OLD_MOUSE, // ESC [ M, three bytes to come
    SEQUENCE_STRING,    // ESC P, ESC ] or ESC _, the text of an answer to come
    SEQUENCE_STRING_END // the escape of the ESC \ that ends it
} sequence_state;

typedef struct escape_sequence {
    sequence_state state;
    bool awaits_answers; // answers are expected: strings are recognised too
    char introducer;     // of an answer: '[', 'P', ']' or '_'
    char final;          // of an answer that begins with '['
    char text[96]; // parameters so far; of an answer the whole text, terminated by zero
    int length;
} escape_sequence;

typedef enum sequence_result {
    SEQUENCE_CONTINUES,
    SEQUENCE_OVER,   // it had no meaning or was skipped
    SEQUENCE_MOUSE,  // the first button or the wheel
    SEQUENCE_ANSWER, // given by introducer, text and final
    SEQUENCE_PASTE,  // what follows was pasted, as far as SEQUENCE_PASTED
    SEQUENCE_PASTED,
    SEQUENCE_OTHER_KEY // ESC was a key by itself; this character is the next key
} sequence_result;

// Takes the next character of a sequence that has begun (state SEQUENCE_ESCAPED). With
// SEQUENCE_MOUSE the report has the event of the mouse.
sequence_result escape_sequence_take(escape_sequence *e, int character,
                                     pointer_event *report);
