// Whether a terminal draws pictures, and how: what it is asked, and what it answered. Nothing is
// taken from its name; one that does not answer draws none.
//
// First its version and its device attributes are asked for, which every terminal takes without a
// mark on its screen. Only one that answers, and that is no multiplexer, is asked for the kitty
// protocol: multiplexers hand such a question on or take it for a title. Device attributes come
// last each time, so that their answer says that no other will come.
#pragma once

#include "ui/terminal/escape_sequence.h"
#include "ui/terminal/ink_colours.h"

typedef enum pixel_protocol { PIXELS_NONE, PIXELS_SIXEL, PIXELS_KITTY } pixel_protocol;

typedef struct pixel_answers {
    enum { PIXELS_UNASKED, PIXELS_ASKED_NAME, PIXELS_ASKED, PIXELS_ANSWERED } stage;
    bool multiplexer;
    bool sixel, kitty;
    int cell_width, cell_height; // [pixels]; 0: not said
    int registers;               // colours of a sixel picture; 0: not said
    int most_width, most_height; // of a sixel picture [pixels]; 0: not said
    bool has_ground;
    rgb ground; // of the terminal, if it said
} pixel_answers;

// Begins: returns what to ask first. `multiplexer`: the environment says that one is between.
const char *pixel_answers_begin(pixel_answers *a, bool multiplexer);

// Takes an answer and returns what to ask next, "" for nothing.
const char *pixel_answers_take(pixel_answers *a, const escape_sequence *answer);

// What asks for the size of a cell once more, as after a change of the letters.
extern const char pixel_ask_cell[];

// The protocol to draw with.
pixel_protocol pixel_answers_protocol(const pixel_answers *a);
